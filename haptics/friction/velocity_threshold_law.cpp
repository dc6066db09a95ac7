#include "haptics/friction/friction_law.h"

#include <algorithm>

namespace touchstone {

FrictionAnswer velocityThresholdLaw(const FrictionInput& in) noexcept {
    const double speed = glm::length(in.slip);
    if (in.state == FrictionState::Sliding && speed < in.threshold)
        return {.state = FrictionState::Sticking, .stays = false, .stretch = glm::dvec3(0.0), .share = 1.0};
    if (in.state == FrictionState::Sticking && glm::length(in.stretch) <= in.staticFriction * in.depth)
        return {.state = FrictionState::Sticking, .stays = true, .stretch = in.stretch, .share = 1.0};
    const double bounded = std::min(in.viscosity * speed, in.dynamicFriction * in.depth);
    return {.state = FrictionState::Sliding,
            .stays = false,
            .stretch = speed > 0.0 ? -bounded / speed * in.slip : glm::dvec3(0.0),
            .share = 1.0};
}

} // namespace touchstone
