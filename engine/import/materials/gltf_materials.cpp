#include "engine/import/materials/gltf_materials.h"

#include "engine/import/file/gltf_schema.h"
#include "engine/import/file/json_fields.h"
#include "engine/import/materials/gltf_haptics.h"
#include "engine/import/materials/gltf_looks.h"
#include "engine/import/materials/gltf_mpeg.h"

#include <algorithm>
#include <utility>

namespace touchstone {
namespace {

using nlohmann::json;

const json& childOf(const json& object, const char* name) {
    static const json kNothing = json::object();
    const auto found = object.find(name);
    return found == object.end() ? kNothing : *found;
}

TextureRef textureOf(ImportContext& context, const GltfDocument& document, const json& owner,
                     const char* name, const std::string& place) {
    const auto found = owner.find(name);
    return found == owner.end() ? TextureRef{} : readTexture(context, document, *found, place + "." + name);
}

/// Colours and factors are 0..1; a value outside is a harmless error of an exporter.
template <class T>
T clamped(ImportContext& context, T value, const std::string& place) {
    const T inside = glm::clamp(value, T(0.0f), T(1.0f));
    if (inside != value)
        context.warn(place, "is outside 0..1 and was clamped");
    return inside;
}

glm::vec4 vec4Of(const std::vector<double>& v) {
    return {v[0], v[1], v[2], v[3]};
}
glm::vec3 vec3Of(const std::vector<double>& v) {
    return {v[0], v[1], v[2]};
}

AlphaMode alphaModeOf(ImportContext& context, const std::string& name, const std::string& place) {
    if (name == "MASK")
        return AlphaMode::Mask;
    if (name == "BLEND")
        return AlphaMode::Blend;
    if (name != "OPAQUE")
        context.warn(place + ".alphaMode", "\"" + name.substr(0, 40) + "\" is unknown; drawn opaque");
    return AlphaMode::Opaque;
}

void readLook(ImportContext& context, const GltfDocument& document, size_t index, Material& material) {
    const tinygltf::Material& gltf = document.model.materials[index];
    const json& stated = document.json["materials"][index];
    const json& pbr = childOf(stated, "pbrMetallicRoughness");
    const std::string place = element("materials", index), pbrPlace = place + ".pbrMetallicRoughness";

    material.name = gltf.name;
    material.baseColor =
        clamped(context, vec4Of(gltf.pbrMetallicRoughness.baseColorFactor), pbrPlace + ".baseColorFactor");
    material.metallic = clamped(context, static_cast<float>(gltf.pbrMetallicRoughness.metallicFactor),
                                pbrPlace + ".metallicFactor");
    material.roughness = clamped(context, static_cast<float>(gltf.pbrMetallicRoughness.roughnessFactor),
                                 pbrPlace + ".roughnessFactor");
    material.metallicStated = pbr.contains("metallicFactor");
    material.roughnessStated = pbr.contains("roughnessFactor");
    material.baseColorTexture = textureOf(context, document, pbr, "baseColorTexture", pbrPlace);
    material.metallicRoughnessTexture =
        textureOf(context, document, pbr, "metallicRoughnessTexture", pbrPlace);
    material.normalTexture = textureOf(context, document, stated, "normalTexture", place);
    material.normalScale = static_cast<float>(gltf.normalTexture.scale);
    material.occlusionTexture = textureOf(context, document, stated, "occlusionTexture", place);
    material.occlusionStrength = clamped(context, static_cast<float>(gltf.occlusionTexture.strength),
                                         place + ".occlusionTexture.strength");
    material.emissiveTexture = textureOf(context, document, stated, "emissiveTexture", place);
    material.emissive = clamped(context, vec3Of(gltf.emissiveFactor), place + ".emissiveFactor");
    material.alphaMode = alphaModeOf(context, gltf.alphaMode, place);
    material.alphaCutoff = static_cast<float>(gltf.alphaCutoff);
    material.doubleSided = gltf.doubleSided;
    readLookExtensions(context, document, stated, place, material);
}

Wrap wrapOf(int gl) {
    return gl == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::ClampToEdge
           : gl == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::MirroredRepeat
                                                         : Wrap::Repeat;
}

/// The image of a texture: WebP where the extension offers it, else the core source, else -1.
int imageOf(ImportContext& context, const GltfDocument& document, size_t index) {
    const std::string place = element("textures", index);
    const json& texture = document.json["textures"][index];
    const size_t images = document.json.contains("images") ? document.json["images"].size() : 0;
    std::optional<int> source;
    (void)context.attempt("it is ignored", [&] {
        if (const json* webp = extensionOf(context, texture, "EXT_texture_webp", place))
            source = indexField(context, *webp, "source", place + ".extensions.EXT_texture_webp", images,
                                "images");
    });
    return source.value_or(document.model.textures[index].source);
}

/// A texture with its sampler and image.
TextureRef textureAt(ImportContext& context, const GltfDocument& document, size_t index) {
    TextureRef ref;
    ref.texture = static_cast<int>(index);
    ref.image = imageOf(context, document, index);
    const int sampler = document.model.textures[index].sampler;
    if (sampler >= 0) {
        const tinygltf::Sampler& gltf = document.model.samplers[static_cast<size_t>(sampler)];
        ref.wrapS = wrapOf(gltf.wrapS);
        ref.wrapT = wrapOf(gltf.wrapT);
        ref.nearest = gltf.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
    }
    return ref;
}

} // namespace

TextureRef readTexture(ImportContext& context, const GltfDocument& document, const json& info,
                       const std::string& place) {
    checkTextureInfo(context, document.json, info, place);
    const size_t index = info["index"];
    TextureRef ref = textureAt(context, document, index);
    if (!ref)
        context.warn(element("textures", index), "has no image that can be read; drawn and felt without it");
    ref.texCoord = info.value("texCoord", 0);
    if (const json* transform = extensionOf(context, info, "KHR_texture_transform", place)) {
        const std::string at = place + ".extensions.KHR_texture_transform";
        ref.offset = pairField(context, *transform, "offset", at).value_or(ref.offset);
        ref.scale = pairField(context, *transform, "scale", at).value_or(ref.scale);
        ref.rotation = numberField(context, *transform, "rotation", at, -1e6, 1e6).value_or(ref.rotation);
        ref.texCoord =
            indexField(context, *transform, "texCoord", at, 1000, "TEXCOORD").value_or(ref.texCoord);
    }
    if (ref.texCoord > 1) {
        context.warn(place, "uses TEXCOORD_" + std::to_string(ref.texCoord) +
                                ", only 0 and 1 are read; drawn and felt without it");
        return {};
    }
    return ref;
}

std::vector<SceneTexture> readTextures(ImportContext& context, const GltfDocument& document) {
    std::vector<SceneTexture> textures(document.model.textures.size());
    for (size_t i = 0; i < textures.size(); ++i)
        textures[i] = {document.model.textures[i].name, textureAt(context, document, i)};
    return textures;
}

MaterialTable::MaterialTable(ImportContext& context, const GltfDocument& document)
    : context_(context), document_(document), shaders_(context, document) {
    for (size_t i = 0; i < document.model.materials.size(); ++i) {
        context.stopIfCancelled();
        (void)indexOf({static_cast<int>(i), -1, -1});
    }
}

int MaterialTable::indexOf(const SurfaceKey& key) {
    const auto [found, isNew] = made_.try_emplace(key, static_cast<int>(materials_.size()));
    if (!isNew)
        return found->second;
    Material material;
    if (key.mpeg >= 0 || key.physics >= 0) {
        material = materials_[static_cast<size_t>(indexOf({key.material, -1, -1}))];
    } else if (key.material >= 0) {
        const auto index = static_cast<size_t>(key.material);
        (void)context_.attempt("the material is drawn without it",
                               [&] { readLook(context_, document_, index, material); });
        material.says.ours = readStatement(context_, document_, index, shaders_);
    }
    material.fileIndex = key.material;
    if (key.mpeg >= 0) {
        HapticStatement ours = std::move(material.says.ours);
        material.says = mpegSays(key.mpeg);
        material.says.ours = std::move(ours);
    }
    if (key.physics >= 0)
        readPhysics(context_, document_, static_cast<size_t>(key.physics), material.says);
    material.haptic = statedHaptics(material.says);
    found->second = static_cast<int>(materials_.size()); // building the plain one may have added it before
    materials_.push_back(std::move(material));
    return found->second;
}

const HapticLayers& MaterialTable::mpegSays(int index) {
    const auto [found, isNew] = mpeg_.try_emplace(index);
    if (isNew)
        readMpeg(context_, document_, static_cast<size_t>(index), found->second);
    return found->second;
}

std::vector<Material> MaterialTable::take() {
    if (materials_.empty())
        (void)indexOf({});
    return std::move(materials_);
}

} // namespace touchstone
