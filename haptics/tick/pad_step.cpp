#include "haptics/tick/pad_step.h"

#include "haptics/finger/finger_pad.h"
#include "haptics/tick/haptic_step.h"

#include <cmath>

namespace touchstone {

PadCommand padStep(const DeviceSample& sample, const HapticOutput& output, bool forceEnabled, double dt,
                   const PadLimits& limits, LocationLimiterState& state) noexcept {
    const glm::dvec3 out = output.proxy - output.hip;
    const double length = glm::length(out);
    const bool touching = output.contacts > 0 && length > 0.0 && std::isfinite(length);
    const glm::dquat turn = sample.mapping.workspaceFromDevice.rotation * sample.orientation;
    return LocationLimiter::limit(
        {.wanted = touching ? FingerPad{}.locationOn(turn, out / length) : glm::dvec2(0.0),
         .touching = touching,
         .forceFelt = isForceFelt(forceEnabled, sample.valid, output.flags),
         .limits = limits,
         .dt = dt},
        state);
}

} // namespace touchstone
