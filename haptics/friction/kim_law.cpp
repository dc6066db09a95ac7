#include "haptics/friction/friction_law.h"

#include <algorithm>

namespace touchstone {

FrictionAnswer kimLaw(const FrictionInput& in) noexcept {
    constexpr double kPublishedPeriod = 1e-3; // s: the servo of [002]
    constexpr double kMost = 0.999;
    const double term = std::clamp(in.dynamicFriction * (1.0 + in.growth), 0.0, kMost);
    const double tau = kPublishedPeriod * term / (1.0 - term);
    return {.state = FrictionState::Sliding,
            .stays = false,
            .stretch = tau / (tau + in.dt) * in.stretch,
            .share = 1.0};
}

} // namespace touchstone
