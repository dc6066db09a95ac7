#include "engine/import/materials/gltf_haptics.h"

#include "engine/import/file/choice_field.h"
#include "engine/import/file/json_fields.h"
#include "engine/import/materials/gltf_mpeg.h"
#include "engine/scene/haptic_numbers.h"

#include <algorithm>
#include <array>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr double kUnbounded = kLargestHapticNumber;
constexpr const char* kOurs = "TOUCHSTONE_materials_haptic";
constexpr const char* kPhysics = "KHR_physics_rigid_bodies";

/// Warns of unknown fields, so that a misspelt field does not pass unnoticed.
void warnOfUnknown(ImportContext& context, const json& object, std::span<const std::string_view> known,
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
    warnOfUnknown(context, *found, std::array<std::string_view, 4>{"index", "texCoord", "scale", "midLevel"},
                  at);
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
    warnOfUnknown(context, *found, std::array<std::string_view, 4>{"index", "texCoord", "min", "max"}, at);
    return map.texture ? std::optional(map) : std::nullopt;
}

void tellMeaningless(ImportContext& context, const HapticStatement& ours, const std::string& place) {
    const bool implicit = ours.implicit.value_or(false);
    for (const HapticNumber& number : hapticNumbers())
        if (number.settled == nullptr && ours.*number.stated && !implicit)
            context.warn(place + "." + std::string(number.name),
                         "has no meaning without representation \"implicit\"");
    if (implicit && ours.latticeAmplitude.value_or(0.0f) > 0.0f && !ours.latticeWavelength)
        context.warn(place + ".latticeAmplitude", "has no meaning without latticeWavelength");
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

/// The node to which the collider of node `index` applies, and its physics material, -1 without one.
std::pair<size_t, int> colliderOf(const ImportContext& context, const GltfDocument& document, size_t index,
                                  size_t materialCount) {
    const std::string place = element("nodes", index);
    const json* body = extensionOf(context, document.json["nodes"][index], kPhysics, place);
    if (body == nullptr || !body->contains("collider"))
        return {index, -1};
    const std::string at = place + ".extensions." + kPhysics + ".collider";
    const json& collider = (*body)["collider"];
    if (!collider.is_object())
        context.fail(at, "should be an object", "correct the extension in the file");
    const int chosen =
        indexField(context, collider, "physicsMaterial", at, materialCount, "physicsMaterials").value_or(-1);
    const auto& nodes = document.model.nodes;
    if (nodes[index].mesh >= 0 || !collider.contains("geometry") || !collider["geometry"].is_object())
        return {index, chosen};
    const auto target =
        indexField(context, collider["geometry"], "node", at + ".geometry", nodes.size(), "nodes");
    return {target ? static_cast<size_t>(*target) : index, chosen};
}

/// For every node: itself or its nearest ancestor that has a mesh, -1 if there is none. Top down, so that a
/// long chain of nodes takes linear time.
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

} // namespace

HapticStatement readStatement(ImportContext& context, const GltfDocument& document, size_t material,
                              ShaderReader& shaders) {
    HapticStatement ours;
    const std::string owner = element("materials", material);
    const json* found = extensionOf(context, document.json["materials"][material], kOurs, owner);
    if (found == nullptr)
        return ours;
    const json& object = *found;
    const std::string place = owner + ".extensions." + kOurs;
    std::vector<std::string_view> known{
        "heightTexture",  "frictionTexture", "stiffnessTexture",
        "dampingTexture", "forceShading",    "representation",
        "shader",         "sides",           "textureMapping"}; // geometry/texture_mapping
    for (const HapticNumber& number : hapticNumbers()) {
        ours.*number.stated =
            numberField(context, object, number.name.data(), place, number.least, number.most);
        known.push_back(number.name);
    }
    ours.height = heightField(context, document, object, place);
    ours.friction = factorField(context, document, object, "frictionTexture", place);
    ours.stiffnessMap = factorField(context, document, object, "stiffnessTexture", place);
    ours.dampingMap = factorField(context, document, object, "dampingTexture", place);
    readChoices(context, object, place, ours);
    if (object.contains("shader"))
        shaders.read(object["shader"], place + ".shader", ours);
    tellMeaningless(context, ours, place);
    warnOfUnknown(context, object, known, place);
    return ours;
}

void readPhysics(ImportContext& context, const GltfDocument& document, size_t index, HapticLayers& says) {
    (void)context.attempt("felt without it", [&] {
        const json& material = (*physicsMaterials(context, document))[index];
        const std::string place =
            std::string("extensions.") + kPhysics + ".physicsMaterials[" + std::to_string(index) + "]";
        if (!material.is_object())
            context.fail(place, "should be an object", "correct the extension in the file");
        const auto friction = [&](const char* name) {
            return std::optional(
                numberField(context, material, name, place, 0.0, kUnbounded).value_or(kPhysicsFriction));
        };
        says.physicsStatic = friction("staticFriction");
        says.physicsDynamic = friction("dynamicFriction");
    });
}

std::vector<int> physicsMaterialOfNodes(ImportContext& context, const GltfDocument& document) {
    const auto& nodes = document.model.nodes;
    std::vector<int> material(nodes.size(), -1);
    const json* materials = nullptr;
    (void)context.attempt("felt without it", [&] { materials = physicsMaterials(context, document); });
    if (materials == nullptr)
        return material;
    const std::vector<int> meshAbove = nearestMeshNodes(document.model);
    for (size_t i = 0; i < nodes.size(); ++i)
        (void)context.attempt("felt without it", [&] {
            const auto [target, chosen] = colliderOf(context, document, i, materials->size());
            if (chosen >= 0 && meshAbove[target] >= 0)
                material[static_cast<size_t>(meshAbove[target])] = chosen;
        });
    return material;
}

} // namespace touchstone
