#include "haptics/scene/built_for.h"

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"

namespace touchstone {

namespace {

struct Missing {
    bool neighbourhoods, rays, slopes;
};

Missing missing(const HapticScene& scene, const HapticSettings& settings) noexcept {
    return {.neighbourhoods =
                settings.contact == ContactMethod::Neighbourhood && scene.neighbourhoods() == nullptr,
            .rays = settings.contact == ContactMethod::Rays && !scene.hasRays(),
            .slopes = settings.textureGradient == TextureGradient::Precomputed && scene.slopes() == nullptr};
}

} // namespace

bool isBuiltFor(const HapticScene& scene, const HapticSettings& settings) noexcept {
    const Missing without = missing(scene, settings);
    return !without.neighbourhoods && !without.rays && !without.slopes;
}

void buildFor(const HapticScene& scene, const HapticSettings& settings) {
    const Missing without = missing(scene, settings);
    if (without.neighbourhoods)
        scene.buildNeighbourhoods();
    if (without.rays)
        scene.buildRays();
    if (without.slopes)
        scene.buildSlopes();
}

} // namespace touchstone
