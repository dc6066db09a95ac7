#include "haptics/scene/haptic_scene.h"
#include "haptics/scene/plan_effects.h"
#include "haptics/scene/scene_parts.h"
#include "haptics/scene/scene_programs.h"
#include "haptics/scene/shape_object.h"

#include <cmath>

namespace touchstone {

namespace {

ObjectUse objectUse(const Scene& scene, const Material& source, const HapticMaterialData& material) {
    ObjectUse use;
    if (scene.volume != nullptr) {
        use.implicit = true; // whatever its material states
        return use;
    }
    if (!source.haptic.implicit)
        return meshUse(material, source.haptic.sides == SideChoice::Front);
    use.implicit = true;
    use.voxelSize = source.haptic.voxelSize;
    use.fieldError = source.haptic.fieldError;
    use.fieldTexture = source.haptic.fieldTexture;
    return use;
}

/// The object of an instance: its mesh, or the distance field of its mesh or of the scene's volume.
std::shared_ptr<const HapticObject> builtObject(const Scene& scene, int instance,
                                                const Similarity& workspaceFromScene, const ObjectUse& use,
                                                std::vector<Warning>& warnings,
                                                const Progress& progress = {}) {
    if (scene.volume != nullptr)
        return volumeObject(scene, instance, workspaceFromScene, progress, warnings);
    if (!use.implicit)
        return buildHapticObject(scene, instance, workspaceFromScene, use, progress);
    const auto mesh =
        buildHapticObject(scene, instance, workspaceFromScene, ObjectUse{}, progress.part(0.0, 0.3));
    return fieldObject(*mesh, workspaceFromScene, use, progress.part(0.3, 1.0), warnings);
}

} // namespace

std::shared_ptr<HapticScene> copyOf(const HapticScene& scene) {
    auto copy = std::make_shared<HapticScene>();
    copy->objects = scene.objects;
    copy->wholeObjects = scene.wholeObjects;
    copy->restMotions = scene.restMotions;
    copy->restSpheres = scene.restSpheres;
    copy->boundingRadii = scene.boundingRadii;
    copy->materials = scene.materials;
    copy->programFromObject = scene.programFromObject;
    copy->texels = scene.texels;
    copy->plan = scene.plan;
    copy->workspaceFromScene = scene.workspaceFromScene;
    if (scene.hasRays())
        copy->buildRays(); // its objects have theirs already
    return copy;
}

void HapticScene::buildRays(const Progress& progress) const {
    size_t all = 0, done = 0;
    for (const auto& object : objects)
        all += object->triangleCount();
    for (const auto& object : objects) {
        const size_t after = done + object->triangleCount();
        if (object->shape == nullptr)
            object->rays.build(*object, progress.part(share(done, all), share(after, all)));
        done = after;
    }
    hasRays_.store(true, std::memory_order_release);
}

void HapticScene::buildNeighbourhoods() const {
    buildRays();
    neighbourhoods_.build([&] {
        std::vector<MeshAdjacency> all;
        all.reserve(objects.size());
        for (const auto& object : objects)
            all.emplace_back(object->vertices, object->indices);
        return all;
    });
}

void HapticScene::buildSlopes() const {
    slopes_.build([&] {
        std::vector<HapticMap::Slopes> all;
        all.reserve(materials.size());
        for (const HapticMaterialData& material : materials)
            all.push_back(material.height.texelSlopes());
        return all;
    });
}

std::shared_ptr<const HapticScene>
compileHapticScene(const Scene& scene, const Similarity& workspaceFromScene, const CompileOptions& options) {
    // Progress within a smaller object is not worth reporting.
    constexpr size_t kWorthReporting = 4096; // triangles
    constexpr double kMaps = 0.02;           // of all work
    const Progress progress = options.progress.part(0.0, options.rays ? 0.7 : 1.0);
    progress.step(0.0, "filtering maps");
    auto haptic = std::make_shared<HapticScene>();
    haptic->workspaceFromScene = workspaceFromScene;
    std::vector<MaterialUse> uses;
    for (const MaterialPlacement& at : materialPlacements(scene)) {
        const size_t m = uses.size();
        uses.emplace_back().placed = at.placed;
        haptic->materials.push_back(
            at.placed ? buildHapticMaterial(scene, scene.materials[m], m, at.sets, haptic->warnings)
                      : HapticMaterialData{});
        if (at.placed)
            addProgram(scene, scene.materials[m], m, nullptr, *haptic);
    }
    const uint64_t triangles = scene.triangleCount();
    uint64_t done = 0;
    const auto fraction = [&](uint64_t of) { return kMaps + (1.0 - kMaps) * share(of, triangles); };
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(scene.instances[i].mesh)];
        if (mesh.triangleCount() == 0)
            continue;
        const auto material = static_cast<size_t>(mesh.material);
        const Progress part = progress.part(fraction(done), fraction(done + mesh.triangleCount()));
        part.step(0.0, "placing vertices");
        const ObjectUse use = objectUse(scene, scene.materials[material], haptic->materials[material]);
        const bool small = mesh.triangleCount() < kWorthReporting && !use.implicit;
        auto object = builtObject(scene, static_cast<int>(i), workspaceFromScene, use, haptic->warnings,
                                  small ? part.silent() : part);
        done += mesh.triangleCount();
        uses[material].add(*object);
        haptic->restMotions.push_back({object->workspaceFromObject, object->workspaceFromObject});
        haptic->restSpheres.push_back(boundingSphere(*object, object->workspaceFromObject));
        haptic->boundingRadii.push_back(object->boundingRadius);
        haptic->objects.push_back(std::move(object));
    }
    for (size_t m = 0; m < scene.materials.size(); ++m)
        planMaterial(static_cast<int>(m), scene.materials[m], haptic->materials[m], uses[m], haptic->plan);
    placePrograms(scene, *haptic);
    placeTexels(nullptr, *haptic, progress.part(0.9, 1.0));
    settlePlan(*haptic);
    if (options.rays)
        haptic->buildRays(options.progress.part(0.7, 1.0));
    options.progress.report(1.0, "touchable");
    return haptic;
}

