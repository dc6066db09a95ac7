#include "haptics/scene/shape_object.h"

namespace touchstone {

int addShape(HapticScene& scene, std::string name, std::shared_ptr<const Shape> shape, int material,
             const Similarity& workspaceFromObject) {
    auto object = std::make_shared<HapticObject>();
    object->name = std::move(name);
    object->material = material;
    object->workspaceFromObject = workspaceFromObject;
    object->boundingRadius = shape->boundingRadius();
    object->diagonal = 2.0 * object->boundingRadius;
    object->closed = object->anySmooth = true;
    object->shape = std::move(shape);
    scene.restMotions.push_back({workspaceFromObject, workspaceFromObject});
    scene.restSpheres.push_back(boundingSphere(*object, workspaceFromObject));
    scene.boundingRadii.push_back(object->boundingRadius);
    scene.objects.push_back(std::move(object));
    settlePlan(scene);
    return static_cast<int>(scene.objects.size()) - 1;
}

} // namespace touchstone
