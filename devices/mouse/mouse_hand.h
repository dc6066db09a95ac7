#pragma once

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace touchstone {

/// The view's axes in the device frame, unit and perpendicular: what "right", "up" and "away" mean to the
/// user.
struct ViewAxes {
    glm::dvec3 right{1.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    glm::dvec3 away{0.0, 0.0, -1.0};
};

/// What lies under the pointer.
struct PointedSurface {
    glm::dvec3 point{0.0};    ///< m, device frame
    glm::dvec3 normal{0.0};   ///< unit, towards the viewer
    double stiffness = 600.0; ///< N/m with which it will push back
    /// Of all that is in the scene, as in MouseGoal.
    double stiffest = 600.0, friction = 4.0 / 3.0, grip = 1.0;
    double room = INFINITY;           ///< m in front of it in which a hand that does not press may stay
    int object = -1;                  ///< HapticScene::objects; -1: nothing of the scene moves
    Similarity workspaceFromObject{}; ///< when it was looked at
};

/// How hard a hand that is on the surface presses, and how softly it is held.
struct MousePress {
    double force = 0.6;           ///< N along the normal; 0: hovers
    double handStiffness = 150.0; ///< N/m, MouseSmoothing::stiffness
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
    /// m in front of the surface at which a hand that does not press stays, where there is room.
    static constexpr double kHover = 3e-3;
    [[nodiscard]] static glm::dvec3 hoverOver(const PointedSurface& surface) {
        return surface.point + std::min(kHover, 0.5 * surface.room) * surface.normal;
    }
    /// Onto the surface under the pointer: so deep below it that hand and surface, which both yield, hold
    /// each other at `press.force`; without force in front of it (hoverOver).
    void pointAt(const PointedSurface& surface, const MousePress& press);
    /// The pointer points past the model, along the line from `eye` along the unit vector `direction`: there,
    /// as far from the viewer as the hand is.
    void pointPast(const ViewAxes& view, const glm::dvec3& eye, const glm::dvec3& direction);
    /// Back to where it began.
    void goHome();

    [[nodiscard]] const glm::dvec3& goal() const { return goal_; }

  private:
    void moveBy(const glm::dvec3& displacement);
    void moveTo(const glm::dvec3& place);

    glm::dvec3 home_, goal_;
    double reach_;
};

} // namespace touchstone
