#include "haptics/friction/friction_law.h"

#include <algorithm>

namespace touchstone {

FrictionAnswer hoLaw(const FrictionInput& in) noexcept {
    // mu_s N / ks and mu_d N / kd are equal: the chain has the same length in both states, only its stiffness
    // differs.
    const double soften = std::max(1.0, in.staticFriction);
    const double chain = soften * in.depth;
    const double length = glm::length(in.stretch);
    const double sticking = in.staticFriction / soften, sliding = in.dynamicFriction / soften;
    if (length > chain)
        return {.state = FrictionState::Sliding,
                .stays = false,
                .stretch = chain / length * in.stretch,
                .share = sliding};
    // A chain that has just been pulled taut may return shorter by rounding: that is no reversal.
    constexpr double kTaut = 1.0 - 1e-9;
    const bool slides = in.state == FrictionState::Sliding && length >= kTaut * chain && chain > 0.0;
    return {.state = slides ? FrictionState::Sliding : FrictionState::Sticking,
            .stays = true,
            .stretch = in.stretch,
            .share = slides ? sliding : sticking};
}

} // namespace touchstone
