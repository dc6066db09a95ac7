#include "engine/scene/import/gltf_haptics.h"

#include "engine/scene/import/json_fields.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string_view>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr double kUnbounded = 1e30;
constexpr const char* kOurs = "TOUCHSTONE_materials_haptic";
constexpr std::array<const char*, 2> kMpegSpellings = {"MPEG_haptic_material", "MPEG_material_haptic"};
constexpr const char* kPhysics = "KHR_physics_rigid_bodies";

/// A field keeps the first value it gets: readers run in falling order of precedence.
template <class T>
void offer(HapticMaterial::Field<T>& field, std::optional<T> value, HapticSource source) {
    if (!field.value && value)
        field = {std::move(value), source};
}

template <class Choice, size_t N>
Choice choiceField(const ImportContext& context, const json& object, const char* name,
                   const std::string& place, const std::array<std::pair<const char*, Choice>, N>& choices,
                   Choice fallback) {
    const auto text = textField(context, object, name, place);
    if (!text)
        return fallback;
    std::string known;
    for (const auto& [spelling, choice] : choices) {
        if (*text == spelling)
            return choice;
        known += (known.empty() ? "" : ", ") + std::string(spelling);
    }
    context.fail(place + "." + name, "\"" + text->substr(0, 40) + "\" is not a choice",
                 "use one of: " + known);
}

/// A misspelt field must not be mistaken for one that holds.
void warnOfUnknown(ImportContext& context, const json& object, std::initializer_list<std::string_view> known,
                   const std::string& place) {
    for (const auto& [name, value] : object.items())
        if (name != "extensions" && name != "extras" &&
            std::find(known.begin(), known.end(), name) == known.end())
            context.warn(place + "." + name.substr(0, 40), "is not a known field; felt without it");
}

std::optional<HeightMap> heightField(ImportContext& context, const GltfDocument& document, const json& ours,
                                     const std::string& place) {
    const auto found = ours.find("heightTexture");
    if (found == ours.end())
        return std::nullopt;
    const std::string at = place + ".heightTexture";
    HeightMap map;
    map.texture = readTexture(context, document, *found, at);
    const auto scale = numberField(context, *found, "scale", at, -kUnbounded, kUnbounded);
    if (!scale)
        context.fail(at, "property 'scale' is missing", "give the height from black to white in metres");
    map.scale = *scale;
    map.midLevel = numberField(context, *found, "midLevel", at, 0.0, 1.0).value_or(map.midLevel);
    warnOfUnknown(context, *found, {"index", "texCoord", "scale", "midLevel"}, at);
    return map.texture ? std::optional(map) : std::nullopt;
}

std::optional<FactorMap> factorField(ImportContext& context, const GltfDocument& document, const json& ours,
                                     const char* name, const std::string& place) {
    const auto found = ours.find(name);
    if (found == ours.end())
        return std::nullopt;
    const std::string at = place + "." + name;
    FactorMap map;
    map.texture = readTexture(context, document, *found, at);
    map.min = numberField(context, *found, "min", at, 0.0, kUnbounded).value_or(map.min);
    map.max = numberField(context, *found, "max", at, 0.0, kUnbounded).value_or(map.max);
    warnOfUnknown(context, *found, {"index", "texCoord", "min", "max"}, at);
    return map.texture ? std::optional(map) : std::nullopt;
}

void checkShader(ImportContext& context, const json& shader, const std::string& place) {
    if (!shader.is_object() || !shader.contains("source") || !shader["source"].is_string())
        context.fail(place, "should be an object with a source", "correct the value in the file");
    if (shader.contains("parameters") && !shader["parameters"].is_object())
        context.fail(place + ".parameters", "should be an object of values by name",
                     "correct the value in the file");
    warnOfUnknown(context, shader, {"source", "parameters"}, place);
}

/// Fields of later work stay as they are in the file, for saving and for `inspect`.
void keepUnavailable(ImportContext& context, const json& ours, const std::string& place,
                     HapticMaterial& haptic) {
    const auto keep = [&](const char* name, const std::string& what) {
        haptic.unavailable[name] = ours[name];
        context.warn(place + "." + name, what + " is not yet available; felt without it");
    };
    if (ours.contains("shader")) {
        checkShader(context, ours["shader"], place + ".shader");
        keep("shader", "a haptic shader");
    }
    if (haptic.representation == "implicit")
        keep("representation", "the implicit representation");
    if (numberField(context, ours, "voxelSize", place, 1e-30, kUnbounded)) {
        haptic.unavailable["voxelSize"] = ours["voxelSize"];
        if (haptic.representation != "implicit")
            context.warn(place + ".voxelSize", "says nothing without representation \"implicit\"");
    }
    if (haptic.forceShading == ShadingChoice::Bezier)
        keep("forceShading", "force shading \"bezier\"");
}

