#include "api/c/touched_scene.h"

#include "haptics/scene/built_for.h"
#include "haptics/world/world_state.h"

#include <algorithm>

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
    if (isBuiltFor(*haptic_, settings)) // without waiting for what another thread builds
        return;
    const std::lock_guard lock(building_);
    buildFor(*haptic_, settings);
}

SceneIdentity TouchedScene::identity() {
    const std::lock_guard lock(identifying_);
    if (identity_ == nullptr)
        identity_ = std::make_unique<const SceneIdentity>(identify(*haptic_, *source_, fit_));
    return *identity_;
}

std::shared_ptr<const StrokePath> TouchedScene::stroke(const StrokeRequest& request) {
    constexpr size_t kKept = 4; // as many as a session has hands
    const std::lock_guard lock(laying_);
    const auto laid =
        std::ranges::find_if(strokes_, [&](const LaidStroke& one) { return one.request == request; });
    if (laid != strokes_.end())
        return laid->path;
    auto path = std::make_shared<const StrokePath>(layStroke(*source_, haptic_->workspaceFromScene, request));
    if (strokes_.size() == kKept)
        strokes_.pop_front();
    strokes_.push_back({request, path});
    return path;
}

} // namespace touchstone::api
