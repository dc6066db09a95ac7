#include "renderer/material_features.h"

#include "renderer/prepared_scene.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

using namespace shared;

bool transformed(const TextureRef& reference) {
    return reference && (reference.texCoord != 0 || reference.offset != glm::vec2(0.0f) ||
                         reference.rotation != 0.0f || reference.scale != glm::vec2(1.0f));
}

bool sameLookup(const TextureRef& a, const TextureRef& b) {
    return a.image == b.image && a.texCoord == b.texCoord && a.offset == b.offset &&
           a.rotation == b.rotation && a.scale == b.scale && a.wrapS == b.wrapS && a.wrapT == b.wrapT &&
           a.nearest == b.nearest;
}

/// Above this reflectance multiple scattering matters; dielectrics are at 0.04.
constexpr float kMuch = 0.1f;

float largest(const glm::vec3& c) {
    return std::max({c.x, c.y, c.z});
}

class Features {
  public:
    Features(const Scene& scene, const Material& material) : scene_(scene), material_(material) {}

    [[nodiscard]] uint32_t emission() const {
        if (material_.emissive == glm::vec3(0.0f))
            return 0;
        if (!material_.emissiveTexture)
            return kHasEmission;
        return usable(material_.emissiveTexture) ? kHasEmission | kHasEmissiveTexture : 0u;
    }

    [[nodiscard]] uint32_t core() const {
        uint32_t bits = emission();
        const bool glossy = material_.specularGlossiness.used;
        if (!glossy && usable(material_.metallicRoughnessTexture))
            bits |= kHasMetallicRoughnessTexture;
        if (glossy ? largest(material_.specularGlossiness.specular) > kMuch
                   : material_.metallic > 0.0f ||
                         largest(glm::vec3(materialUniforms(material_).dielectric)) > kMuch)
            bits |= kIsMetallic;
        if (usable(material_.normalTexture))
            bits |= kHasNormalTexture;
        if (usable(material_.occlusionTexture))
            bits |= kHasOcclusionTexture;
        const uint32_t both = kHasMetallicRoughnessTexture | kHasOcclusionTexture;
        if ((bits & both) == both &&
            sameLookup(material_.metallicRoughnessTexture, material_.occlusionTexture))
            bits |= kSharesOcclusion;
        if (glossy) {
            bits |= kHasSpecularGlossiness;
            if (usable(material_.specularGlossiness.texture))
                bits |= kHasSpecularGlossinessTexture;
        }
        return bits;
    }

    [[nodiscard]] uint32_t layers() const {
        uint32_t bits = 0;
        const DielectricSpecular& specular = material_.specular;
        if (specular.ior != 1.5f || specular.factor != 1.0f || specular.color != glm::vec3(1.0f) ||
            usable(specular.texture) || usable(specular.colorTexture)) {
            bits |= kHasSpecular;
            if (usable(specular.texture) || usable(specular.colorTexture))
                bits |= kHasSpecularTextures;
        }
        const Clearcoat& coat = material_.clearcoat;
        if (coat.factor > 0.0f) {
            bits |= kHasClearcoat;
            if (usable(coat.texture) || usable(coat.roughnessTexture))
                bits |= kHasClearcoatTextures;
        }
        const Sheen& sheen = material_.sheen;
        if (sheen.color != glm::vec3(0.0f)) {
            bits |= kHasSheen;
            if (usable(sheen.colorTexture) || usable(sheen.roughnessTexture))
                bits |= kHasSheenTextures;
        }
        return bits | transmission();
    }

    [[nodiscard]] bool usable(const TextureRef& texture) const { return usableTexture(scene_, texture); }

  private:
    [[nodiscard]] uint32_t transmission() const {
        const Transmission& glass = material_.transmission;
        if (glass.factor <= 0.0f)
            return 0;
        uint32_t bits = kIsTransmissive | kIsBlended;
        if (material_.alphaMode != AlphaMode::Blend)
            bits |= kIsSolid;
        if (glass.thickness > 0.0f)
            bits |= kHasVolume;
        if (usable(glass.texture) || usable(glass.thicknessTexture))
            bits |= kHasTransmissionTextures;
        return bits;
    }

    const Scene& scene_;
    const Material& material_;
};

/// KHR_materials_ior: the reflectance at normal incidence; ior 0 stands for infinity.
float reflectance(float ior) {
    const float root = ior > 0.0f ? (ior - 1.0f) / (ior + 1.0f) : 1.0f;
    return root * root;
}

/// For white light, halvings per metre: 2^(-result d) is attenuationColor at d = attenuationDistance. A zero
/// channel is replaced by 1e-5, so that its absorption is finite.
glm::vec3 absorption(const Transmission& glass) {
    if (!(glass.attenuationDistance > 0.0f))
        return glm::vec3(0.0f);
    const glm::vec3 color = glm::clamp(glass.attenuationColor, glm::vec3(1e-5f), glm::vec3(1.0f));
    return -glm::log2(color) / glass.attenuationDistance;
}

} // namespace

uint32_t drawFeatures(const Scene& scene, const Mesh& mesh, const Material& material) {
    const Features features(scene, material);
    const bool strokes = mesh.lineCount() > 0 || mesh.pointCount() > 0;
    uint32_t bits = mesh.lineCount() > 0 ? kIsLines : mesh.pointCount() > 0 ? kIsPoints : 0u;
    if (material.unlit)
        bits |= kIsUnlit;
    else if (strokes && mesh.normals.empty()) // glTF 2.0, section 3.7.2.1: base colour and emission
        bits |= kIsUnlit | features.emission();
    else
        bits |= features.core() | features.layers();
    if (strokes) // neither tangents nor a second side
        bits &= ~(kHasNormalTexture | kIsTransmissive | kIsSolid | kHasVolume | kHasTransmissionTextures |
                  (material.alphaMode == AlphaMode::Blend ? 0u : kIsBlended));
    if (material.baseColorTexture)
        bits |= kHasBaseColorTexture; // a broken one is drawn grey
    const auto textures = material.lookTextures();
    if (std::any_of(textures.begin(), textures.end(),
                    [](const TextureRef* each) { return transformed(*each); }))
        bits |= kHasUvTransform;
    if (material.alphaMode == AlphaMode::Mask)
        bits |= kIsMasked;
    if (material.alphaMode == AlphaMode::Blend)
        bits |= kIsBlended;
    if (!mesh.colors.empty())
        bits |= kHasVertexColor;
    if (!mesh.tangents.empty() && (bits & kHasNormalTexture) != 0)
        bits |= kHasTangents;
    return bits;
}

MaterialUniforms materialUniforms(const Material& material) {
    MaterialUniforms uniforms{};
    uniforms.baseColor = material.baseColor;
    uniforms.emissiveCutoff = glm::vec4(material.emissive, material.alphaCutoff);
    uniforms.factors = {material.metallic, material.roughness, material.normalScale,
                        material.occlusionStrength};
    uniforms.specularGlossiness =
        glm::vec4(material.specularGlossiness.specular, material.specularGlossiness.glossiness);
    uniforms.dielectric =
        glm::vec4(reflectance(material.specular.ior) * material.specular.color, material.specular.factor);
    uniforms.layers = {material.clearcoat.factor, material.clearcoat.roughness, material.sheen.roughness,
                       material.transmission.factor};
    uniforms.sheenColorThickness = glm::vec4(material.sheen.color, material.transmission.thickness);
    uniforms.absorption = glm::vec4(absorption(material.transmission), 0.0f);
    return uniforms;
}

} // namespace touchstone