void readOurs(ImportContext& context, const GltfDocument& document, size_t material, HapticMaterial& haptic) {
    const std::string owner = element("materials", material);
    const json* found = extensionOf(context, document.json["materials"][material], kOurs, owner);
    if (found == nullptr)
        return;
    const json& ours = *found;
    const std::string place = owner + ".extensions." + kOurs;
    constexpr auto source = HapticSource::Touchstone;
    const auto number = [&](const char* name, double low, double high) {
        return numberField(context, ours, name, place, low, high);
    };
    offer(haptic.stiffness, number("stiffness", 1e-30, kUnbounded), source);
    offer(haptic.damping, number("damping", 0.0, kUnbounded), source);
    offer(haptic.staticFriction, number("staticFriction", 0.0, kUnbounded), source);
    offer(haptic.dynamicFriction, number("dynamicFriction", 0.0, kUnbounded), source);
    offer(haptic.viscousFriction, number("viscousFriction", 0.0, kUnbounded), source);
    offer(haptic.normalTextureInfluence, number("normalTextureInfluence", 0.0, 1.0), source);
    offer(haptic.height, heightField(context, document, ours, place), source);
    offer(haptic.friction, factorField(context, document, ours, "frictionTexture", place), source);
    offer(haptic.stiffnessMap, factorField(context, document, ours, "stiffnessTexture", place), source);
    offer(haptic.dampingMap, factorField(context, document, ours, "dampingTexture", place), source);
    static constexpr std::array<std::pair<const char*, ShadingChoice>, 6> kShading = {
        {{"auto", ShadingChoice::Auto},
         {"off", ShadingChoice::Off},
         {"twoPass", ShadingChoice::TwoPass},
         {"projected", ShadingChoice::Projected},
         {"direction", ShadingChoice::Direction},
         {"bezier", ShadingChoice::Bezier}}};
    static constexpr std::array<std::pair<const char*, SideChoice>, 2> kSides = {
        {{"front", SideChoice::Front}, {"both", SideChoice::Both}}};
    static constexpr std::array<std::pair<const char*, bool>, 2> kRepresentations = {
        {{"mesh", false}, {"implicit", true}}};
    haptic.forceShading = choiceField(context, ours, "forceShading", place, kShading, ShadingChoice::Auto);
    haptic.sides = choiceField(context, ours, "sides", place, kSides, SideChoice::Both);
    haptic.representation =
        choiceField(context, ours, "representation", place, kRepresentations, false) ? "implicit" : "mesh";
    keepUnavailable(context, ours, place, haptic);
    warnOfUnknown(context, ours,
                  {"stiffness", "damping", "staticFriction", "dynamicFriction", "viscousFriction",
                   "normalTextureInfluence", "heightTexture", "frictionTexture", "stiffnessTexture",
                   "dampingTexture", "forceShading", "representation", "voxelSize", "shader", "sides"},
                  place);
}

/// The root extension's `materials`, in whichever spelling the file uses; null without one.
const json* mpegMaterials(const ImportContext& context, const GltfDocument& document, std::string& place) {
    for (const char* spelling : kMpegSpellings) {
        const json* root = extensionOf(context, document.json, spelling, "");
        if (root == nullptr)
            continue;
        place = std::string("extensions.") + spelling + ".materials";
        const auto found = root->find("materials");
        if (found == root->end() || !found->is_array())
            context.fail(place, "should be an array", "correct the extension in the file");
        return &*found;
    }
    return nullptr;
}

