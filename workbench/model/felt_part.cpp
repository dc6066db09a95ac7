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

void FeltPartBuild::start(const Model& whole, const ScenePart& part) {
    job_ = std::async(std::launch::async, [whole, part] { return feltPart(whole, part); });
}

std::optional<FeltPart> FeltPartBuild::take() {
    if (!job_.valid() || job_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return std::nullopt;
    return job_.get();
}

} // namespace touchstone
