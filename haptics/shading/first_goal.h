#pragma once
// The start of stage 3, chosen so that stage 4 needs no rounds in most ticks.

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Reference frame, object units.
struct FirstGoal {
    glm::dvec3 goal{0.0};
    bool onFacet = false;   ///< no round is needed if the proxy reaches `place` on the same facet
    glm::dvec3 place{0.0};  ///< of the proxy
    glm::dvec3 normal{0.0}; ///< unit, from the HIP to the goal
};

/// The goal on which two-pass shading would converge for this HIP if the proxy stayed on the facet that held
/// it in the last tick; where several planes or an edge held it, the goal of the last shaded normal,
/// extrapolated by its last turn. The HIP itself when nothing was shaded. `travel`: distance that the HIP
/// moved in this tick, object units.
[[nodiscard]] FirstGoal firstGoal(const HapticScene& scene, const HapticSettings& settings,
                                  const DeviceState& state, const glm::dvec3& hip, double travel) noexcept;

} // namespace touchstone
