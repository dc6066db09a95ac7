#include "devices/mouse_hand.h"

#include <cmath>

namespace touchstone {

MouseHand::MouseHand(const glm::dvec3& home, double reach) : home_(home), goal_(home), reach_(reach) {}

void MouseHand::drag(const ViewAxes& view, double right, double up) {
    moveBy(right * view.right + up * view.up);
}

void MouseHand::push(const ViewAxes& view, double away) {
    moveBy(away * view.away);
}

void MouseHand::goHome() {
    goal_ = home_;
}

void MouseHand::moveBy(const glm::dvec3& displacement) {
    // A view that looks along no direction (a camera inside its own target) moves nothing.
    const double length = glm::length(displacement);
    if (!std::isfinite(length))
        return;
    goal_ = glm::clamp(goal_ + displacement, home_ - reach_, home_ + reach_);
}

} // namespace touchstone
