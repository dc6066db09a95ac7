#pragma once

#include "devices/mouse_hand.h"
#include "engine/math/similarity.h"
#include "renderer/camera.h"
#include "workbench/window/view_options.h"

namespace touchstone {

/// What pointer and keys do over the picture (docs/window.md): they move the camera and, where the mouse is
/// the hand, the hand. Main thread.
class ViewControl {
  public:
    /// m of depth for one notch of the wheel; a tenth of it with Shift.
    static constexpr double kWheelDepth = 2e-3;

    /// A new model: looks at all of it and rests the hand in front of it.
    void lookAt(const Bounds& bounds, double aspect);

    struct Situation {
        glm::dvec2 area{1.0};    ///< the picture's size in window coordinates
        glm::dvec3 probe{0.0};   ///< workspace, m
        double seconds = 0.0;    ///< since the last call
        bool mouseIsHand = true; ///< else the left button and the wheel are the camera's, too
    };
    /// Once a frame, within an ImGui frame. Does what `options` ask for and what keys and pointer do.
    void update(const Situation& now, ViewOptions& options);

    [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
    /// The view's axes (x right, y up, z towards the viewer) in the workspace.
    [[nodiscard]] glm::dquat workspaceFromView() const {
        return glm::quat_cast(glm::dmat3(camera_.right(), camera_.up(), -camera_.forward()));
    }
    [[nodiscard]] const glm::dvec3& handGoal() const { return hand_.goal(); } ///< workspace, m

  private:
    void go(CameraMove move, const Situation& now);
    void turnWithKeys(const Situation& now);
    void turnWithPointer(const Situation& now);

    OrbitCamera camera_;
    Bounds bounds_;
    MouseHand hand_{glm::dvec3(0.0, 0.0, 0.1)};
};

} // namespace touchstone
