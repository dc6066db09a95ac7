#include "haptics/scene/shape_object.h"

#include "engine/core/error.h"
#include "engine/device_io/device_io.h"
#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/mesh_to_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

namespace {

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
    scene.objects.push_back(std::move(object));
    settlePlan(scene);
    return static_cast<int>(scene.objects.size()) - 1;
}

std::shared_ptr<const HapticObject> fieldObject(const HapticObject& mesh,
                                                const Similarity& workspaceFromScene, const ObjectUse& use,
                                                const Progress& progress, std::vector<Warning>& warnings) {
    constexpr double kRoom = 1.5, kDeepest = 1.0, kFarthest = 0.25, kCoarsest = 0.25; // object units
    constexpr double kLargestBall =
        5e-3; // m: the panel's largest proxy radius, and what counts as near a model
    const DeviceLimits limits;
    const double objectPerModel = workspaceFromScene.scale / mesh.workspaceFromObject.scale;
    FieldRequest request;
    if (use.voxelSize > 0.0f)
        request.voxel = static_cast<double>(use.voxelSize) * objectPerModel;
    const double scale = mesh.workspaceFromObject.scale;
    request.inside = std::min(kDeepest, kRoom * limits.maxForce / limits.recommendedStiffness / scale);
    request.outside = std::clamp(kRoom * kLargestBall / scale, request.outside, kFarthest);
    const double finest = finestVoxel(mesh, request.outside);
    if (request.voxel < finest || request.voxel > kCoarsest) {
        const FieldRequest usual;
        const char* const why =
            request.voxel < finest ? "needs too many cells for " : "is larger than a quarter of ";
        warnings.push_back({"materials[" + std::to_string(mesh.material) + "].voxelSize",
                            why + mesh.name + ": " + std::to_string(finest / objectPerModel) + " to " +
                                std::to_string(kCoarsest / objectPerModel) + " m fit; felt with " +
                                std::to_string(usual.voxel / objectPerModel) + " m"});
        request.voxel = usual.voxel;
    }
    const auto object =
        objectOf(mesh.name, std::make_shared<FieldShape>(fieldOfMesh(mesh, request, progress)), mesh.material,
                 mesh.workspaceFromObject);
    object->instance = mesh.instance;
    object->objectFromMesh = mesh.objectFromMesh;
    return object;
}

} // namespace touchstone
