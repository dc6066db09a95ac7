#pragma once

#include <glm/glm.hpp>

namespace touchstone {

/// The view's axes in the device frame, unit and perpendicular: what "right", "up" and "away" mean to the
/// user.
struct ViewAxes {
    glm::dvec3 right{1.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    glm::dvec3 away{0.0, 0.0, -1.0};
};

/// Turns what a mouse does in a view into where the hand wants to be, in the device frame, m. The camera says
/// how far a drag reaches on the plane through the hand (so that the hand stays under the pointer). Main
/// thread.
class MouseHand {
  public:
    /// `reach`: m, the hand stays within this distance of `home` on each axis. A Phantom Premium 1.5 reaches
    /// 0.19 m; a model fitted to the workspace reaches 0.075 m.
    explicit MouseHand(const glm::dvec3& home, double reach = 0.2);

    /// `right` and `up`: m on the plane through the hand that faces the viewer.
    void drag(const ViewAxes& view, double right, double up);
    /// `away`: m in depth, positive away from the viewer.
    void push(const ViewAxes& view, double away);
    /// Back to where it began.
    void goHome();

    [[nodiscard]] const glm::dvec3& goal() const { return goal_; }

  private:
    void moveBy(const glm::dvec3& displacement);

    glm::dvec3 home_, goal_;
    double reach_;
};

} // namespace touchstone
