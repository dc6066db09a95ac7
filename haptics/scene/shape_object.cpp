#include "haptics/scene/shape_object.h"

#include "engine/core/error.h"
#include "engine/device_io/device_io.h"
#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/mesh_to_field.h"

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
    constexpr double kRoom = 1.5, kDeepest = 1.0; // object units: the longest side is 1
    const DeviceLimits limits;
    const double stiffness =
        use.stiffness > 0.0f ? static_cast<double>(use.stiffness) : limits.recommendedStiffness;
    const double objectPerModel = workspaceFromScene.scale / mesh.workspaceFromObject.scale;
    FieldRequest request;
    if (use.voxelSize > 0.0f)
        request.voxel = static_cast<double>(use.voxelSize) * objectPerModel;
    request.inside = std::min(kDeepest, kRoom * limits.maxForce / stiffness / mesh.workspaceFromObject.scale);
    if (const double finest = finestVoxel(mesh, request.outside); request.voxel < finest) {
        const FieldRequest usual;
        warnings.push_back({"materials[" + std::to_string(mesh.material) + "].voxelSize",
                            "needs too many cells for " + mesh.name + ": at least " +
                                std::to_string(finest / objectPerModel) + " m fits; felt with " +
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
