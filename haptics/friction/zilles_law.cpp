#include "haptics/friction/friction_law.h"

namespace touchstone {

FrictionAnswer zillesLaw(const FrictionInput& in) noexcept {
    const double length = glm::length(in.stretch);
    if (length <= in.staticFriction * in.depth)
        return {.state = FrictionState::Sticking, .stays = true, .stretch = in.stretch, .share = 1.0};
    return {.state = FrictionState::Sliding,
            .stays = false,
            .stretch = in.dynamicFriction * in.depth / length * in.stretch,
            .share = 1.0};
}

} // namespace touchstone
