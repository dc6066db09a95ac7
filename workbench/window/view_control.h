#pragma once

#include "devices/mouse_hand.h"
#include "engine/math/similarity.h"
#include "renderer/camera.h"

namespace touchstone {

/// What the pointer does over the picture: left drag moves the hand in the view plane, the wheel in depth;
/// right drag orbits, middle drag shifts, Ctrl+wheel zooms, Home shows all. Main thread.
class ViewControl {
  public:
    /// m of depth for one notch of the wheel; a tenth of it with Shift.
    static constexpr double kWheelDepth = 2e-3;

    /// A new model: looks at all of it and rests the hand in front of it.
    void lookAt(const Bounds& bounds, double aspect);

    /// Once a frame, within an ImGui frame. `area`: the picture's size in window coordinates.
    void update(const glm::dvec2& area);

    [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
    /// The view's axes (x right, y up, z towards the viewer) in the workspace.
    [[nodiscard]] glm::dquat workspaceFromView() const {
        return glm::quat_cast(glm::dmat3(camera_.right(), camera_.up(), -camera_.forward()));
    }
    [[nodiscard]] const glm::dvec3& handGoal() const { return hand_.goal(); } ///< workspace, m

  private:
    OrbitCamera camera_;
    Bounds bounds_;
    MouseHand hand_{glm::dvec3(0.0, 0.0, 0.1)};
};

} // namespace touchstone
