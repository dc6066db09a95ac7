#include "haptics/scene/shape_object.h"

#include "engine/core/error.h"

#include <cmath>
#include <utility>

namespace touchstone {

int addShape(HapticScene& scene, std::string name, std::shared_ptr<const Shape> shape, int material,
             const Similarity& workspaceFromObject) {
    const auto refuse = [&](const char* what, const char* remedy) { throw Error(name, "", what, remedy); };
    if (shape == nullptr || !(shape->boundingRadius() > 0.0) || !std::isfinite(shape->boundingRadius()))
        refuse("the shape has no finite size", "bound it");
    if (material < 0 || static_cast<size_t>(material) >= scene.materials.size())
        refuse("the shape names a material that the scene does not have", "add the material first");
    if (scene.neighbourhoods() != nullptr)
        refuse("the neighbourhoods of the scene are built", "add shapes before");
    auto object = std::make_shared<HapticObject>();
    object->name = std::move(name);
    object->material = material;
    object->workspaceFromObject = workspaceFromObject;
    object->boundingRadius = shape->boundingRadius();
    object->diagonal = 2.0 * object->boundingRadius;
    object->closed = true;
    object->anySmooth = shape->hasShadingNormals();
    object->shape = std::move(shape);
    scene.restMotions.push_back({workspaceFromObject, workspaceFromObject});
    scene.restSpheres.push_back(boundingSphere(*object, workspaceFromObject));
    scene.boundingRadii.push_back(object->boundingRadius);
    scene.objects.push_back(std::move(object));
    settlePlan(scene);
    return static_cast<int>(scene.objects.size()) - 1;
}

} // namespace touchstone
