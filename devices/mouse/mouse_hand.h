#pragma once

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>

namespace touchstone {

/// The view's axes in the device frame, unit and perpendicular: the user's "right", "up" and "away".
struct ViewAxes {
    glm::dvec3 right{1.0, 0.0, 0.0};
    glm::dvec3 up{0.0, 1.0, 0.0};
    glm::dvec3 away{0.0, 0.0, -1.0};
};

/// The surface under the pointer.
struct PointedSurface {
    glm::dvec3 point{0.0};    ///< m, device frame
    glm::dvec3 normal{0.0};   ///< unit, towards the viewer
    double stiffness = 600.0; ///< N/m of the surface
    /// Maxima over the scene, as in MouseGoal.
    double stiffest = 600.0, friction = 4.0 / 3.0, grip = 1.0;
    double room = INFINITY;           ///< m of free space in front of it for a hovering hand
    int object = -1;                  ///< HapticScene::objects; -1: static
    Similarity workspaceFromObject{}; ///< at the time of the pick
};

/// Press force of a hand on the surface, and the stiffness of the hand.
struct MousePress {
    double force = 0.6;           ///< N along the normal; 0: hovers
    double handStiffness = 150.0; ///< N/m, MouseSmoothing::stiffness
};

/// Turns mouse input in a view into the target of the hand, device frame, m. The camera scales a drag to the
/// plane through the hand, so that the hand stays under the pointer. Main thread.
class MouseHand {
  public:
    /// `reach`: m, bound of the hand's distance from `home` on each axis. A Phantom Premium 1.5 reaches 0.19
    /// m; a model fitted to the workspace reaches 0.075 m.
    explicit MouseHand(const glm::dvec3& home, double reach = 0.2);

    /// `right` and `up`: m on the plane through the hand that faces the viewer.
    void drag(const ViewAxes& view, double right, double up);
    /// `away`: m in depth, positive away from the viewer.
    void push(const ViewAxes& view, double away);
    /// m in front of the surface at which a hovering hand stays, if there is room.
    static constexpr double kHover = 3e-3;
    [[nodiscard]] static glm::dvec3 hoverOver(const PointedSurface& surface) {
        return surface.point + std::min(kHover, 0.5 * surface.room) * surface.normal;
    }
    /// Onto the surface under the pointer: to the depth at which hand and surface, both compliant, balance at
    /// `press.force`; without force in front of it (hoverOver).
    void pointAt(const PointedSurface& surface, const MousePress& press);
    /// The pointer misses the model, on the line from `eye` along the unit vector `direction`: the target is
    /// on that line, as far from the viewer as the hand is.
    void pointPast(const ViewAxes& view, const glm::dvec3& eye, const glm::dvec3& direction);
    /// Back to `home`.
    void goHome();

    [[nodiscard]] const glm::dvec3& goal() const { return goal_; }

  private:
    void moveBy(const glm::dvec3& displacement);
    void moveTo(const glm::dvec3& place);

    glm::dvec3 home_, goal_;
    double reach_;
};

} // namespace touchstone
