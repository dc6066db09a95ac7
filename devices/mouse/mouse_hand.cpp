#include "devices/mouse/mouse_hand.h"

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

void MouseHand::pointAt(const PointedSurface& surface, const MousePress& press) {
    if (!(press.force > 0.0))
        return moveTo(hoverOver(surface));
    // In series: force = hand stiffness * (goal to hand) = surface stiffness * (hand to surface).
    moveTo(surface.point -
           (press.force / press.handStiffness + press.force / surface.stiffness) * surface.normal);
}

void MouseHand::pointPast(const ViewAxes& view, const glm::dvec3& eye, const glm::dvec3& direction) {
    const double forward = glm::dot(direction, view.away);
    if (!(forward > 0.0))
        return;
    moveTo(eye + glm::dot(goal_ - eye, view.away) / forward * direction);
}

void MouseHand::moveTo(const glm::dvec3& place) {
    moveBy(place - goal_);
}

void MouseHand::moveBy(const glm::dvec3& displacement) {
    // A view without a direction (a camera inside its own target) moves nothing.
    const double length = glm::length(displacement);
    if (!std::isfinite(length))
        return;
    goal_ = glm::clamp(goal_ + displacement, home_ - reach_, home_ + reach_);
}

} // namespace touchstone
