#include "workbench/figures/inspection.h"

#include "devices/simulated/simulated_hand.h"
#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/scene/animation.h"
#include "engine/scene/haptic_numbers.h"
#include "engine/scene/mesh_deformation.h"
#include "engine/time/samples.h"
#include "engine/volume/volume.h"
#include "haptics/program/felt_program.h"
#include "haptics/scene/scene_programs.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/shape/field/cut_field.h"
#include "haptics/shape/field/field_error.h"
#include "haptics/tick/stepped_hand.h"
#include "workbench/figures/effect_cost.h"
#include "workbench/figures/perception_figures.h"
#include "workbench/figures/program_figures.h"
#include "workbench/figures/texture_figures.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

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

/// The haptic fields from the file or its PBR material, each with its origin.
Json fieldsJson(const Scene& scene, const Material& material) {
    const HapticMaterial& haptic = material.haptic;
    Json fields = Json::object();
    const auto add = [&](std::string_view name, const auto& field, std::string_view unit) {
        if (field.value)
            fields[std::string(name)] = {
                {"value", shown(scene, *field.value)}, {"unit", unit}, {"source", sourceName(field.source)}};
    };
    for (const HapticNumber& number : hapticNumbers())
        if (number.settled != nullptr)
            add(number.name, haptic.*number.settled, number.unit);
        else
            add(number.name,
                HapticMaterial::Field<float>{material.says.ours.*number.stated, HapticSource::Touchstone},
                number.unit);
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

/// What the program's texture takes: its texels, and where they lie on each object.
Json persistentTextureJson(const HapticScene& haptic, const PersistentTextureSize& size, size_t material) {
    uint64_t bytes = 0, objects = 0;
    for (size_t k = 0; k < haptic.texels.size(); ++k)
        if (haptic.texels[k] != nullptr && haptic.objects[k]->material == static_cast<int>(material)) {
            bytes += haptic.texels[k]->memoryBytes() + sizeof(float) * size.width * size.height;
            ++objects;
        }
    return {{"width", size.width},     {"height", size.height},   {"initial", size.initial},
            {"minimum", size.minimum}, {"maximum", size.maximum}, {"objects", objects},
            {"memory_bytes", bytes}};
}

/// What the file has of the textures of the material's objects.
Json savedTexturesJson(const HapticScene& haptic, size_t material) {
    Json saved = Json::array();
    const std::shared_ptr<PersistentTextures> textures = persistentTextures(haptic);
    for (const Coverage& coverage : coverageOf(haptic, textures.get())) {
        const HapticObject& object = *haptic.objects[static_cast<size_t>(coverage.object)];
        if (object.material == static_cast<int>(material) &&
            textures->at(coverage.object)->start() != nullptr)
            saved.push_back({{"object", object.name},
                             {"left_percent", 100.0 * coverage.left},
                             {"removed_percent", 100.0 * coverage.removed}});
    }
    return saved;
}

Json programJson(const program::FeltProgram& program, const MaterialProgram& material, int64_t longestNs) {
    Json parameters = Json::object();
    const auto& declared = material.compiled->source.parameters;
    for (size_t i = 0; i < declared.size(); ++i)
        parameters[declared[i].name] = std::vector<double>(
            material.values[i].begin(),
            material.values[i].begin() + static_cast<std::ptrdiff_t>(declared[i].components));
    Json json{{"name", program.name}, {"displaces", program.displaces}};
    json.update(programFigures(program.code, program.compiled->text, longestNs));
    json["parameters"] = parameters;
    return json;
}

Json materialsJson(const Model& model, int64_t longestNs) {
    const std::vector<EffectCost> costs = effectCosts(*model.haptic, longestNs);
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
                  {"haptic", fieldsJson(*model.scene, material)},
                  {"forceShading", kShading[static_cast<size_t>(material.haptic.forceShading)]},
                  {"sides", material.haptic.sides == SideChoice::Both ? "both" : "front"},
                  {"effects", effects}};
        if (!material.haptic.unavailable.is_null())
            json["not_yet_available"] = material.haptic.unavailable;
        if (const auto& program = model.haptic->materials[m].program; program != nullptr) {
            json["program"] = programJson(*program, material.haptic.program, longestNs);
            if (program->texture.width > 0)
                json["program"]["persistentTexture"] =
                    persistentTextureJson(*model.haptic, program->texture, m);
            if (program->start != nullptr)
                json["program"]["persistentTexture"]["saved"] = savedTexturesJson(*model.haptic, m);
        }
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

/// Of an object that is felt as the distance field of its mesh; empty for any other. Lengths in model metres.
Json fieldJson(const Model& model, const HapticObject& object) {
    const auto* field = dynamic_cast<const FieldShape*>(object.shape.get());
    if (field == nullptr || model.scene->volume != nullptr)
        return {};
    const auto mesh =
        buildHapticObject(*model.scene, object.instance, model.haptic->workspaceFromScene, ObjectUse{});
    const double modelPerObject = object.workspaceFromObject.scale / model.haptic->workspaceFromScene.scale;
    return {{"voxel_m", modelPerObject * field->voxel()},
            {"error_m", modelPerObject * fieldErrorOf(*mesh, *field)},
            {"memory_bytes", field->grid().memoryBytes()}};
}

Json objectsJson(const Model& model) {
    Json objects = Json::array();
    for (const auto& object : model.haptic->objects) {
        objects.push_back({{"name", object->name},
                           {"triangles", object->triangleCount()},
                           {"representation", object->shape != nullptr ? "implicit" : "mesh"},
                           {"vertices", object->shape != nullptr ? 0 : object->vertices.size() - 1},
                           {"welded_vertices", object->weldedVertices},
                           {"dropped_triangles", object->droppedTriangles},
                           {"closed", object->closed},
                           {"material", object->material},
                           {"memory_bytes", object->memoryBytes()}});
        if (Json field = fieldJson(model, *object); !field.is_null())
            objects.back()["field"] = std::move(field);
    }
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

/// The cameras that `render --camera` takes; lengths in m.
Json camerasJson(const Scene& scene) {
    Json cameras = Json::array();
    for (const SceneCamera& camera : scene.cameras) {
        Json json{{"index", camera.index},
                  {"name", camera.name},
                  {"node", camera.nodeName},
                  {"type", camera.orthographic ? "orthographic" : "perspective"},
                  {"position_m", vectorJson(camera.eye)},
                  {"direction", vectorJson(-camera.axes[2])},
                  {"up", vectorJson(camera.axes[1])}};
        if (camera.orthographic)
            json["height_m"] = 2.0 * camera.halfHeight;
        else
            json["fov_deg"] = glm::degrees(camera.fovY);
        cameras.push_back(std::move(json));
    }
    return cameras;
}

/// Strokes the model for two seconds of simulated time, or `longestNs` ns, and returns the median cost of
/// each stage over the contact ticks. Null where no stroke can be laid (for example, all triangles have zero
/// area) or it met nothing.
Json tickCostJson(const Model& model, int64_t longestNs) {
    std::shared_ptr<const StrokePath> path;
    try {
        path = std::make_shared<StrokePath>(strokeOver(*model.scene, model.workspaceFromScene));
    } catch (const Error&) {
        return nullptr;
    }
    enterFloatMode();
    SimulatedHand hand(path);
    constexpr int kTicks = 2000;
    constexpr double kTick = 1e-3; // s
    std::array<Samples, kStageCount> stages;
    Samples whole;
    SteppedHand touch(*model.haptic);
    StageStopwatch stopwatch;
    const long long end = monotonicNs() + longestNs;
    for (int i = 0; i < kTicks && monotonicNs() < end; ++i) {
        const HapticOutput& output = touch.step(HapticSettings{}, hand.sample(kTick * i), kTick, stopwatch);
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

/// The cost of contact=neighbourhood for this model; the structures are built only on request.
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

Json volumeJson(const Model& model) {
    const Volume& volume = *model.scene->volume;
    const VolumeFacts& facts = volume.facts();
    uint64_t field = 0;
    for (const auto& object : model.haptic->objects)
        if (const FieldShape* const shape = wholeField(object->shape.get()))
            field += shape->grid().memoryBytes();
    return {
        {"format", facts.format},
        {"type", facts.fileType},
        {"voxels", {facts.size.x, facts.size.y, facts.size.z}},
        {"spacing_m", {glm::length(facts.axes[0]), glm::length(facts.axes[1]), glm::length(facts.axes[2])}},
        {"values", {{"low", volume.low()}, {"high", volume.high()}}},
        {"iso", model.scene->iso},
        {"default_iso", volume.defaultIso()},
        {"memory_bytes", volume.memoryBytes()},
        {"field_memory_bytes", field}};
}

} // namespace

Json inspectionOf(const Model& model, int64_t longestNs) {
    const Scene& scene = *model.scene;
    Json animations = Json::array();
    const Animation* const played = playedAnimation(scene);
    for (const Animation& animation : scene.animations) {
        const std::vector<bool> moved = movedNodes(scene, animation);
        const auto deforms = std::ranges::count_if(scene.meshes, [&](const Mesh& mesh) {
            return mesh.deformation != nullptr && mesh.deformation->drivenBy(animation, moved);
        });
        animations.push_back({{"name", animation.name},
                              {"duration_s", animation.duration},
                              {"channels", animation.channels.size()},
                              {"deformed_meshes", deforms},
                              {"plays", &animation == played}});
    }
    Json json{{"command", "inspect"},
              {"scene", scene.path},
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
              {"cameras", camerasJson(scene)},
              {"images", imagesJson(scene)},
              {"materials", materialsJson(model, longestNs)},
              {"objects", objectsJson(model)},
              {"perception", perceptionJson(model)},
              {"tick_p50_ns", tickCostJson(model, longestNs)},
              {"neighbourhood", neighbourhoodJson(model)},
              {"slopes", slopesJson(model)},
              {"warnings", warningsJson(model)}};
    if (scene.volume != nullptr)
        json["volume"] = volumeJson(model);
    return json;
}

} // namespace touchstone
