#pragma once
// Appearance of a surface (glTF's metallic-roughness) and its haptic properties (docs/materials.md).

#include "engine/program/surface_program.h"
#include "engine/scene/kept_json.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace touchstone {

enum class Wrap : uint8_t { Repeat, MirroredRepeat, ClampToEdge };

/// A reference to an image with its sampler and KHR_texture_transform. UV origin is the upper left.
struct TextureRef {
    int texture = -1; ///< index into Scene::textures, its source
    int image = -1;   ///< index into Scene::images; < 0: no texture
    int texCoord = 0; ///< UV set (0 or 1), already overridden by the transform extension
    Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
    bool nearest = false;   ///< the sampler specifies nearest magnification
    glm::vec2 offset{0.0f}; ///< KHR_texture_transform: uv' = offset + R(rotation) * (scale * uv)
    float rotation = 0.0f;  ///< rad, counter-clockwise as the extension defines it
    glm::vec2 scale{1.0f};

    [[nodiscard]] explicit operator bool() const { return image >= 0; }
    [[nodiscard]] glm::vec2 transform(const glm::vec2& uv) const;
    bool operator==(const TextureRef&) const = default;
};

enum class AlphaMode : uint8_t { Opaque, Mask, Blend };

/// The source of a haptic value, in falling order of precedence.
enum class HapticSource : uint8_t { Touchstone, Mpeg, Physics, DerivedFromPbr, Default };

/// A map whose R channel scales a factor from `min` (black) to `max` (white), linear.
struct FactorMap {
    TextureRef texture;
    float min = 0.0f, max = 1.0f;
    bool operator==(const FactorMap&) const = default;
};

/// Height in model metres: scale * (R - midLevel).
struct HeightMap {
    TextureRef texture;
    float scale = 0.0f; ///< m, black to white, model metres
    float midLevel = 0.5f;
    bool operator==(const HeightMap&) const = default;
};

enum class ShadingChoice : uint8_t { Auto, Off, TwoPass, Projected, Direction, Bezier };
enum class SideChoice : uint8_t { Both, Front };

/// Added to the values of a distance field's nodes [002 section 4.4]. Model metres.
struct FieldTexture {
    float noiseAmplitude = 0.0f;    ///< standard deviation; 0: no noise
    float noiseWavelength = 0.0f;   ///< distance between its values; 0: each node has its own
    float noiseSeed = 0.0f;         ///< a whole number
    float latticeAmplitude = 0.0f;  ///< of the highest and lowest places; 0: no lattice
    float latticeWavelength = 0.0f; ///< along each axis of the mesh; 0: no lattice
    [[nodiscard]] bool empty() const {
        return noiseAmplitude == 0.0f && (latticeAmplitude == 0.0f || latticeWavelength == 0.0f);
    }
    bool operator==(const FieldTexture&) const = default;
};

/// The haptic properties of a material. An empty optional means that the file does not specify it: the
/// session's setting or the device's recommendation applies. Every field keeps its source for the reasons in
/// `inspect`.
struct HapticMaterial {
    template <class T>
    struct Field {
        std::optional<T> value;
        HapticSource source = HapticSource::Default;
        bool operator==(const Field&) const = default;
    };
    Field<float> stiffness;              ///< N/m
    Field<float> damping;                ///< N·s/m
    Field<float> retardationTime;        ///< s, damping over stiffness of a Kelvin-Voigt material
    Field<float> staticFriction;         ///< 1
    Field<float> dynamicFriction;        ///< 1
    Field<float> viscousFriction;        ///< N·s/m
    Field<float> normalTextureInfluence; ///< 0..1, felt fraction of the core normal map
    /// LocalDeformation's numbers (engine/scene/local_deformation.h).
    Field<float> deformationRadius, deformationStiffness, deformationLinear, deformationQuadratic,
        relaxationTime;
    Field<HeightMap> height;
    Field<FactorMap> friction, stiffnessMap, dampingMap;
    ShadingChoice forceShading = ShadingChoice::Auto;
    SideChoice sides = SideChoice::Both;
    bool implicit = false;   ///< representation: felt as a distance field
    float voxelSize = 0.0f;  ///< of the field, model metres; 0: chosen from fieldError or the object's size
    float fieldError = 0.0f; ///< how far its surface may be from the triangles, model metres; 0: not stated
    FieldTexture fieldTexture;
    MaterialProgram program; ///< what a touched place of it feels like; none: the fields above alone
    KeptFields unavailable;  ///< fields that are not felt, for `inspect`
    bool operator==(const HapticMaterial&) const = default;
};

