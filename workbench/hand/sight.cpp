#include "workbench/hand/sight.h"

#include "haptics/contact/surface_pick.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

void Sight::show(std::shared_ptr<const HapticScene> scene, ScenePtr source) {
    moving_ = source != nullptr ? MovingObjects(std::move(source), *scene) : MovingObjects();
    scene_ = std::move(scene);
}

std::optional<PointedSurface> Sight::look(const Ray& ray, double time, const HapticSettings& settings) {
    if (scene_ == nullptr)
        return std::nullopt;
    const ObjectMotions motions = moving_.at(time);
    const auto hit = pickSurface(*scene_, motions, ray.origin, ray.direction);
    if (!hit)
        return std::nullopt;
    const double own = scene_->materials[static_cast<size_t>(hit->material)].stiffness;
    const double stiffness = settings.stiffness > 0.0 ? settings.stiffness
                             : std::isnan(own)        ? scene_->limits.recommendedStiffness
                                                      : own;
    PointedSurface surface{hit->point, hit->normal, std::min(stiffness, scene_->limits.maxStiffness)};
    if (!motions.empty()) {
        surface.object = hit->object;
        surface.workspaceFromObject = motions[static_cast<size_t>(hit->object)].workspaceFromObject;
    }
    return surface;
}

Similarity Sight::restFromNow(int object, double time) {
    const ObjectMotions motions = moving_.at(time);
    const auto index = static_cast<size_t>(object);
    if (object < 0 || index >= motions.size() || index >= scene_->restMotions.size())
        return {};
    return scene_->restMotions[index].workspaceFromObject * motions[index].workspaceFromObject.inverse();
}

} // namespace touchstone
