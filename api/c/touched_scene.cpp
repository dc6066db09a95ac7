#include "api/c/touched_scene.h"

#include "haptics/scene/built_for.h"
#include "haptics/world/world_state.h"

namespace touchstone::api {

TouchedScene::TouchedScene(ScenePtr scene, Fit fit) : source_(std::move(scene)), fit_(fit) {
    haptic_ =
        compileHapticScene(*source_, workspaceFromScene(*source_, fit_), {.rays = false, .progress = {}});
    const auto add = [this](const Warning& warning) {
        warnings_.push_back((warning.place.empty() ? "" : warning.place + ": ") + warning.message);
    };
    for (const Warning& warning : source_->warnings)
        add(warning);
    for (const Warning& warning : haptic_->warnings)
        add(warning);
    for (const Warning& warning : animationWarnings(*source_))
        add(warning);
}

bool TouchedScene::moves() const {
    return WorldState(source_, *haptic_).moving();
}

Bounds TouchedScene::bounds() const {
    Bounds bounds;
    if (!source_->bounds.empty())
        for (const glm::dvec3& corner : {source_->bounds.low, source_->bounds.high})
            bounds.include(haptic_->workspaceFromScene.point(corner)); // fitting does not rotate
    return bounds;
}

void TouchedScene::prepareFor(const HapticSettings& settings) {
    const std::lock_guard lock(building_);
    buildFor(*haptic_, settings);
}

SceneIdentity TouchedScene::identity() {
    const std::lock_guard lock(building_);
    if (identity_ == nullptr)
        identity_ = std::make_unique<const SceneIdentity>(identify(*haptic_, *source_, fit_));
    return *identity_;
}

} // namespace touchstone::api
