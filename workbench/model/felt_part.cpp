#include "workbench/model/felt_part.h"

#include "haptics/scene/scene_parts.h"
#include "workbench/model/model_loader.h"

#include <chrono>

namespace touchstone {

FeltPart feltPart(const Model& whole, const ScenePart& part) {
    FeltPart felt;
    felt.part = part;
    felt.whole = whole.haptic;
    felt.haptic = part.whole() ? whole.haptic : partOf(*whole.haptic, *whole.scene, part);
    felt.feltHash = feltHash(*felt.haptic, *whole.scene);
    felt.strokes = sceneOf(whole.scene, part);
    if (felt.strokes->touchable())
        felt.path = tourOver(*felt.strokes, whole.workspaceFromScene);
    return felt;
}

void FeltPartBuild::wholeIsFelt() {
    dropped_ = job_.valid();
    failed_.reset();
    toWhole_ = SceneSwap::SameGeometry;
}

bool FeltPartBuild::start(const Model& whole, const ScenePart& part) {
    Asked asked{whole.haptic, part};
    if (job_.valid() || failed_ == asked)
        return false;
    asked_ = std::move(asked);
    failed_.reset();
    toPart_ = std::exchange(toWhole_, SceneSwap::SameGeometry);
    job_ = std::async(std::launch::async, make_, whole, part);
    return true;
}

std::optional<FeltPart> FeltPartBuild::take() {
    if (!job_.valid() || job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    const bool dropped = std::exchange(dropped_, false);
    try {
        FeltPart made = job_.get();
        return dropped ? std::nullopt : std::optional(std::move(made));
    } catch (...) {
        if (dropped)
            return std::nullopt;
        failed_ = std::move(asked_);
        if (toPart_ == SceneSwap::Anew) // it was not taken up
            toWhole_ = SceneSwap::Anew;
        throw;
    }
}

} // namespace touchstone
