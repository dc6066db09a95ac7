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

template <class Choice, size_t N>
std::optional<Choice> choiceField(const ImportContext& context, const json& object, const char* name,
                                  const std::string& place,
                                  const std::array<std::pair<const char*, Choice>, N>& choices) {
    const auto text = textField(context, object, name, place);
    if (!text)
        return std::nullopt;
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

/// Fields of later work are kept for saving and for `inspect`.
void tellUnavailable(ImportContext& context, const HapticStatement& ours, const std::string& place) {
    const auto tell = [&](const char* name, const std::string& what) {
        context.warn(place + "." + name, what + " is not yet available; felt without it");
    };
    if (!ours.shader.is_null())
        tell("shader", "a haptic shader");
    if (ours.implicit.value_or(false))
        tell("representation", "the implicit representation");
    else if (ours.voxelSize)
        context.warn(place + ".voxelSize", "says nothing without representation \"implicit\"");
    if (ours.forceShading == ShadingChoice::Bezier)
        tell("forceShading", "force shading \"bezier\"");
}

void readChoices(ImportContext& context, const json& object, const std::string& place,
                 HapticStatement& ours) {
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
    ours.forceShading = choiceField(context, object, "forceShading", place, kShading);
    ours.sides = choiceField(context, object, "sides", place, kSides);
    ours.implicit = choiceField(context, object, "representation", place, kRepresentations);
}

void readOurs(ImportContext& context, const GltfDocument& document, size_t material, HapticStatement& ours) {
    const std::string owner = element("materials", material);
    const json* found = extensionOf(context, document.json["materials"][material], kOurs, owner);
    if (found == nullptr)
        return;
    const json& object = *found;
    const std::string place = owner + ".extensions." + kOurs;
    const auto number = [&](const char* name, double low, double high) {
        return numberField(context, object, name, place, low, high);
    };
    ours.stiffness = number("stiffness", 1e-30, kUnbounded);
    ours.damping = number("damping", 0.0, kUnbounded);
    ours.staticFriction = number("staticFriction", 0.0, kUnbounded);
    ours.dynamicFriction = number("dynamicFriction", 0.0, kUnbounded);
    ours.viscousFriction = number("viscousFriction", 0.0, kUnbounded);
    ours.normalTextureInfluence = number("normalTextureInfluence", 0.0, 1.0);
    ours.height = heightField(context, document, object, place);
    ours.friction = factorField(context, document, object, "frictionTexture", place);
    ours.stiffnessMap = factorField(context, document, object, "stiffnessTexture", place);
    ours.dampingMap = factorField(context, document, object, "dampingTexture", place);
    readChoices(context, object, place, ours);
    if (object.contains("shader")) {
        checkShader(context, object["shader"], place + ".shader");
        ours.shader = object["shader"];
    }
    ours.voxelSize = number("voxelSize", 1e-30, kUnbounded);
    tellUnavailable(context, ours, place);
    warnOfUnknown(context, object,
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

void readMpeg(ImportContext& context, const GltfDocument& document, size_t index, HapticLayers& says) {
    std::string place;
    const json& material = (*mpegMaterials(context, document, place))[index];
    place += "[" + std::to_string(index) + "]";
    says.mpegStiffness =
        mpegChannel(context, document, material, "stiffness", place, kMpegStiffnessMin, kMpegStiffnessMax);
    says.mpegFriction =
        mpegChannel(context, document, material, "friction", place, kMpegFrictionMin, kMpegFrictionMax);
    for (const auto& [channel, value] : material.items())
        if (channel != "name" && channel != "stiffness" && channel != "friction" && channel != "extensions" &&
            channel != "extras") {
            says.mpegUnavailable[channel] = value;
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

void readPhysics(ImportContext& context, const GltfDocument& document, size_t index, HapticLayers& says) {
    const json& material = (*physicsMaterials(context, document))[index];
    const std::string place =
        std::string("extensions.") + kPhysics + ".physicsMaterials[" + std::to_string(index) + "]";
    const auto friction = [&](const char* name) {
        return std::optional(
            numberField(context, material, name, place, 0.0, kUnbounded).value_or(kPhysicsFriction));
    };
    says.physicsStatic = friction("staticFriction");
    says.physicsDynamic = friction("dynamicFriction");
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

HapticLayers readHaptics(ImportContext& context, const GltfDocument& document, const SurfaceKey& key) {
    HapticLayers says;
    if (key.material >= 0)
        readOurs(context, document, static_cast<size_t>(key.material), says.ours);
    if (key.mpeg >= 0)
        readMpeg(context, document, static_cast<size_t>(key.mpeg), says);
    if (key.physics >= 0)
        readPhysics(context, document, static_cast<size_t>(key.physics), says);
    return says;
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

} // namespace touchstone
