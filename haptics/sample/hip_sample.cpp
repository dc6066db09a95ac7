#include "haptics/sample/hip_sample.h"

#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Farther than any workspace, m: such a value is a broken reading.
constexpr double kFarthestSample = 1e7;

bool usable(const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) &&
           std::abs(p.x) < kFarthestSample && std::abs(p.y) < kFarthestSample &&
           std::abs(p.z) < kFarthestSample;
}

} // namespace

bool takeSample(const DeviceSample& sample, double dt, DeviceState& state, uint32_t& flags) noexcept {
    const glm::dvec3 hip = sample.inWorkspace();
    if (!sample.valid || !usable(sample.position) || !usable(hip)) {
        flags = flags | TickFlag::InputInvalid;
        state.sampled = false; // the velocity restarts: a gap is not one tick long
        state.unsampled = std::min(kForceRampOutTime, state.unsampled + dt);
        return false;
    }
    state.travel = glm::dvec3(0.0);
    if (state.sampled) {
        state.travel = hip - state.hip;
        const glm::dvec3 velocity = state.travel / dt;
        if (glm::length(velocity) > kFastestHand * sample.mapping.workspaceFromDevice.scale)
            flags = flags | TickFlag::Teleported;
        constexpr double kTwoPi = 6.283185307179586;
        const double share = 1.0 - std::exp(-kTwoPi * kVelocityCutoff * dt);
        state.velocity += share * (velocity - state.velocity);
    } else {
        state.velocity = glm::dvec3(0.0);
    }
    state.sampled = true;
    state.unsampled = 0.0;
    state.hip = hip;
    return true;
}

} // namespace touchstone