/// The statements of TOUCHSTONE_materials_haptic about a material, field by field; an empty one is left out.
struct HapticStatement {
    std::optional<float> stiffness, damping, retardationTime, staticFriction, dynamicFriction,
        viscousFriction, normalTextureInfluence, deformationRadius, deformationStiffness, deformationLinear,
        deformationQuadratic, relaxationTime;
    std::optional<HeightMap> height;
    std::optional<FactorMap> friction, stiffnessMap, dampingMap;
    std::optional<ShadingChoice> forceShading;
    std::optional<SideChoice> sides;
    std::optional<bool> implicit;               ///< representation: "implicit", else "mesh"
    std::optional<float> voxelSize, fieldError; ///< model metres
    std::optional<float> noiseAmplitude, noiseWavelength, noiseSeed, latticeAmplitude,
        latticeWavelength; ///< FieldTexture
    KeptJson shader;       ///< as in the file; null: none
    /// Compiled from shader's source; null without one, and where it could not be read or compiled.
    std::shared_ptr<const SurfaceProgram> program;
    bool operator==(const HapticStatement&) const = default;
};

/// All haptic statements of a file about a surface, by source. settledHaptics resolves them.
struct HapticLayers {
    HapticStatement ours;
    std::optional<FactorMap> mpegStiffness, mpegFriction;
    KeptJson mpegUnavailable; ///< channels reserved for later, an object; null: none
    std::optional<float> physicsStatic, physicsDynamic;
    std::optional<float> meanRoughness; ///< stated by the PBR material and readable
};

/// KHR_materials_pbrSpecularGlossiness: replaces metallic and roughness. The diffuse colour and its map are
/// Material::baseColor and baseColorTexture.
struct SpecularGlossiness {
    bool used = false;
    glm::vec3 specular{1.0f}; ///< reflectance at normal incidence, linear
    float glossiness = 1.0f;  ///< 1 - roughness
    TextureRef texture;       ///< RGB specular (sRGB), A glossiness
};

/// KHR_materials_ior and KHR_materials_specular: reflection of the dielectric part.
struct DielectricSpecular {
    float ior = 1.5f; ///< 0: reflects everything (the extension's backward-compatible mode)
    float factor = 1.0f;
    glm::vec3 color{1.0f};            ///< linear
    TextureRef texture, colorTexture; ///< A factor; RGB colour (sRGB)
};

/// KHR_materials_clearcoat.
struct Clearcoat {
    float factor = 0.0f, roughness = 0.0f;
    TextureRef texture, roughnessTexture; ///< R; G
};

/// KHR_materials_sheen.
struct Sheen {
    glm::vec3 color{0.0f}; ///< linear
    float roughness = 0.0f;
    TextureRef colorTexture, roughnessTexture; ///< RGB (sRGB); A
};

/// KHR_materials_transmission and KHR_materials_volume.
struct Transmission {
    float factor = 0.0f;
    TextureRef texture;               ///< R
    float thickness = 0.0f;           ///< mesh metres; 0: thin walls, no volume
    TextureRef thicknessTexture;      ///< G
    glm::vec3 attenuationColor{1.0f}; ///< linear: colour of white light after attenuationDistance
    float attenuationDistance = 0.0f; ///< scene metres; 0: the volume absorbs nothing
};

/// The textures that a material's appearance reads, in the order of Material::lookTextures.
inline constexpr size_t kLookTextures = 14;

struct Material {
    std::string name;
    int fileIndex = -1;          ///< index in the file; < 0: the file has no material for this surface
    glm::vec4 baseColor{1.0f};   ///< linear
    TextureRef baseColorTexture; ///< sRGB
    float metallic = 1.0f, roughness = 1.0f;
    bool roughnessStated = false, metallicStated = false; ///< the file states the factor explicitly
    TextureRef metallicRoughnessTexture;                  ///< G roughness, B metallic
    TextureRef normalTexture;
    float normalScale = 1.0f;
    TextureRef occlusionTexture;
    float occlusionStrength = 1.0f;
    glm::vec3 emissive{0.0f};
    TextureRef emissiveTexture;
    AlphaMode alphaMode = AlphaMode::Opaque;
    float alphaCutoff = 0.5f;
    bool doubleSided = false;
    bool unlit =
        false; ///< KHR_materials_unlit: only the base colour is drawn, and all that follows is ignored
    SpecularGlossiness specularGlossiness;
    DielectricSpecular specular;
    Clearcoat clearcoat;
    Sheen sheen;
    Transmission transmission;
    HapticLayers says;
    HapticMaterial haptic; ///< resolved from `says`

    /// Base colour, metallic-roughness, normal, occlusion, emissive, specular-glossiness, specular, specular
    /// colour, clearcoat, clearcoat roughness, sheen colour, sheen roughness, transmission, thickness: the
    /// slots of shaders/shared/scene_types.h.
    [[nodiscard]] std::array<TextureRef*, kLookTextures> lookTextures();
    [[nodiscard]] std::array<const TextureRef*, kLookTextures> lookTextures() const;
};

} // namespace touchstone
