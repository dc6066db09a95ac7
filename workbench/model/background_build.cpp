#include "workbench/model/background_build.h"

#include <chrono>

namespace touchstone {

void BackgroundBuild::update(const std::shared_ptr<const HapticScene>& scene,
                             const HapticSettings& settings) {
    if (building_.valid()) {
        if (building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
            return;
        building_.get();
    }
    const bool walk = settings.contact == ContactMethod::Neighbourhood && scene->neighbourhoods() == nullptr,
               rays = settings.contact == ContactMethod::Rays && !scene->hasRays(),
               slopes =
                   settings.textureGradient == TextureGradient::Precomputed && scene->slopes() == nullptr;
    if (walk || rays || slopes)
        building_ = std::async(std::launch::async, [scene, walk, rays, slopes] {
            if (walk)
                scene->buildNeighbourhoods();
            if (rays)
                scene->buildRays();
            if (slopes)
                scene->buildSlopes();
        });
}

} // namespace touchstone
