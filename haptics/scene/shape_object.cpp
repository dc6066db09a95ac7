#include "haptics/scene/shape_object.h"

#include "engine/core/error.h"
#include "engine/device_io/device_io.h"
#include "haptics/shape/field/field_error.h"
#include "haptics/shape/field/volume_to_field.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

namespace {

/// Of the process.
FieldCache& fieldCache() {
    static FieldCache cache({}, 0);
    return cache;
}

std::shared_ptr<HapticObject> objectOf(std::string name, std::shared_ptr<const Shape> shape, int material,
                                       const Similarity& workspaceFromObject) {
    auto object = std::make_shared<HapticObject>();
    object->name = std::move(name);
    object->material = material;
    object->workspaceFromObject = workspaceFromObject;
    object->boundingRadius = shape->boundingRadius();
    object->diagonal = 2.0 * object->boundingRadius;
    object->closed = true;
    object->anySmooth = shape->hasShadingNormals();
    object->shape = std::move(shape);
    return object;
}

} // namespace

std::shared_ptr<HapticObject> withShape(const HapticObject& object, std::shared_ptr<const Shape> shape) {
    auto made = objectOf(object.name, std::move(shape), object.material, object.workspaceFromObject);
    made->instance = object.instance;
    made->objectFromMesh = object.objectFromMesh;
    made->oneSided = object.oneSided;
    made->shell = object.shell;
    return made;
}

std::vector<int> shellsOf(const HapticScene& scene) {
    std::vector<int> shells;
    for (const auto& object : scene.objects)
        if (object->shell && object->instance >= 0)
            shells.push_back(object->instance);
    std::ranges::sort(shells);
    return shells;
}

void keepFieldsIn(const FieldCache& cache) {
    fieldCache() = cache;
}

FieldDepths fieldDepths() {
    constexpr double kRoom = 1.5, kLargestBall = 5e-3;
    const DeviceLimits limits;
    return {kRoom * limits.maxForce / limits.recommendedStiffness, kRoom * kLargestBall};
}

int addShape(HapticScene& scene, std::string name, std::shared_ptr<const Shape> shape, int material,
             const Similarity& workspaceFromObject) {
    const auto refuse = [&](const char* what, const char* remedy) { throw Error(name, "", what, remedy); };
    if (shape == nullptr || !(shape->boundingRadius() > 0.0) || !std::isfinite(shape->boundingRadius()))
        refuse("the shape has no finite size", "bound it");
    if (material < 0 || static_cast<size_t>(material) >= scene.materials.size())
        refuse("the shape names a material that the scene does not have", "add the material first");
    if (scene.neighbourhoods() != nullptr)
        refuse("the neighbourhoods of the scene are built", "add shapes before");
    auto object = objectOf(std::move(name), std::move(shape), material, workspaceFromObject);
    scene.restMotions.push_back({workspaceFromObject, workspaceFromObject});
    scene.restSpheres.push_back(boundingSphere(*object, workspaceFromObject));
    scene.boundingRadii.push_back(object->boundingRadius);
    if (!scene.programFromObject.empty())
        scene.programFromObject.push_back(
            {.scale = scene.workspaceFromScene.inverseTimes(workspaceFromObject).scale});
    scene.objects.push_back(std::move(object));
    settlePlan(scene);
    return static_cast<int>(scene.objects.size()) - 1;
}

