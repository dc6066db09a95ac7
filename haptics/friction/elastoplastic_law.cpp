#include "haptics/friction/friction_law.h"

#include <cmath>

namespace touchstone {

FrictionAnswer elastoplasticLaw(const FrictionInput& in) noexcept {
    constexpr double kPi = 3.141592653589793;
    const double length = glm::length(in.stretch);
    const double most = in.dynamicFriction * in.depth;
    const bool slid = in.state == FrictionState::Sliding;
    const double limit = slid ? most : in.staticFriction * in.depth;
    if (length > limit)
        return {.state = FrictionState::Sliding,
                .stays = false,
                .stretch = most / length * in.stretch,
                .share = 1.0};
    const bool elastic = length <= kElastic * limit;
    const double growth = length - in.lastLength;
    FrictionAnswer answer{.state = slid && !elastic ? FrictionState::Sliding : FrictionState::Sticking,
                          .stays = elastic || growth <= 0.0,
                          .stretch = in.stretch,
                          .share = 1.0};
    if (answer.stays)
        return answer;
    const double part = (length / limit - kElastic) / (1.0 - kElastic);
    const double alpha = (slid ? 0.5 : 0.25) * (1.0 - std::cos(kPi * part));
    answer.stretch *= (length - alpha * growth) / length;
    return answer;
}

} // namespace touchstone
