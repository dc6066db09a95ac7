#include "workbench/hand/picker.h"

#include "haptics/query/surface_pick.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// The maximum of a factor over its map; 1 where a surface has no coordinates for it.
double mostOf(const HapticFactor& factor) {
    return factor.map.empty() ? 1.0 : std::max({1.0, factor.min, factor.max});
}

double mostOf(const std::vector<float>& attribute, double stated) {
    return attribute.empty() ? stated : static_cast<double>(*std::ranges::max_element(attribute));
}

/// Ratio of static to dynamic coefficient; finite, also for zero friction.
double gripOf(double holds, double slides) {
    constexpr double kMax = 1e3;
    return std::clamp(holds / std::max(slides, holds / kMax), 1.0, kMax);
}

} // namespace

Picker::Hardest Picker::hardestOf(const HapticScene& scene, const DeviceLimits& limits) {
    Hardest hardest;
    for (const auto& object : scene.objects) {
        const HapticMaterialData& material = scene.materials[static_cast<size_t>(object->material)];
        const double stated =
            std::isnan(material.stiffness) ? limits.recommendedStiffness : material.stiffness;
        const double stiffer = mostOf(material.stiffnessMap), rougher = mostOf(material.friction);
        hardest.stiffness = std::max(hardest.stiffness, stiffer * mostOf(object->stiffness, stated));
        hardest.stiffnessFactor = std::max(hardest.stiffnessFactor, stiffer);
        hardest.friction =
            std::max(hardest.friction, rougher * mostOf(object->friction, material.staticFriction));
        hardest.frictionFactor = std::max(hardest.frictionFactor, rougher);
        // The attribute is the static coefficient; the dynamic one keeps its ratio to it.
        const double least = object->friction.empty()
                                 ? material.staticFriction
                                 : static_cast<double>(std::ranges::min(object->friction));
        const double ratio =
            material.staticFriction > 0.0 ? material.dynamicFriction / material.staticFriction : 1.0;
        hardest.sliding = std::min(hardest.sliding, least * ratio);
        if (material.staticFriction > 0.0)
            hardest.grip = std::max(hardest.grip, gripOf(material.staticFriction, material.dynamicFriction));
    }
    hardest.stiffness = std::min(hardest.stiffness, limits.maxStiffness);
    return hardest;
}

void Picker::show(std::shared_ptr<const HapticScene> scene, ScenePtr source) {
    world_ = WorldState(std::move(source), *scene, WorldBodies::Shown);
    scene_ = std::move(scene);
    hardest_ = hardestOf(*scene_, limits_);
}

std::optional<PointedSurface> Picker::look(const Ray& ray, double time, const HapticSettings& settings,
                                           const DeviceLimits& limits) {
    if (scene_ == nullptr)
        return std::nullopt;
    if (limits_ != limits)
        hardest_ = hardestOf(*scene_, limits_ = limits);
    const ObjectMotions motions = world_.advance(time);
    const auto hit = pickSurface(world_.touched(*scene_), motions, ray.origin, ray.direction);
    if (!hit)
        return std::nullopt;
    const double own = scene_->materials[static_cast<size_t>(hit->material)].stiffness;
    const double stiffness = settings.stiffness > 0.0 ? settings.stiffness
                             : std::isnan(own)        ? limits.recommendedStiffness
                                                      : own;
    PointedSurface surface{hit->point, hit->normal, std::min(stiffness, limits.maxStiffness)};
    hardestWith(settings, surface);
    if (!motions.empty()) {
        surface.object = hit->object;
        surface.workspaceFromObject = motions[static_cast<size_t>(hit->object)].workspaceFromObject;
    }
    return surface;
}

int Picker::instanceAt(const Ray& ray, double time) {
    if (scene_ == nullptr)
        return -1;
    const ObjectMotions motions = world_.advance(time);
    const auto hit = pickSurface(world_.touched(*scene_), motions, ray.origin, ray.direction);
    return hit ? scene_->objects[static_cast<size_t>(hit->object)]->instance : -1;
}

void Picker::hardestWith(const HapticSettings& settings, PointedSurface& surface) const {
    surface.stiffest =
        settings.stiffness > 0.0 ? hardest_.stiffnessFactor * settings.stiffness : hardest_.stiffness;
    const bool holdsGiven = settings.staticFriction >= 0.0, slidesGiven = settings.dynamicFriction >= 0.0;
    const double holds = holdsGiven ? settings.staticFriction : hardest_.friction;
    if (settings.friction == FrictionMode::Off || !(holds > 0.0)) {
        surface.friction = 0.0;
        return;
    }
    surface.friction = holdsGiven ? hardest_.frictionFactor * holds : holds;
    if (settings.friction != FrictionMode::Ho)
        return;
    surface.grip = holdsGiven || slidesGiven
                       ? gripOf(holds, slidesGiven ? settings.dynamicFriction : hardest_.sliding)
                       : hardest_.grip;
}

Similarity Picker::restFromNow(int object, double time) {
    const ObjectMotions motions = world_.advance(time);
    const auto index = static_cast<size_t>(object);
    if (object < 0 || index >= motions.size() || index >= scene_->restMotions.size())
        return {};
    return scene_->restMotions[index].workspaceFromObject * motions[index].workspaceFromObject.inverse();
}

} // namespace touchstone