namespace {

using Grid = std::shared_ptr<const FieldGrid>;

std::string placeOf(const HapticObject& mesh, const char* field) {
    return "materials[" + std::to_string(mesh.material) + "]." + field;
}

/// What the material lays on its fields, object units; none, and a warning, where it is too high for the
/// object.
FieldRelief reliefFor(const HapticObject& mesh, const FieldTexture& texture, double objectPerModel,
                      std::vector<Warning>& warnings) {
    constexpr double kHighest = 0.1; // object units
    FieldRelief relief{.noise = static_cast<double>(texture.noiseAmplitude) * objectPerModel,
                       .noiseWavelength = static_cast<double>(texture.noiseWavelength) * objectPerModel,
                       .seed = static_cast<uint64_t>(texture.noiseSeed)};
    if (texture.latticeWavelength > 0.0f) {
        relief.lattice = static_cast<double>(texture.latticeAmplitude) * objectPerModel;
        relief.latticeWavelength = static_cast<double>(texture.latticeWavelength) * objectPerModel;
    }
    if (relief.highest() <= kHighest)
        return relief;
    const bool byNoise = FieldRelief::kMostDeviations * relief.noise > relief.lattice;
    warnings.push_back({placeOf(mesh, byNoise ? "noiseAmplitude" : "latticeAmplitude"),
                        "is too high for " + mesh.name +
                            ": four deviations of the noise and the lattice may be " +
                            std::to_string(kHighest / objectPerModel) + " m in all; felt without"});
    return {};
}

/// A wave of few voxels is another one between the nodes.
void checkWaves(const HapticObject& mesh, const FieldRelief& relief, double voxel,
                std::vector<Warning>& warnings) {
    constexpr double kFewest = 4.0; // voxels
    const auto check = [&](const char* name, double amplitude, double wavelength) {
        if (amplitude > 0.0 && wavelength > 0.0 && wavelength < kFewest * voxel)
            warnings.push_back({placeOf(mesh, name),
                                "is less than four voxels of " + mesh.name +
                                    ": the field holds another pattern. Make the waves longer or the voxels "
                                    "smaller"});
    };
    check("noiseWavelength", relief.noise, relief.noiseWavelength);
    check("latticeWavelength", relief.lattice, relief.latticeWavelength);
}

/// With the voxel that the material asks for, or else the usual one. `objectPerModel`: lengths.
Grid gridOfVoxel(const HapticObject& mesh, FieldRequest request, float voxelSize, double objectPerModel,
                 const Progress& progress, std::vector<Warning>& warnings) {
    constexpr double kCoarsest = 0.25; // object units
    if (voxelSize > 0.0f)
        request.voxel = static_cast<double>(voxelSize) * objectPerModel;
    const double finest =
        finestVoxel(mesh, std::max(request.outside, reachOf(request.relief, request.voxel)));
    if (request.voxel < finest || request.voxel > kCoarsest) {
        const FieldRequest usual;
        const char* const why =
            request.voxel < finest ? "needs too many cells for " : "is larger than a quarter of ";
        warnings.push_back({placeOf(mesh, "voxelSize"),
                            why + mesh.name + ": " + std::to_string(finest / objectPerModel) + " to " +
                                std::to_string(kCoarsest / objectPerModel) + " m fit; felt with " +
                                std::to_string(usual.voxel / objectPerModel) + " m"});
        request.voxel = usual.voxel;
    }
    return fieldOfMesh(mesh, request, fieldCache(), progress);
}

/// With the voxel that keeps its surface, without the relief, as near to the triangles as the material asks.
Grid gridOfError(const HapticObject& mesh, FieldRequest request, float fieldError, double objectPerModel,
                 const Progress& progress, std::vector<Warning>& warnings) {
    const double error = static_cast<double>(fieldError) * objectPerModel;
    const FieldRelief relief = std::exchange(request.relief, {});
    // The relief's field has no more cells than this one.
    request.outside = std::max(request.outside, reachOf(relief, kCoarsestWithin));
    const FittedField field =
        fieldWithin(mesh, request, error, fieldCache(), relief.empty() ? progress : progress.part(0.0, 0.7));
    if (field.error > error)
        warnings.push_back({placeOf(mesh, "fieldError"),
                            "needs too many cells for " + mesh.name + ": felt with voxels of " +
                                std::to_string(field.grid->layout().voxel / objectPerModel) +
                                " m, off by up to " + std::to_string(field.error / objectPerModel) + " m"});
    if (relief.empty())
        return field.grid;
    request.relief = relief;
    request.voxel = field.grid->layout().voxel;
    return fieldOfMesh(mesh, request, fieldCache(), progress.part(0.7, 1.0));
}

} // namespace

std::shared_ptr<const HapticObject> fieldObject(const HapticObject& mesh,
                                                const Similarity& workspaceFromScene, const ObjectUse& use,
                                                const Progress& progress, std::vector<Warning>& warnings) {
    constexpr double kDeepest = 1.0, kFarthest = 0.25; // object units
    const double scale = mesh.workspaceFromObject.scale, objectPerModel = workspaceFromScene.scale / scale;
    FieldRequest request;
    request.inside = std::min(kDeepest, fieldDepths().inside / scale);
    request.outside = std::clamp(fieldDepths().outside / scale, request.outside, kFarthest);
    request.relief = reliefFor(mesh, use.fieldTexture, objectPerModel, warnings);
    const bool byError = use.fieldError > 0.0f && !(use.voxelSize > 0.0f);
    Grid grid = byError ? gridOfError(mesh, request, use.fieldError, objectPerModel, progress, warnings)
                        : gridOfVoxel(mesh, request, use.voxelSize, objectPerModel, progress, warnings);
    checkWaves(mesh, request.relief, grid->layout().voxel, warnings);
    std::shared_ptr<HapticObject> made = withShape(mesh, std::make_shared<FieldShape>(std::move(grid)));
    // A closed mesh too thin to hold a node is a shell, too, but its two sides leave nothing between them.
    made->shell = !mesh.closed;
    return made;
}

std::shared_ptr<const HapticObject> volumeObject(const Scene& scene, int instance,
                                                 const Similarity& workspaceFromScene,
                                                 const Progress& progress, std::vector<Warning>& warnings) {
    constexpr double kFarthest = 0.25; // of the volume's longest side
    const Mesh& mesh = scene.meshes[static_cast<size_t>(scene.instances[static_cast<size_t>(instance)].mesh)];
    const double scale = workspaceFromScene.scale;
    const glm::dvec3 sides = scene.volume->bounds().extent();
    const FieldReach reach{.inside = fieldDepths().inside / scale,
                           .outside = std::min(fieldDepths().outside / scale,
                                               kFarthest * std::max({sides.x, sides.y, sides.z}))};
    const VolumeField field = fieldOfVolume(*scene.volume, scene.iso, reach, scene.path, progress);
    if (field.coarser > 1.0)
        warnings.push_back({"volume", "is felt with voxels " + std::to_string(field.coarser) +
                                          " times as large as its own: a field has at most " +
                                          std::to_string(static_cast<uint64_t>(field.mostNodes)) + " nodes"});
    const auto object = objectOf(mesh.name, std::make_shared<FieldShape>(field.grid), mesh.material,
                                 workspaceFromScene * field.sceneFromObject);
    object->instance = instance;
    const Similarity objectFromScene = field.sceneFromObject.inverse();
    object->objectFromMesh = glm::translate(glm::dmat4(1.0), objectFromScene.translation) *
                             glm::mat4_cast(objectFromScene.rotation) *
                             glm::scale(glm::dmat4(1.0), glm::dvec3(objectFromScene.scale));
    return object;
}

} // namespace touchstone
