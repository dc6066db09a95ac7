#pragma once

#include "devices/mouse/mouse_device.h"
#include "devices/mouse/mouse_hand.h"
#include "engine/math/similarity.h"
#include "renderer/camera.h"
#include "workbench/screen/view_options.h"

#include <functional>
#include <optional>

namespace touchstone {

/// Pointer and keys over the picture (docs/window.md): they move the camera and, where the mouse is the hand,
/// the hand. Main thread.
class ViewControl {
  public:
    /// m of depth of the free hand per notch of the wheel; a tenth of it with Shift.
    static constexpr double kWheelDepth = 2e-3;
    /// Factor of the press per notch, and its minimum and maximum, N.
    static constexpr double kWheelPress = 1.25, kMinPress = 0.05, kMaxPress = 5.0;

    /// A new model: fits the camera and places the hand in front of it.
    void lookAt(const Bounds& bounds, double aspect);

    struct Situation {
        glm::dvec2 origin{0.0};  ///< the picture's upper left corner in window coordinates
        glm::dvec2 area{1.0};    ///< its size
        glm::dvec3 probe{0.0};   ///< workspace, m
        double seconds = 0.0;    ///< since the last call
        bool mouseIsHand = true; ///< otherwise left button and wheel belong to the camera, too
        bool looksBack = false;  ///< a recording is shown: left, right and Home move its cursor
        bool covered = false;    ///< by an item that has the keyboard
        bool sculpts = false;    ///< the left button is that of the tool, too, and F sizes it
        bool grasps = false;     ///< the left button holds the body that is touched, too
        /// The first hit of a line of sight; null: no model.
        std::function<std::optional<PointedSurface>(const Ray&)> look;
    };
    /// The pressed button was released over a panel or in another window: ends the press.
    void letGo();
    /// Every frame, within an ImGui frame. Applies the requests in `options`, keys and pointer.
    void update(const Situation& now, ViewOptions& options);

    [[nodiscard]] const OrbitCamera& camera() const { return camera_; }
    /// The view's axes (x right, y up, z towards the viewer) in the workspace.
    [[nodiscard]] glm::dquat workspaceFromView() const {
        return glm::quat_cast(glm::dmat3(camera_.right(), camera_.up(), -camera_.forward()));
    }
    /// Nullopt while the hand is lifted off the model.
    [[nodiscard]] std::optional<MouseGoal> handGoal() const;
    /// The model was rebuilt around the hand: lifts it off and puts it down on the visible side.
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
    glm::dvec3 over_{0.0}; ///< where the hand last hovered, or would without its press
    /// s; kForceRampOutTime is 0.05: the force has faded out before the hand is put down.
    static constexpr double kLifted = 0.08;

    bool pressing_ = false;
    bool armed_ = true;    ///< the button was released since the model was opened
    MouseGoal pressed_;    ///< without its position: the target and its press
    Similarity pointedAt_; ///< workspaceFromObject of pressed_.object, at the time of the pick
    bool putDown_ = false; ///< in this frame, after a lift
    double lifted_ = 0.0;  ///< s until the hand is put down
};

} // namespace touchstone
