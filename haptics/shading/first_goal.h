#pragma once
// Where stage 3 starts, so that the rounds of stage 4 have nothing left to do in most ticks.

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Reference frame, object units.
struct FirstGoal {
    glm::dvec3 goal{0.0};
    bool onFacet = false;   ///< the rounds end here if the proxy comes to `place` on the facet it was on
    glm::dvec3 place{0.0};  ///< of the proxy
    glm::dvec3 normal{0.0}; ///< unit, from the HIP to the goal
};

/// The goal that the rounds of two-pass shading would come to for this HIP if the proxy stayed on the facet
/// that held it in the last tick; where several planes or an edge held it, the goal that the last shaded
/// normal gives, turning on as it did. The HIP itself when nothing was shaded. `travel` is how far the HIP
/// moved in this tick, object units.
[[nodiscard]] FirstGoal firstGoal(const HapticScene& scene, const HapticSettings& settings,
                                  const DeviceState& state, const glm::dvec3& hip, double travel) noexcept;

} // namespace touchstone