/// The first plain map of an MPEG channel: "High_Resolution" before others; "Reference" maps index signals,
/// not values, and are no maps for us.
std::optional<FactorMap> mpegChannel(ImportContext& context, const GltfDocument& document,
                                     const json& material, const char* name, const std::string& place,
                                     float low, float high) {
    const auto found = material.find(name);
    if (found == material.end())
        return std::nullopt;
    const std::string at = place + "." + name;
    if (!found->is_array())
        context.fail(at, "should be an array of {texture, type}", "correct the extension in the file");
    constexpr size_t kMaxMaps = 64;
    if (found->size() > kMaxMaps)
        context.fail(at, "holds more than " + std::to_string(kMaxMaps) + " maps",
                     "correct the extension in the file");
    std::optional<FactorMap> chosen;
    bool chosenHigh = false;
    for (size_t i = 0; i < found->size(); ++i) {
        const json& entry = (*found)[i];
        const std::string entryPlace = at + "[" + std::to_string(i) + "]";
        if (!entry.is_object() || !entry.contains("texture"))
            context.fail(entryPlace, "should be an object with a texture",
                         "correct the extension in the file");
        const std::string type = textField(context, entry, "type", entryPlace).value_or("Other");
        const TextureRef texture = readTexture(context, document, entry["texture"], entryPlace + ".texture");
        const bool isHigh = type == "High_Resolution";
        if (type == "Reference")
            context.warn(entryPlace, "refers to tactile signals, which are not played");
        else if (texture && (!chosen || (isHigh && !chosenHigh))) {
            chosen = FactorMap{texture, low, high};
            chosenHigh = isHigh;
        }
    }
    return chosen;
}

void readMpeg(ImportContext& context, const GltfDocument& document, size_t index, HapticMaterial& haptic) {
    std::string place;
    const json& material = (*mpegMaterials(context, document, place))[index];
    place += "[" + std::to_string(index) + "]";
    constexpr auto source = HapticSource::Mpeg;
    offer(haptic.stiffnessMap,
          mpegChannel(context, document, material, "stiffness", place, kMpegStiffnessMin, kMpegStiffnessMax),
          source);
    const bool oursHasFriction =
        haptic.staticFriction.value || haptic.dynamicFriction.value || haptic.friction.value;
    auto friction =
        mpegChannel(context, document, material, "friction", place, kMpegFrictionMin, kMpegFrictionMax);
    // The map is the coefficient itself, so its scalars are 1; beside a scalar of ours it would mean another
    // thing.
    if (friction && !oursHasFriction) {
        offer(haptic.friction, std::move(friction), source);
        offer(haptic.staticFriction, std::optional(1.0f), source);
        offer(haptic.dynamicFriction, std::optional(kSlidingShare), source);
    }
    for (const auto& [channel, value] : material.items())
        if (channel != "name" && channel != "stiffness" && channel != "friction" && channel != "extensions" &&
            channel != "extras") {
            haptic.unavailable["MPEG_haptic_material"][channel] = value;
            context.warn(place + "." + channel.substr(0, 40), "is not yet available; felt without it");
        }
}

const json* physicsMaterials(const ImportContext& context, const GltfDocument& document) {
    const json* root = extensionOf(context, document.json, kPhysics, "");
    if (root == nullptr)
        return nullptr;
    const auto found = root->find("physicsMaterials");
    if (found == root->end())
        return nullptr;
    if (!found->is_array())
        context.fail(std::string("extensions.") + kPhysics + ".physicsMaterials", "should be an array");
    return &*found;
}

void readPhysics(ImportContext& context, const GltfDocument& document, size_t index, HapticMaterial& haptic) {
    const json& material = (*physicsMaterials(context, document))[index];
    const std::string place =
        std::string("extensions.") + kPhysics + ".physicsMaterials[" + std::to_string(index) + "]";
    const auto friction = [&](const char* name) {
        return std::optional(
            numberField(context, material, name, place, 0.0, kUnbounded).value_or(kPhysicsFriction));
    };
    offer(haptic.staticFriction, friction("staticFriction"), HapticSource::Physics);
    offer(haptic.dynamicFriction, friction("dynamicFriction"), HapticSource::Physics);
}

/// For every node itself or its nearest ancestor that has a mesh, -1 if there is none. Top down, so that a
/// long chain of nodes costs its length once.
std::vector<int> nearestMeshNodes(const tinygltf::Model& model) {
    std::vector<int> nearest(model.nodes.size(), -1);
    std::vector<bool> isChild(model.nodes.size(), false);
    for (const auto& node : model.nodes)
        for (const int child : node.children)
            isChild[static_cast<size_t>(child)] = true;
    std::vector<size_t> open;
    for (size_t i = 0; i < model.nodes.size(); ++i)
        if (!isChild[i])
            open.push_back(i);
    while (!open.empty()) {
        const size_t i = open.back();
        open.pop_back();
        if (model.nodes[i].mesh >= 0)
            nearest[i] = static_cast<int>(i);
        for (const int child : model.nodes[i].children) {
            nearest[static_cast<size_t>(child)] = nearest[i];
            open.push_back(static_cast<size_t>(child));
        }
    }
    return nearest;
}

