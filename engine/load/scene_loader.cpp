#include "engine/load/scene_loader.h"

#include "engine/import/file/gltf_schema.h"
#include "engine/import/file/gltf_validation.h"
#include "engine/import/geometry/accessor_values.h"
#include "engine/import/geometry/gltf_animations.h"
#include "engine/import/geometry/gltf_cameras.h"
#include "engine/import/geometry/scene_build.h"
#include "engine/import/geometry/skin.h"
#include "engine/import/materials/gltf_images.h"
#include "engine/import/mesh_file/mesh_import.h"
#include "engine/import/physics/gltf_physics.h"
#include "engine/import/physics/gltf_soft_bodies.h"
#include "engine/import/volume_file/volume_edits.h"
#include "engine/import/volume_file/volume_import.h"
#include "engine/import/volume_file/volume_scene.h"
#include "engine/load/loose_bodies.h"
#include "engine/load/surface_edits.h"
#include "engine/save/material_patch.h"
#include "engine/scene/haptic_layers.h"

#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <utility>

namespace touchstone {
namespace {

std::shared_ptr<Scene> importGltf(ImportContext& context, GltfFile file, const FileStamp& stamp,
                                  const std::optional<std::string>& animation) {
    // 1. Check and repair: the structure of the JSON, then the relations of its parts. Valid data needs no
    // further checks.
    context.step(0.2, "checking");
    checkSchema(context, file.json);
    validateGltf(context, file.json);

    // 2. Bytes: buffers from all sources, decompressed.
    context.step(0.22, "reading buffers");
    const GltfDocument document = makeDocument(context, file);
    context.enter(context.progress().part(0.25, 0.35));
    warnOfAccessorValues(context, document);

    // 3. Structure: nodes parents first, materials with appearance and haptic properties, meshes placed on
    // the nodes.
    auto scene = std::make_shared<Scene>();
    scene->path = context.file();
    scene->file = stamp;
    if (file.json.contains("extensionsUsed"))
        scene->extensionsUsed = file.json["extensionsUsed"];
    NodeForest forest = readNodes(context, document);
    scene->nodes = std::move(forest.nodes);
    MaterialTable materials(context, document);
    scene->animations = readAnimations(context, document, forest, scene->nodes); // they tell what deforms
    buildMeshesAndInstances(context, document, forest, materials, *scene);
    scene->materials = materials.take();
    scene->textures = readTextures(context, document);
    scene->cameras = readCameras(context, document, forest, scene->nodes);
    scene->animation = chosenAnimation(context, scene->animations, animation);
    scene->physics = readPhysicsBodies(context, document, forest, *scene);
    readSoftBodies(context, document, forest, *scene);
    context.enter(context.progress().part(0.8, 0.85));
    scene->bounds = sceneBounds(context, *scene);

    // 4. Images: only used ones are decoded; a broken one costs a warning, not the model.
    scene->images = readImages(context, file, document, *scene, context.options().images);
    dropBrokenImages(scene->images, scene->materials);
    for (Material& material : scene->materials) {
        material.says.meanRoughness = statedRoughness(material, scene->images);
        material.haptic = settledHaptics(material.says, scene->images);
    }

    if (!scene->touchable())
        context.warn("", "nothing to touch: the scene shows no triangles");
    scene->warnings = context.takeWarnings();
    context.step(1.0, "done");
    return scene;
}

ScenePtr importBytes(ImportContext& context, std::vector<uint8_t> bytes,
                     const std::filesystem::path& folder) {
    context.step(0.15, "knowing the file again");
    const FileStamp stamp = stampOf(bytes);
    bytes = asGltf(context, std::move(bytes));
    std::string edits = context.options().edits;
    std::optional<std::string> animation = takeAnimation(edits);
    const bool loose = takeLoose(edits);
    const SurfaceNumbers surface = takeSurfaceNumbers(edits);
    if (context.options().animation)
        animation = context.options().animation;
    if (!edits.empty())
        bytes = withMaterials(bytes, patchesFrom(edits), context.file());
    const auto scene =
        importGltf(context, takeGltfApart(context, std::move(bytes), folder), stamp, animation);
    if (loose)
        loosen(*scene);
    stateSurfaceNumbers(*scene, surface);
    return scene;
}

/// The surface becomes a mesh for the eye; the hand feels the volume.
ScenePtr importVolume(ImportContext& context, const std::filesystem::path& path, VolumeFormat format) {
    std::shared_ptr<const Volume> volume = context.options().volume;
    if (volume == nullptr) {
        std::error_code problem;
        const uint64_t size = std::filesystem::file_size(path, problem);
        volume = readVolume(context, path, format, installedVolumeReader(format, problem ? 0 : size));
    }
    std::string edits = context.options().edits;
    const std::optional<double> editedIso = takeIso(edits);
    const double iso = context.options().iso.value_or(editedIso.value_or(volume->defaultIso()));
    std::vector<uint8_t> glb = glbOfVolume(context, *volume, iso);
    const SurfaceNumbers surface = takeSurfaceNumbers(edits);
    if (!edits.empty())
        glb = withMaterials(glb, patchesFrom(edits), context.file());
    for (const std::string& note : volume->facts().notes)
        context.warn("volume", note);
    context.countFileBytes(volume->memoryBytes());
    const auto scene = importGltf(context, takeGltfApart(context, std::move(glb), path.parent_path()),
                                  volume->facts().file, std::nullopt);
    stateSurfaceNumbers(*scene, surface);
    scene->bounds = volume->bounds(); // whatever the value at the surface
    scene->volume = std::move(volume);
    scene->iso = iso;
    return scene;
}

} // namespace

ScenePtr loadScene(const std::filesystem::path& path, const LoadOptions& options) {
    ImportContext context(path.string(), options);
    try {
        context.step(0.0, "reading the file");
        if (const auto format = volumeFormatNamed(path))
            return importVolume(context, path, *format);
        checkMeshSize(path);
        return importBytes(context, readWholeFile(path, context.file(), context.progress().part(0.0, 0.15)),
                           path.parent_path());
    } catch (const std::bad_alloc&) {
        context.fail("", "there is not enough memory for it", "close other programs, or simplify the model");
    }
}

ScenePtr loadSceneFromMemory(std::vector<uint8_t> bytes, const std::filesystem::path& folder,
                             const LoadOptions& options) {
    ImportContext context("memory", options);
    try {
        return importBytes(context, std::move(bytes), folder);
    } catch (const std::bad_alloc&) {
        context.fail("", "there is not enough memory for it", "simplify the model");
    }
}

} // namespace touchstone
