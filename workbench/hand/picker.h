#pragma once

#include "devices/mouse/mouse_hand.h"
#include "engine/device_io/device_io.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/world/world_state.h"
#include "renderer/camera.h"

#include <cmath>
#include <memory>
#include <optional>

namespace touchstone {

/// Ray casts into the haptic scene at the current pose of its objects. Main thread.
class Picker {
  public:
    /// `source`: its animation moves the objects.
    void show(std::shared_ptr<const HapticScene> scene, ScenePtr source);
    /// The first hit of a line of sight (workspace) at `time` (s, of the animation: animationTime), its
    /// stiffness, and the maximum stiffness and friction of the scene. `limits` of the hand in use.
    [[nodiscard]] std::optional<PointedSurface>
    look(const Ray& ray, double time, const HapticSettings& settings, const DeviceLimits& limits);
    /// Scene::instances of the first hit at `time`; -1: none.
    [[nodiscard]] int instanceAt(const Ray& ray, double time);
    /// Where the scene's bodies are now.
    void showBodies(const body::BodyPoses& poses) { world_.showBodies(poses); }
    /// The world at the poses that were shown last.
    [[nodiscard]] WorldState& world() { return world_; }
    /// Transform of an object (HapticScene::objects) from its pose at `time` to its rest pose, both in the
    /// workspace.
    [[nodiscard]] Similarity restFromNow(int object, double time);

  private:
    /// Maxima over the touched materials, whatever the session's settings.
    struct Hardest {
        double stiffness = 0.0, stiffnessFactor = 0.0; // N/m as stated, and with the maximum of the maps
        double friction = 0.0, frictionFactor = 0.0;   // static, likewise
        double grip = 1.0;                             // static over dynamic coefficient
        double sliding = INFINITY;                     // the minimum dynamic coefficient
    };
    [[nodiscard]] static Hardest hardestOf(const HapticScene& scene, const DeviceLimits& limits);
    void hardestWith(const HapticSettings& settings, PointedSurface& surface) const;

    std::shared_ptr<const HapticScene> scene_;
    WorldState world_;
    DeviceLimits limits_; // of `hardest_`
    Hardest hardest_;
};

} // namespace touchstone
