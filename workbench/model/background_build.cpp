#include "workbench/model/background_build.h"

#include "haptics/scene/built_for.h"

#include <chrono>

namespace touchstone {

void BackgroundBuild::update(const std::shared_ptr<const HapticScene>& scene,
                             const HapticSettings& settings) {
    if (building_.valid()) {
        if (building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
            return;
        building_.get();
    }
    if (!isBuiltFor(*scene, settings))
        building_ = std::async(std::launch::async, [scene, settings] { buildFor(*scene, settings); });
}

} // namespace touchstone
