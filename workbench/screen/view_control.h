#pragma once

#include "devices/mouse/mouse_device.h"
#include "devices/mouse/mouse_hand.h"
#include "engine/math/similarity.h"
#include "renderer/camera.h"
#include "workbench/screen/view_options.h"

#include <functional>
#include <optional>

namespace touchstone {

/// What pointer and keys do over the picture (docs/window.md): they move the camera and, where the mouse is
/// the hand, the hand. Main thread.
class ViewControl {
  public:
    /// m of depth of the free hand for one notch of the wheel; a tenth of it with Shift.
    static constexpr double kWheelDepth = 2e-3;
    /// By how much a notch makes the hand press harder, and the least and most that it presses with, N.
    static constexpr double kWheelPress = 1.25, kMinPress = 0.05, kMaxPress = 5.0;

    /// A new model: looks at all of it and rests the hand in front of it.
    void lookAt(const Bounds& bounds, double aspect);

    struct Situation {
        glm::dvec2 origin{0.0};  ///< the picture's upper left corner in window coordinates
        glm::dvec2 area{1.0};    ///< its size
        glm::dvec3 probe{0.0};   ///< workspace, m
        double seconds = 0.0;    ///< since the last call
        bool mouseIsHand = true; ///< else the left button and the wheel are the camera's, too
        bool looksBack = false;  ///< at a recording: left, right and Home are its cursor's
        bool covered = false;    ///< by something that has the keys
        /// What a line of sight meets first; null: there is no model.
        std::function<std::optional<PointedSurface>(const Ray&)> look;
    };
    /// The button that pressed came up over a panel or in another window: nobody presses any more.
    void letGo();
    /// Once a frame, within an ImGui frame. Does what `options` ask for and what keys and pointer do.
    void update(const Situation& now, ViewOptions& options);

    [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
    /// The view's axes (x right, y up, z towards the viewer) in the workspace.
    [[nodiscard]] glm::dquat workspaceFromView() const {
        return glm::quat_cast(glm::dmat3(camera_.right(), camera_.up(), -camera_.forward()));
    }
    /// None while the hand is lifted off the model.
    [[nodiscard]] std::optional<MouseGoal> handGoal() const;
    /// The model has been built again where the hand is: it is lifted off and put down in sight of it.
    void lift() { lifted_ = kLifted; }

  private:
    void go(CameraMove move, const Situation& now);
    void turnWithKeys(const Situation& now);
    void turnWithPointer(const Situation& now, ViewOptions& options);
    void moveFreeHand(const Situation& now);
    void pointHand(const Situation& now, const ViewOptions& options);
    [[nodiscard]] static PointedSurface withRoom(const Situation& now, const PointedSurface& surface);
    void liftWhereBlocked(const Situation& now, const glm::dvec3& to);

    OrbitCamera camera_;
    Bounds bounds_;
    MouseHand hand_{glm::dvec3(0.0, 0.0, 0.1)};
    glm::dvec3 over_{0.0}; ///< where the hand last hovered, or would have if it did not press
    /// s; kForceRampOutTime is 0.05: the force has faded when the hand is put down.
    static constexpr double kLifted = 0.08;

    bool pressing_ = false;
    bool armed_ = true;    ///< the button has been up since the model was opened
    MouseGoal pressed_;    ///< but for its position: what the hand points at, and how hard
    Similarity pointedAt_; ///< workspaceFromObject of pressed_.object, when it was pointed at
    bool putDown_ = false; ///< in this frame, having been lifted
    double lifted_ = 0.0;  ///< s for which the hand is still gone
};

} // namespace touchstone
