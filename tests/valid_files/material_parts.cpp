#include "tests/valid_files/material_parts.h"

#include "tests/support/encoded_image.h"
#include "tests/valid_files/physics_parts.h"
#include "tests/valid_files/program_parts.h"

namespace touchstone::test {
namespace {

using nlohmann::json;

struct StoredImage {
    std::string mimeType;
    std::vector<uint8_t> bytes;
};

template <class T>
StoredImage noise(const char* name, const char* mimeType, int width, int height, int channels, double top) {
    Draw draw(static_cast<uint64_t>(width * 31 + height * 7 + channels));
    std::vector<T> values;
    for (int i = 0; i < width * height * channels; ++i)
        values.push_back(static_cast<T>(draw.real(0.0, top)));
    return {mimeType, encodedImage(name, width, height, channels, values)};
}

/// Encoded once: plain ones first, then what is less usual.
const std::vector<StoredImage>& imagePool() {
    static const std::vector<StoredImage> kPool = {noise<uint8_t>("a.png", "image/png", 16, 16, 3, 255.0),
                                                   noise<uint8_t>("b.png", "image/png", 32, 8, 4, 255.0),
                                                   noise<uint8_t>("c.jpg", "image/jpeg", 16, 16, 3, 255.0),
                                                   noise<uint8_t>("d.png", "image/png", 1, 1, 3, 255.0),
                                                   noise<uint16_t>("e.png", "image/png", 9, 5, 1, 65535.0),
                                                   noise<uint16_t>("f.png", "image/png", 8, 8, 3, 65535.0),
                                                   noise<uint8_t>("g.png", "image/png", 1, 64, 2, 255.0),
                                                   noise<uint8_t>("h.jpg", "image/jpeg", 7, 3, 1, 255.0),
                                                   noise<uint8_t>("i.png", "image/png", 33, 17, 1, 255.0)};
    return kPool;
}
constexpr size_t kPlainImages = 3;

size_t addImage(FileDraft& draft) {
    const size_t among = draft.has(Feature::OddImages) ? imagePool().size() : kPlainImages;
    const StoredImage& image = imagePool()[draft.draw.below(among)];
    if (draft.draw.chance(0.3))
        return draft.maker.append("images",
                                  {{"uri", "data:" + image.mimeType + ";base64," + base64(image.bytes)}});
    const size_t view = draft.maker.addView(image.bytes.data(), image.bytes.size());
    return draft.maker.append("images", {{"bufferView", view}, {"mimeType", image.mimeType}});
}

size_t addTexture(FileDraft& draft) {
    Draw& draw = draft.draw;
    json& made = draft.maker.json;
    if (made.contains("textures") && draw.chance(0.4))
        return draw.below(made["textures"].size());
    json texture = json::object();
    if (!draft.has(Feature::OddImages) || draw.chance(0.9))
        texture["source"] =
            made.contains("images") && draw.chance(0.4) ? draw.below(made["images"].size()) : addImage(draft);
    if (draft.has(Feature::Samplers)) {
        json sampler = json::object();
        if (draw.chance(0.7))
            sampler["magFilter"] = draw.pick(std::vector{9728, 9729});
        if (draw.chance(0.7))
            sampler["minFilter"] = draw.pick(std::vector{9728, 9729, 9984, 9985, 9986, 9987});
        for (const char* wrap : {"wrapS", "wrapT"})
            if (draw.chance(0.7))
                sampler[wrap] = draw.pick(std::vector{10497, 33071, 33648});
        texture["sampler"] = draft.maker.append("samplers", sampler);
    }
    return draft.maker.append("textures", texture);
}

/// A texture info; null where the meshes have no texture coordinates to read it with.
json textureInfo(FileDraft& draft) {
    Draw& draw = draft.draw;
    std::vector<int> sets;
    if (draft.has(Feature::Uv0) || draft.has(Feature::OtherAttributes))
        sets.push_back(0);
    if (draft.has(Feature::Uv1) || draft.has(Feature::OtherAttributes))
        sets.push_back(1);
    if (draft.has(Feature::OtherAttributes))
        sets.push_back(3);
    if (sets.empty())
        return nullptr;
    json info = {{"index", addTexture(draft)}};
    const int set = draw.chance(0.7) ? sets.front() : draw.pick(sets);
    if (set != 0 || draw.chance(0.3))
        info["texCoord"] = set;
    if (!draft.has(Feature::TextureTransform) || draw.chance(0.3))
        return info;
    json transform = json::object();
    if (draw.chance(0.7))
        transform["offset"] = {draw.real(-3.0, 3.0), draw.real(-3.0, 3.0)};
    if (draw.chance(0.5))
        transform["rotation"] = draw.real(-10.0, 10.0);
    if (draw.chance(0.7))
        transform["scale"] = {draw.pick(std::vector{0.0, -1.0, 1e-6, 0.5, 7.0, 1e6}), draw.real(-5.0, 5.0)};
    if (draw.chance(0.3))
        transform["texCoord"] = draw.pick(sets);
    draft.use("KHR_texture_transform", draw.chance(0.3));
    info["extensions"]["KHR_texture_transform"] = transform;
    return info;
}

/// Sets object[name] to a texture info with more fields, where there can be one.
void put(FileDraft& draft, json& object, const char* name, const json& more = json::object()) {
    json info = textureInfo(draft);
    if (info.is_null())
        return;
    info.update(more);
    object[name] = std::move(info);
}

void addCore(FileDraft& draft, json& material) {
    Draw& draw = draft.draw;
    json pbr = json::object();
    if (draft.has(Feature::CoreFactors)) {
        if (draw.chance(0.7))
            pbr["baseColorFactor"] = {draw.real(0, 1), draw.real(0, 1), draw.real(0, 1), draw.real(0, 1)};
        if (draw.chance(0.7))
            pbr["metallicFactor"] = draw.pick(std::vector{0.0, 0.4, 1.0});
        if (draw.chance(0.7))
            pbr["roughnessFactor"] = draw.pick(std::vector{0.0, 0.4, 1.0});
        if (draw.chance(0.5))
            material["emissiveFactor"] = {draw.real(0, 1), 0, 1};
        if (draw.chance(0.5))
            material["alphaMode"] = draw.pick(std::vector<std::string>{"OPAQUE", "MASK", "BLEND"});
        if (material.contains("alphaMode") && material["alphaMode"] == "MASK" && draw.chance(0.5))
            material["alphaCutoff"] = draw.real(0.0, 2.0);
        if (draw.chance(0.5))
            material["doubleSided"] = draw.chance(0.5);
    }
    if (draft.has(Feature::CoreMaps)) {
        put(draft, pbr, "baseColorTexture");
        put(draft, pbr, "metallicRoughnessTexture");
        put(draft, material, "occlusionTexture", {{"strength", draw.real(0.0, 1.0)}});
        put(draft, material, "emissiveTexture");
    }
    if (draft.has(Feature::NormalMap))
        put(draft, material, "normalTexture",
            draw.chance(0.5) ? json{{"scale", draw.pick(std::vector{-1.0, 0.0, 0.3, 2.0, 20.0})}}
                             : json::object());
    if (!pbr.empty() || draw.chance(0.2))
        material["pbrMetallicRoughness"] = pbr;
}

/// Local deformation, and a damper by its time.
void addDents(FileDraft& draft, json& ours) {
    Draw& draw = draft.draw;
    ours["deformationRadius"] = draw.pick(std::vector{0.0, 0.002, 0.05, 3.0});
    if (draw.chance(0.7))
        ours["deformationStiffness"] = draw.pick(std::vector{1.0, 300.0, 5000.0});
    if (draw.chance(0.5))
        ours["deformationLinear"] = draw.real(-3.0, 3.0);
    if (draw.chance(0.5))
        ours["deformationQuadratic"] = draw.real(-3.0, 3.0);
    if (draw.chance(0.5))
        ours["relaxationTime"] = draw.pick(std::vector{0.0, 1e-4, 0.1, 10.0});
    if (draw.chance(0.5))
        ours["retardationTime"] = draw.pick(std::vector{0.0, 1e-3, 0.1});
}

void addMapping(FileDraft& draft, json& ours) {
    Draw& draw = draft.draw;
    json mapping = json::object();
    if (draw.chance(0.8))
        mapping["surface"] = draw.pick(std::vector<std::string>{"plane", "cylinder", "sphere", "box"});
    if (draw.chance(0.5))
        mapping["by"] = draw.pick(std::vector<std::string>{"position", "normal"});
    if (draw.chance(0.5))
        mapping["repeat"] = {draw.between(1, 16) * (draw.chance(0.2) ? -1 : 1), draw.between(1, 16)};
    if (draw.chance(0.5))
        mapping["rotation"] =
            draw.pick(std::vector<json>{{0, 0, 0, 1}, {1, 0, 0, 0}, {0.6, 0, 0, 0.8}, {0.5, 0.5, 0.5, 0.5}});
    ours["textureMapping"] = mapping;
}

void addOurs(FileDraft& draft, json& material) {
    Draw& draw = draft.draw;
    json ours = json::object();
    if (draft.has(Feature::HapticFields)) {
        const auto some = [&](const char* name, double low, double high) {
            if (draw.chance(0.6))
                ours[name] = draw.chance(0.1) ? high : draw.real(low, high);
        };
        some("stiffness", 1.0, 5000.0);
        some("damping", 0.0, 5.0);
        some("staticFriction", 0.0, 2.0);
        some("dynamicFriction", 0.0, 2.0);
        some("viscousFriction", 0.0, 3.0);
        some("normalTextureInfluence", 0.0, 1.0);
        if (draw.chance(0.5))
            ours["forceShading"] = draw.pick(
                std::vector<std::string>{"auto", "off", "twoPass", "projected", "direction", "bezier"});
        if (draw.chance(0.5))
            ours["sides"] = draw.pick(std::vector<std::string>{"front", "both"});
        if (draw.chance(0.2)) {
            ours["representation"] = draw.pick(std::vector<std::string>{"mesh", "implicit"});
            ours["voxelSize"] = draw.real(0.02, 0.5);
            if (draw.chance(0.3))
                ours["fieldError"] = draw.real(0.004, 0.5);
            if (draw.chance(0.3)) {
                ours["noiseAmplitude"] = draw.real(0.0, 0.01);
                ours["noiseWavelength"] = draw.real(0.0, 0.2);
                ours["latticeAmplitude"] = draw.real(0.0, 0.05);
                ours["latticeWavelength"] = draw.real(0.05, 0.5);
            }
        }
        if (draw.chance(0.1))
            ours["shader"] = {{"source", "bumps.glsl"}, {"parameters", {{"height", 1.0}}}};
    }
    if (draft.has(Feature::Dents))
        addDents(draft, ours);
    addProgram(draft, ours);
    if (draft.has(Feature::TextureMapping))
        addMapping(draft, ours);
    if (draft.has(Feature::HeightMap))
        put(draft, ours, "heightTexture",
            {{"scale", draw.pick(std::vector{1e-4, -5e-4, 2e-3, 0.0, 0.5})},
             {"midLevel", draw.pick(std::vector{0.0, 0.5, 1.0})}});
    if (draft.has(Feature::FactorMaps))
        for (const char* name : {"frictionTexture", "stiffnessTexture", "dampingTexture"})
            put(draft, ours, name,
                {{"min", draw.pick(std::vector{0.0, 0.2, 1.0})},
                 {"max", draw.pick(std::vector{0.0, 1.0, 3.0})}});
    if (ours.empty())
        return;
    draft.use("TOUCHSTONE_materials_haptic", draw.chance(0.2));
    material["extensions"]["TOUCHSTONE_materials_haptic"] = ours;
}

/// The ratified material extensions; their textures follow the rules of the core ones.
void addExtensions(FileDraft& draft, json& material) {
    Draw& draw = draft.draw;
    const std::vector<std::pair<std::string, json>> known = {
        {"KHR_materials_unlit", json::object()},
        {"KHR_materials_emissive_strength", {{"emissiveStrength", draw.real(0.0, 100.0)}}},
        {"KHR_materials_ior", {{"ior", draw.pick(std::vector{0.0, 1.0, 1.33, 2.4})}}},
        {"KHR_materials_clearcoat",
         {{"clearcoatFactor", draw.real(0, 1)}, {"clearcoatRoughnessFactor", draw.real(0, 1)}}},
        {"KHR_materials_sheen",
         {{"sheenColorFactor", {draw.real(0, 1), 0.5, 1.0}}, {"sheenRoughnessFactor", draw.real(0, 1)}}},
        {"KHR_materials_transmission", {{"transmissionFactor", draw.real(0, 1)}}},
        {"KHR_materials_volume",
         {{"thicknessFactor", draw.real(0, 1)},
          {"attenuationDistance", draw.real(0.01, 1)},
          {"attenuationColor", {0.5, 1.0, 0.2}}}},
        {"KHR_materials_specular",
         {{"specularFactor", draw.real(0, 1)}, {"specularColorFactor", {1.0, 0.5, 0.2}}}},
        {"KHR_materials_iridescence", {{"iridescenceFactor", draw.real(0, 1)}}},
        {"KHR_materials_anisotropy", {{"anisotropyStrength", draw.real(0, 1)}}},
        {"KHR_materials_dispersion", {{"dispersion", draw.real(0, 1)}}},
        {"KHR_materials_pbrSpecularGlossiness",
         {{"diffuseFactor", {0.5, 0.2, 1.0, 0.7}},
          {"specularFactor", {0.2, 1.0, 0.1}},
          {"glossinessFactor", draw.real(0, 1)}}}};
    for (const auto& [name, fields] : known)
        if (draw.chance(0.3)) {
            json extension = fields;
            if (name == "KHR_materials_clearcoat" && draw.chance(0.5))
                put(draft, extension, "clearcoatNormalTexture", {{"scale", 0.5}});
            if (name == "KHR_materials_pbrSpecularGlossiness" && draw.chance(0.5))
                put(draft, extension, "diffuseTexture");
            if (name == "KHR_materials_volume" && draw.chance(0.5))
                put(draft, extension, "thicknessTexture");
            draft.use(name);
            material["extensions"][name] = extension;
        }
}

/// The root's materials, as the extension's published schema has them.
void addMpeg(FileDraft& draft) {
    Draw& draw = draft.draw;
    json materials = json::array();
    for (size_t n = 1 + draw.below(2); n > 0; --n) {
        json material = {{"name", "felt"}};
        for (const char* channel : {"stiffness", "friction", "vibration"})
            if (json info = textureInfo(draft); !info.is_null())
                material[channel] = {
                    {{"texture", info},
                     {"type", draw.pick(std::vector<std::string>{"High_Resolution", "Low_Resolution"})}}};
        materials.push_back(material);
    }
    draft.use("MPEG_material_haptic");
    const size_t count = materials.size();
    draft.maker.json["extensions"]["MPEG_material_haptic"] = {{"materials", materials}};
    for (json& mesh : draft.maker.json["meshes"])
        if (draw.chance(0.7))
            mesh["extensions"]["MPEG_material_haptic"] = {{"hapticMaterialIndex", draw.below(count)}};
}

} // namespace

void addMaterials(FileDraft& draft) {
    bool any = false;
    for (const Feature feature :
         {Feature::CoreFactors, Feature::CoreMaps, Feature::NormalMap, Feature::HeightMap,
          Feature::FactorMaps, Feature::HapticFields, Feature::SeveralMaterials, Feature::MaterialExtensions,
          Feature::OddImages, Feature::TextureTransform, Feature::Samplers, Feature::Dents, Feature::Programs,
          Feature::PersistentTextures, Feature::TextureMapping})
        any = any || draft.has(feature);
    if (!any)
        return;
    for (size_t n = draft.has(Feature::SeveralMaterials) ? 2 + draft.draw.below(4) : 1; n > 0; --n) {
        json material = json::object();
        addCore(draft, material);
        addOurs(draft, material);
        if (draft.has(Feature::MaterialExtensions))
            addExtensions(draft, material);
        draft.materials.push_back(draft.maker.append("materials", material));
    }
}

void addForeignHaptics(FileDraft& draft) {
    if (draft.has(Feature::Mpeg))
        addMpeg(draft);
    addPhysics(draft);
}

} // namespace touchstone::test
