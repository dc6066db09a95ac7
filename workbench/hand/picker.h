#pragma once

#include "devices/mouse/mouse_hand.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/scene/moving_objects.h"
#include "haptics/settings/haptic_settings.h"
#include "renderer/camera.h"

#include <cmath>
#include <memory>
#include <optional>

namespace touchstone {

/// What the pointer points at: the scene as the hand has it, where its objects are. Main thread.
class Picker {
  public:
    /// `source`: whose animation moves the objects.
    void show(std::shared_ptr<const HapticScene> scene, ScenePtr source);
    /// What a line of sight (workspace) meets first at `time` (s, the servo's), how stiff it will be, and how
    /// stiff and rough anything is.
    [[nodiscard]] std::optional<PointedSurface> look(const Ray& ray, double time,
                                                     const HapticSettings& settings);
    /// From where an object of the scene (HapticScene::objects) is at `time` to where it is in the rest pose,
    /// both in the workspace.
    [[nodiscard]] Similarity restFromNow(int object, double time);

  private:
    /// The most of what each touched material can be, whatever the session's settings.
    struct Hardest {
        double stiffness = 0.0, stiffnessFactor = 0.0; // N/m as stated, and what maps make of it
        double friction = 0.0, frictionFactor = 0.0;   // static, likewise
        double grip = 1.0;                             // static over dynamic
        double sliding = INFINITY;                     // the least dynamic
    };
    [[nodiscard]] static Hardest hardestOf(const HapticScene& scene);
    void hardestWith(const HapticSettings& settings, PointedSurface& surface) const;

    std::shared_ptr<const HapticScene> scene_;
    MovingObjects moving_;
    Hardest hardest_;
};

} // namespace touchstone
