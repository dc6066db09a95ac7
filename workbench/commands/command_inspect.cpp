// What a model is, what it would feel like, what that costs, and what is wrong with it.

#include "devices/simulated_hand.h"
#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/output_file.h"
#include "engine/time/samples.h"
#include "haptics/haptic_step.h"
#include "haptics/servo/realtime_thread.h"
#include "workbench/commands.h"
#include "workbench/commands/effect_cost.h"
#include "workbench/model/model.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

const char* sourceName(HapticSource source) {
    switch (source) {
    case HapticSource::Touchstone:
        return "TOUCHSTONE_materials_haptic";
    case HapticSource::Mpeg:
        return "MPEG_haptic_material";
    case HapticSource::Physics:
        return "KHR_physics_rigid_bodies";
    case HapticSource::DerivedFromPbr:
        return "derived from the PBR material";
    case HapticSource::Default:
        return "default";
    }
    return "";
}

std::string mapName(const Scene& scene, const TextureRef& texture) {
    return texture ? "map '" + scene.images[static_cast<size_t>(texture.image)].name + "'" : "no map";
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

std::string shown(const Scene&, const float& value) {
    return number(static_cast<double>(value));
}
std::string shown(const Scene& scene, const HeightMap& map) {
    return mapName(scene, map.texture) + ", " + number(1e3 * static_cast<double>(map.scale)) +
           " mm black to white";
}
std::string shown(const Scene& scene, const FactorMap& map) {
    return mapName(scene, map.texture) + ", factor " + number(static_cast<double>(map.min)) + " to " +
           number(static_cast<double>(map.max));
}

/// The haptic fields that the file or its PBR material gives, each with where it comes from.
Json fieldsJson(const Scene& scene, const HapticMaterial& haptic) {
    Json fields = Json::object();
    const auto add = [&](const char* name, const auto& field, const char* unit) {
        if (field.value)
            fields[name] = {
                {"value", shown(scene, *field.value)}, {"unit", unit}, {"source", sourceName(field.source)}};
    };
    add("stiffness", haptic.stiffness, "N/m");
    add("damping", haptic.damping, "N s/m");
    add("staticFriction", haptic.staticFriction, "");
    add("dynamicFriction", haptic.dynamicFriction, "");
    add("viscousFriction", haptic.viscousFriction, "N s/m");
    add("normalTextureInfluence", haptic.normalTextureInfluence, "");
    add("heightTexture", haptic.height, "");
    add("frictionTexture", haptic.friction, "");
    add("stiffnessTexture", haptic.stiffnessMap, "");
    add("dampingTexture", haptic.dampingMap, "");
    return fields;
}

Json costJson(const EffectCost& cost) {
    if (!cost.nanoseconds)
        return nullptr;
    return *cost.nanoseconds;
}

Json materialsJson(const Model& model) {
    const std::vector<EffectCost> costs = effectCosts(*model.haptic);
    constexpr std::array kShading{"auto", "off", "twoPass", "projected", "direction", "bezier"};
    Json materials = Json::array();
    for (size_t m = 0; m < model.scene->materials.size(); ++m) {
        const Material& material = model.scene->materials[m];
        Json effects = Json::array();
        for (size_t i = 0; i < costs.size(); ++i) {
            const PlannedEffect& effect = model.haptic->plan.effects[i];
            if (effect.material == static_cast<int>(m))
                effects.push_back({{"effect", effectName(effect.effect)},
                                   {"on", effect.on},
                                   {"reason", effect.reason},
                                   {"memory_bytes", effect.memoryBytes},
                                   {"ns_per_tick", costJson(costs[i])},
                                   {"ns_over_ticks", costs[i].ticks}});
        }
        Json json{{"index", m},
                  {"name", material.name},
                  {"haptic", fieldsJson(*model.scene, material.haptic)},
                  {"forceShading", kShading[static_cast<size_t>(material.haptic.forceShading)]},
                  {"sides", material.haptic.sides == SideChoice::Both ? "both" : "front"},
                  {"effects", effects}};
        if (!material.haptic.unavailable.is_null())
            json["not_yet_available"] = material.haptic.unavailable;
        materials.push_back(std::move(json));
    }
    return materials;
}

Json imagesJson(const Scene& scene) {
    Json images = Json::array();
    for (const Image& image : scene.images)
        images.push_back({{"name", image.name},
                          {"width", image.width},
                          {"height", image.height},
                          {"channels", image.channels},
                          {"decoded", image.decoded},
                          {"encoded_bytes", image.encodedBytes},
                          {"problem", image.problem}});
    return images;
}

Json objectsJson(const Model& model) {
    Json objects = Json::array();
    for (const auto& object : model.haptic->objects)
        objects.push_back({{"name", object->name},
                           {"triangles", object->triangleCount()},
                           {"vertices", object->vertices.size() - 1},
                           {"welded_vertices", object->weldedVertices},
                           {"dropped_triangles", object->droppedTriangles},
                           {"closed", object->closed},
                           {"material", object->material},
                           {"memory_bytes", object->memoryBytes()}});
    return objects;
}

Json warningsJson(const Model& model) {
    Json warnings = Json::array();
    for (const auto* list : {&model.scene->warnings, &model.haptic->warnings})
        for (const Warning& warning : *list)
            warnings.push_back({{"place", warning.place}, {"message", warning.message}});
    return warnings;
}

Json vectorJson(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

/// Strokes the model for two seconds of its own time and tells the median cost of each stage of a tick, over
/// the ticks in contact. Null where there is nothing to touch or the stroke met nothing.
Json tickCostJson(const Model& model) {
    if (!model.scene->touchable())
        return nullptr;
    std::shared_ptr<const StrokePath> path;
    try {
        path = std::make_shared<StrokePath>(strokeOver(*model.scene, model.workspaceFromScene));
    } catch (const Error&) {
        return nullptr; // nowhere to press
    }
    enterFloatMode();
    SimulatedHand hand(path);
    constexpr int kTicks = 2000;
    std::array<Samples, kStageCount> stages;
    Samples whole;
    DeviceState state;
    WorldState world;
    HapticOutput output;
    StageStopwatch stopwatch;
    for (int i = 0; i < kTicks; ++i) {
        TickInput input;
        input.tick = static_cast<uint64_t>(i);
        input.time = 1e-3 * i;
        const DeviceSample sample = hand.sample(input.time);
        input.devices = {&sample, 1};
        hapticStep(*model.haptic, HapticSettings{}, input, world, {&state, 1}, {&output, 1}, stopwatch);
        if (output.contacts == 0)
            continue;
        int64_t sum = 0;
        for (size_t s = 0; s < kStageCount; ++s) {
            stages[s].add(stopwatch.nanoseconds[s]);
            sum += stopwatch.nanoseconds[s];
        }
        whole.add(sum);
    }
    if (whole.empty())
        return nullptr;
    Json json{{"ticks_in_contact", whole.count()}, {"all", whole.percentile(0.5)}};
    for (size_t s = 0; s < kStageCount; ++s)
        json[std::string(kStageNames[s])] = stages[s].percentile(0.5);
    return json;
}

/// What contact=neighbourhood would cost this model: nothing of it is there unless that is asked for.
Json neighbourhoodJson(const Model& model) {
    const long long begin = monotonicNs();
    model.haptic->buildNeighbourhoods();
    const double seconds = 1e-9 * static_cast<double>(monotonicNs() - begin);
    uint64_t bytes = 0, borders = 0, nonManifold = 0;
    for (const MeshAdjacency& adjacency : *model.haptic->neighbourhoods()) {
        bytes += adjacency.memoryBytes();
        borders += adjacency.borderEdges();
        nonManifold += adjacency.nonManifoldEdges();
    }
    return {{"memory_bytes", bytes},
            {"build_s", seconds},
            {"border_edges", borders},
            {"non_manifold_edges", nonManifold}};
}

/// The same for textureGradient=precomputed.
Json slopesJson(const Model& model) {
    const long long begin = monotonicNs();
    model.haptic->buildSlopes();
    const double seconds = 1e-9 * static_cast<double>(monotonicNs() - begin);
    uint64_t bytes = 0;
    for (const HapticMap::Slopes& map : *model.haptic->slopes())
        for (const auto& level : map)
            bytes += sizeof(level[0]) * level.size();
    return {{"memory_bytes", bytes}, {"build_s", seconds}};
}

Json inspectionJson(const InspectOptions& options, const Model& model) {
    const Scene& scene = *model.scene;
    Json animations = Json::array();
    for (const Animation& animation : scene.animations)
        animations.push_back({{"name", animation.name},
                              {"duration_s", animation.duration},
                              {"channels", animation.channels.size()}});
    return {{"command", "inspect"},
            {"scene", options.scene.string()},
            {"meshes", scene.meshes.size()},
            {"instances", scene.instances.size()},
            {"nodes", scene.nodes.size()},
            {"triangles", scene.triangleCount()},
            {"lines", scene.lineCount()},
            {"points", scene.pointCount()},
            {"touchable", scene.touchable()},
            {"bounds_m", scene.bounds.empty() ? Json()
                                              : Json{{"low", vectorJson(scene.bounds.low)},
                                                     {"high", vectorJson(scene.bounds.high)}}},
            {"workspace_from_scene_scale", model.workspaceFromScene.scale},
            {"extensions_used", scene.extensionsUsed},
            {"animations", animations},
            {"images", imagesJson(scene)},
            {"materials", materialsJson(model)},
            {"objects", objectsJson(model)},
            {"tick_p50_ns", tickCostJson(model)},
            {"neighbourhood", neighbourhoodJson(model)},
            {"slopes", slopesJson(model)},
            {"warnings", warningsJson(model)}};
}

void print(const char* format, const std::string& a, const std::string& b = {}) {
    std::printf(format, a.c_str(), b.c_str());
}

std::string text(const Json& json) {
    return json.is_string() ? json.get<std::string>() : json.dump();
}

void printEffects(const Json& material) {
    for (const auto& [name, field] : material["haptic"].items())
        std::printf("    %-24s %s %s (%s)\n", name.c_str(), text(field["value"]).c_str(),
                    text(field["unit"]).c_str(), text(field["source"]).c_str());
    for (const Json& effect : material["effects"])
        std::printf("    %-3s %-18s %10s bytes %6s ns  %s\n", effect["on"].get<bool>() ? "on" : "off",
                    text(effect["effect"]).c_str(), text(effect["memory_bytes"]).c_str(),
                    effect["ns_per_tick"].is_null() ? "?" : text(effect["ns_per_tick"]).c_str(),
                    text(effect["reason"]).c_str());
    if (material.contains("not_yet_available"))
        print("    not yet available: %s\n", material["not_yet_available"].dump());
}

void printInspection(const Json& json) {
    print("%s\n", text(json["scene"]));
    std::printf("  %s triangles in %s meshes, %s instances, %s materials, %s images\n",
                text(json["triangles"]).c_str(), text(json["meshes"]).c_str(),
                text(json["instances"]).c_str(), std::to_string(json["materials"].size()).c_str(),
                std::to_string(json["images"].size()).c_str());
    if (json["lines"] > 0 || json["points"] > 0)
        print("  %s line segments and %s points, which are drawn but not felt\n", text(json["lines"]),
              text(json["points"]));
    if (!json["bounds_m"].is_null())
        print("  bounds %s to %s m", text(json["bounds_m"]["low"]), text(json["bounds_m"]["high"]));
    print(", fitted to the workspace by a factor of %s\n", text(json["workspace_from_scene_scale"]));
    if (!json["extensions_used"].empty())
        print("  extensions %s\n", json["extensions_used"].dump());
    for (const Json& animation : json["animations"])
        print("  animation '%s', %s s\n", text(animation["name"]), text(animation["duration_s"]));
    const auto decoded = std::count_if(json["images"].begin(), json["images"].end(),
                                       [](const Json& image) { return image["decoded"].get<bool>(); });
    if (!json["images"].empty())
        std::printf("  %td of %zu images decoded: those that the effects below read\n", decoded,
                    json["images"].size());
    for (const Json& object : json["objects"])
        std::printf("  object '%s': %s triangles, %s, %s vertices welded, %s triangles dropped\n",
                    text(object["name"]).c_str(), text(object["triangles"]).c_str(),
                    object["closed"].get<bool>() ? "closed" : "open", text(object["welded_vertices"]).c_str(),
                    text(object["dropped_triangles"]).c_str());
    for (const Json& material : json["materials"]) {
        print("  material %s '%s'\n", text(material["index"]), text(material["name"]));
        printEffects(material);
    }
    if (!json["tick_p50_ns"].is_null()) {
        std::printf("  ns per tick in contact (median of a stroke):");
        for (const auto& [stage, cost] : json["tick_p50_ns"].items())
            if (stage != "ticks_in_contact")
                std::printf(" %s %s", stage.c_str(), text(cost).c_str());
        std::printf("\n");
    }
    const Json& walk = json["neighbourhood"];
    std::printf(
        "  contact=neighbourhood would take %s bytes and %.3f s; %s border edges, %s of more than two "
        "triangles\n",
        text(walk["memory_bytes"]).c_str(), walk["build_s"].get<double>(), text(walk["border_edges"]).c_str(),
        text(walk["non_manifold_edges"]).c_str());
    if (const Json& slopes = json["slopes"]; slopes["memory_bytes"] > 0)
        std::printf("  textureGradient=precomputed would take %s bytes and %.3f s\n",
                    text(slopes["memory_bytes"]).c_str(), slopes["build_s"].get<double>());
    for (const Json& warning : json["warnings"])
        print("  warning: %s: %s\n", text(warning["place"]), text(warning["message"]));
}

} // namespace

int inspectCommand(const InspectOptions& options) {
    const Model model = loadModelToTouch(options.scene, Fit::Workspace, DeviceLimits{});
    const Json json = inspectionJson(options, model);
    printInspection(json);
    // A name that is not UTF-8 must not cost the answer: it is replaced.
    if (!options.json.empty())
        writeFile(options.json, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return 0;
}

} // namespace touchstone