std::shared_ptr<HapticScene> withMaterials(const HapticScene& compiled, const Scene& scene,
                                           std::span<const Material> before,
                                           std::span<const Material> after) {
    const std::shared_ptr<HapticScene> haptic = copyOf(compiled);
    haptic->plan = {};
    std::vector<MaterialUse> uses;
    for (const MaterialPlacement& at : materialPlacements(scene)) {
        const size_t m = uses.size();
        uses.emplace_back().placed = at.placed;
        if (!at.placed)
            continue;
        haptic->materials[m] = buildHapticMaterial(scene, after[m], m, at.sets, haptic->warnings,
                                                   {&before[m], &compiled.materials[m]});
        addProgram(scene, after[m], m, compiled.materials[m].program.get(), *haptic);
    }
    bool sameMeshes = true;
    for (size_t k = 0; k < haptic->objects.size(); ++k) {
        std::shared_ptr<const HapticObject>& object = haptic->objects[k];
        const auto m = static_cast<size_t>(object->material);
        if (object->instance < 0 || m >= uses.size())
            continue; // geometry and material are not from the file
        const ObjectUse use = objectUse(scene, after[m], haptic->materials[m]);
        if (use != objectUse(scene, before[m], compiled.materials[m])) {
            const bool mesh = object->shape == nullptr;
            object = builtObject(scene, object->instance, compiled.workspaceFromScene, use, haptic->warnings);
            sameMeshes = sameMeshes && mesh && object->shape == nullptr;
            haptic->boundingRadii[k] = object->boundingRadius;
            haptic->restSpheres[k] = boundingSphere(*object, object->workspaceFromObject);
        }
        uses[m].add(*object);
    }
    if (sameMeshes)
        haptic->shareNeighbourhoods(compiled);
    if (compiled.hasRays())
        haptic->buildRays(); // of the rebuilt objects
    for (size_t m = 0; m < after.size(); ++m)
        planMaterial(static_cast<int>(m), after[m], haptic->materials[m], uses[m], haptic->plan);
    placePrograms(scene, *haptic);
    placeTexels(&compiled, *haptic);
    settlePlan(*haptic);
    return haptic;
}

} // namespace touchstone
