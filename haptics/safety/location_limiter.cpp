#include "haptics/safety/location_limiter.h"

#include "engine/device_io/servo_silence.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// A hair shorter than `longest`, so that rounding cannot exceed it.
glm::dvec2 cutTo(const glm::dvec2& v, double longest) {
    constexpr double kHairShort = 1.0 - 1e-15;
    const double length = std::hypot(v.x, v.y);
    return length > longest ? v * (longest * kHairShort / length) : v;
}

bool usable(double value) {
    return std::isfinite(value) && value > 0.0;
}

} // namespace

PadCommand LocationLimiter::limit(const LocationInput& input, LocationLimiterState& state) noexcept {
    const auto& [wanted, touching, forceFelt, limits, dt] = input;
    if (!usable(limits.reach)) {
        state.last = glm::dvec2(0.0);
        return PadCommand{};
    }
    const bool known = touching && forceFelt && std::isfinite(wanted.x) && std::isfinite(wanted.y) &&
                       std::abs(wanted.x) < 1e6 && std::abs(wanted.y) < 1e6;
    const glm::dvec2 target = cutTo(known ? wanted : state.last, limits.reach);
    const double most = usable(limits.rate) && usable(dt) ? limits.rate * std::min(dt, kServoSilence) : 0.0;
    const glm::dvec2 step = target - state.last;
    state.last =
        cutTo(std::hypot(step.x, step.y) > most ? state.last + cutTo(step, most) : target, limits.reach);
    return PadCommand(state.last);
}

} // namespace touchstone
