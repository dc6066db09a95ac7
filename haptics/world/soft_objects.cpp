#include "haptics/world/soft_objects.h"

#include <utility>

namespace touchstone {

std::unique_ptr<SoftObjects> SoftObjects::of(const ScenePtr& source, const HapticScene& haptic,
                                             std::shared_ptr<SoftStates> goOn) {
    const std::vector<size_t> objects = softObjects(source.get(), haptic);
    if (objects.empty())
        return nullptr;
    const bool goesOn = goOn != nullptr && goOn->fit(*source, haptic, objects);
    std::unique_ptr<SoftObjects> made(new SoftObjects(
        haptic, goesOn ? std::move(goOn) : std::make_shared<SoftStates>(*source, haptic, objects)));
    if (!goesOn)
        made->step(true); // nobody else has them yet
    return made;
}

SoftObjects::SoftObjects(const HapticScene& haptic, std::shared_ptr<SoftStates> states)
    : scene_(copyOf(haptic)), states_(std::move(states)) {
    for (const SoftStates::Shown& shown : states_->shown()) {
        auto own = std::make_shared<HapticObject>(*haptic.objects[shown.object]);
        scene_->objects[shown.object] = own;
        meshes_.push_back({.object = shown.object, .own = std::move(own), .instant = {}});
    }
}

void SoftObjects::step(bool begins) noexcept {
    wasStill_ = still_;
    still_ = !begins;
    for (size_t b = 0; b < meshes_.size(); ++b) {
        const bool moves = states_->moves(b);
        MeshMoment now = states_->now(b);
        if (!meshes_[b].own->anySmooth)
            now.normals = {};
        meshes_[b].step(*scene_, states_->before(b), now, states_->travel(b), moves);
        still_ = still_ && !moves;
    }
}

void SoftObjects::advance(bool begins, bool hold, std::span<ObjectMotion> motions) noexcept {
    const bool first = states_->advance(begins, hold);
    for (const MovedMesh& mesh : meshes_)
        if (!motions.empty())
            motions[mesh.object].jumped = first;
    step(begins);
}

} // namespace touchstone
