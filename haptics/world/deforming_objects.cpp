#include "haptics/world/deforming_objects.h"

#include <utility>

namespace touchstone {

std::unique_ptr<DeformingObjects> DeformingObjects::of(const ScenePtr& source, const HapticScene& haptic,
                                                       std::shared_ptr<DeformingStates> goOn) {
    const std::vector<size_t> objects = deformingObjects(source.get(), haptic);
    if (objects.empty())
        return nullptr;
    const bool goesOn = goOn != nullptr && goOn->fit(source, haptic, objects);
    std::unique_ptr<DeformingObjects> made(new DeformingObjects(
        haptic, objects,
        goesOn ? std::move(goOn) : std::make_shared<DeformingStates>(source, haptic, objects)));
    if (!goesOn)
        made->step({}); // nobody else has them yet
    return made;
}

DeformingObjects::DeformingObjects(const HapticScene& haptic, const std::vector<size_t>& objects,
                                   std::shared_ptr<DeformingStates> states)
    : scene_(copyOf(haptic)), states_(std::move(states)) {
    for (const size_t k : objects) {
        auto own = std::make_shared<HapticObject>(*haptic.objects[k]);
        scene_->objects[k] = own;
        meshes_.push_back({.object = k, .own = std::move(own), .instant = {}});
    }
}

void DeformingObjects::step(std::span<ObjectMotion> motions) noexcept {
    for (size_t p = 0; p < meshes_.size(); ++p) {
        meshes_[p].step(*scene_, states_->before(p), states_->now(p), states_->travel(p), !states_->still(p));
        if (!motions.empty() && states_->jumped(p))
            motions[meshes_[p].object].jumped = true;
    }
}

void DeformingObjects::advance(double time, bool begins, bool hold,
                               std::span<ObjectMotion> motions) noexcept {
    states_->advance(time, begins, hold);
    step(motions);
}

} // namespace touchstone