void checkObjectsIn(const ImportContext& context, const json* array, const std::string& place) {
    for (size_t i = 0; array != nullptr && i < array->size(); ++i)
        if (!(*array)[i].is_object())
            context.fail(element(place, i), "should be an object", "correct the extension in the file");
}

} // namespace

void checkHapticExtensions(ImportContext& context, const GltfDocument& document) {
    std::string place;
    const json* mpeg = mpegMaterials(context, document, place);
    checkObjectsIn(context, mpeg, place);
    checkObjectsIn(context, physicsMaterials(context, document),
                   std::string("extensions.") + kPhysics + ".physicsMaterials");
}

void readHaptics(ImportContext& context, const GltfDocument& document, const SurfaceKey& key,
                 HapticMaterial& haptic) {
    haptic = {};
    if (key.material >= 0)
        readOurs(context, document, static_cast<size_t>(key.material), haptic);
    if (key.mpeg >= 0)
        readMpeg(context, document, static_cast<size_t>(key.mpeg), haptic);
    if (key.physics >= 0)
        readPhysics(context, document, static_cast<size_t>(key.physics), haptic);
}

std::optional<int> mpegMaterialOf(ImportContext& context, const GltfDocument& document, size_t mesh) {
    std::string place;
    const json* materials = mpegMaterials(context, document, place);
    const size_t count = materials == nullptr ? 0 : materials->size();
    const json& owner = document.json["meshes"][mesh];
    const auto extensions = owner.find("extensions");
    if (extensions == owner.end())
        return std::nullopt;
    for (const char* spelling : kMpegSpellings) {
        const auto found = extensions->find(spelling);
        if (found == extensions->end())
            continue;
        const std::string at = element("meshes", mesh) + ".extensions";
        if (found->is_number())
            return indexField(context, *extensions, spelling, at, count, "materials");
        if (!found->is_object())
            context.fail(at + "." + spelling, "should be an object or an index",
                         "correct the extension in the file");
        return indexField(context, *found, "hapticMaterialIndex", at + "." + spelling, count, "materials");
    }
    return std::nullopt;
}

std::vector<int> physicsMaterialOfNodes(ImportContext& context, const GltfDocument& document) {
    const auto& nodes = document.model.nodes;
    std::vector<int> material(nodes.size(), -1);
    const json* materials = physicsMaterials(context, document);
    if (materials == nullptr)
        return material;
    const std::vector<int> meshAbove = nearestMeshNodes(document.model);

    for (size_t i = 0; i < nodes.size(); ++i) {
        const std::string place = element("nodes", i);
        const json* body = extensionOf(context, document.json["nodes"][i], kPhysics, place);
        if (body == nullptr || !body->contains("collider"))
            continue;
        const std::string at = place + ".extensions." + kPhysics + ".collider";
        const json& collider = (*body)["collider"];
        if (!collider.is_object())
            context.fail(at, "should be an object", "correct the extension in the file");
        const auto chosen =
            indexField(context, collider, "physicsMaterial", at, materials->size(), "physicsMaterials");
        if (!chosen)
            continue;
        int target = static_cast<int>(i);
        if (nodes[i].mesh < 0 && collider.contains("geometry") && collider["geometry"].is_object())
            target =
                indexField(context, collider["geometry"], "node", at + ".geometry", nodes.size(), "nodes")
                    .value_or(target);
        target = meshAbove[static_cast<size_t>(target)];
        if (target >= 0)
            material[static_cast<size_t>(target)] = *chosen;
    }
    return material;
}

void deriveFriction(HapticMaterial& haptic, std::optional<float> meanRoughness) {
    if (!meanRoughness)
        return;
    const float rough = 0.15f + 0.6f * std::clamp(*meanRoughness, 0.0f, 1.0f);
    // Beside a stated coefficient the derived one must not turn the pair upside down.
    const float fromStatic = haptic.staticFriction.value.value_or(rough);
    offer(haptic.dynamicFriction, std::optional(std::min(kSlidingShare * rough, fromStatic)),
          HapticSource::DerivedFromPbr);
    offer(haptic.staticFriction, std::optional(std::max(rough, *haptic.dynamicFriction.value)),
          HapticSource::DerivedFromPbr);
}

} // namespace touchstone
