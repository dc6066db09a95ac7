#include "engine/import/materials/gltf_mpeg.h"

#include "engine/import/file/json_fields.h"
#include "engine/import/materials/gltf_haptics.h"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr std::array<const char*, 2> kSpellings = {"MPEG_haptic_material", "MPEG_material_haptic"};
constexpr std::array<const char*, 6> kChannels = {"stiffness",   "friction",  "vibrotactileTexture",
                                                  "temperature", "vibration", "custom"};
constexpr const char* kBeside = "extensions.gltf";
constexpr const char* kWithout = "felt without it";
constexpr size_t kMaxMaps = 64;

/// The extension of `object` in either spelling, any type; null without one.
const json* inEitherSpelling(const json& object, const char*& spelling) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object())
        return nullptr;
    for (const char* name : kSpellings) {
        const auto found = extensions->find(name);
        if (found == extensions->end())
            continue;
        spelling = name;
        return &*found;
    }
    return nullptr;
}

MpegMaterials listed(ImportContext& context, const json& root, std::string place) {
    MpegMaterials materials{json::array(), std::move(place)};
    if (root.is_array()) {
        materials.list = root;
    } else if (root.is_object() && root.contains("materials")) {
        materials.place += ".materials";
        materials.list = root["materials"].is_object() ? json::array({root["materials"]}) : root["materials"];
    } else if (root.is_object() &&
               std::ranges::any_of(kChannels, [&](const char* channel) { return root.contains(channel); })) {
        materials.list.push_back(root);
    }
    if (!materials.list.is_array()) {
        context.warn(materials.place, std::string("should be an array; ") + kWithout);
        materials.list = json::array();
    }
    if (materials.list.empty())
        context.warn(materials.place, std::string("holds no materials; ") + kWithout);
    for (size_t i = 0; i < materials.list.size(); ++i)
        if (!materials.list[i].is_object()) {
            context.warn(element(materials.place, i), std::string("should be an object; ") + kWithout);
            materials.list[i] = json::object();
        }
    return materials;
}

bool someMeshRefers(const json& gltf) {
    const char* spelling = nullptr;
    const auto meshes = gltf.find("meshes");
    return meshes != gltf.end() && std::any_of(meshes->begin(), meshes->end(), [&](const json& mesh) {
               return inEitherSpelling(mesh, spelling) != nullptr;
           });
}

MpegMaterials fromBeside(ImportContext& context, const std::filesystem::path& path) {
    MpegMaterials materials;
    try {
        std::error_code unreadable;
        if (std::filesystem::file_size(path, unreadable) > kMaxTextBytes && !unreadable)
            context.fail("", "is larger than " + std::to_string(kMaxTextBytes >> 20) + " MiB");
        const std::vector<uint8_t> bytes = readWholeFile(path, kBeside);
        context.countFileBytes(bytes.size());
        const json gltf = parseJson(context, bytes, Comments::Ignore);
        const char* spelling = nullptr;
        if (const json* root = gltf.is_object() ? inEitherSpelling(gltf, spelling) : nullptr)
            materials = listed(context, *root, std::string(kBeside) + ": extensions." + spelling);
        else
            context.warn(kBeside, "holds no MPEG haptic materials, to which meshes refer; felt without them");
    } catch (const Error& error) {
        context.stopIfCancelled();
        context.warn(kBeside, error.problem() + "; felt without its MPEG haptic materials");
    }
    return materials;
}

/// The textureInfo of a map, in either form.
json textureInfoOf(const json& map) {
    const json& texture = map.is_object() && map.contains("texture") ? map["texture"] : map;
    return texture.is_number() ? json{{"index", texture}} : texture;
}

/// The first plain map of a channel: "High_Resolution" before others; "Reference" maps index signals, not
/// values, and are not used.
std::optional<FactorMap> channelMap(ImportContext& context, const GltfDocument& document,
                                    const json& material, const char* name, const std::string& place,
                                    float low, float high) {
    const auto found = material.find(name);
    if (found == material.end())
        return std::nullopt;
    const std::string at = place + "." + name;
    const json maps = found->is_array() ? *found : json::array({*found});
    if (maps.size() > kMaxMaps)
        context.warn(at, "holds more than " + std::to_string(kMaxMaps) + " maps; the others are ignored");
    std::optional<FactorMap> chosen;
    bool chosenHigh = false;
    for (size_t i = 0; i < std::min(maps.size(), kMaxMaps); ++i) {
        const std::string mapPlace = found->is_array() ? element(at, i) : at;
        (void)context.attempt(kWithout, [&] {
            const std::string type =
                (maps[i].is_object() ? textField(context, maps[i], "type", mapPlace) : std::nullopt)
                    .value_or("High_Resolution");
            const TextureRef texture =
                readTexture(context, document, textureInfoOf(maps[i]), mapPlace + ".texture");
            const bool isHigh = type == "High_Resolution";
            if (type == "Reference")
                context.warn(mapPlace, "refers to tactile signals, which are not played");
            else if (texture && (!chosen || (isHigh && !chosenHigh))) {
                chosen = FactorMap{texture, low, high};
                chosenHigh = isHigh;
            }
        });
    }
    return chosen;
}

} // namespace

MpegMaterials findMpegMaterials(ImportContext& context, const GltfFile& file) {
    const char* spelling = nullptr;
    if (const json* root = inEitherSpelling(file.json, spelling))
        return listed(context, *root, std::string("extensions.") + spelling);
    if (!someMeshRefers(file.json))
        return {};
    std::error_code missing;
    const std::filesystem::path beside = file.folder / kBeside;
    if (std::filesystem::exists(beside, missing))
        return fromBeside(context, beside);
    context.warn("extensions", "meshes refer to MPEG haptic materials, but neither the file nor \"" +
                                   std::string(kBeside) + "\" beside it holds any; felt without them");
    return {};
}

std::optional<int> mpegMaterialOf(ImportContext& context, const GltfDocument& document, size_t mesh) {
    const json& owner = document.json["meshes"][mesh];
    const char* spelling = nullptr;
    const json* reference = inEitherSpelling(owner, spelling);
    const size_t count = document.mpeg.list.size();
    if (reference == nullptr || count == 0)
        return std::nullopt;
    const std::string at = element("meshes", mesh) + ".extensions";
    std::optional<int> index;
    (void)context.attempt(kWithout, [&] {
        index = reference->is_object()
                    ? indexField(context, *reference, "hapticMaterialIndex", at + "." + spelling, count,
                                 "materials")
                    : indexField(context, owner["extensions"], spelling, at, count, "materials");
        if (!index)
            context.fail(at + "." + spelling, "has no hapticMaterialIndex");
    });
    return index;
}

void readMpeg(ImportContext& context, const GltfDocument& document, size_t index, HapticLayers& says) {
    const json& material = document.mpeg.list[index];
    const std::string place = element(document.mpeg.place, index);
    says.mpegStiffness =
        channelMap(context, document, material, "stiffness", place, kMpegStiffnessMin, kMpegStiffnessMax);
    says.mpegFriction =
        channelMap(context, document, material, "friction", place, kMpegFrictionMin, kMpegFrictionMax);
    json unavailable;
    for (const auto& [channel, value] : material.items())
        if (channel != "name" && channel != "stiffness" && channel != "friction" && channel != "extensions" &&
            channel != "extras") {
            unavailable[channel] = value;
            context.warn(place + "." + channel.substr(0, 40), "is not yet available; felt without it");
        }
    says.mpegUnavailable = KeptJson(std::move(unavailable));
}

} // namespace touchstone
