#pragma once

#include "devices/mouse_hand.h"
#include "haptics/haptic_scene.h"
#include "haptics/haptic_settings.h"
#include "haptics/scene/moving_objects.h"
#include "renderer/camera.h"

#include <memory>
#include <optional>

namespace touchstone {

/// What the pointer points at: the scene as the hand has it, where its objects are. Main thread.
class Sight {
  public:
    /// `source`: whose animation moves the objects.
    void show(std::shared_ptr<const HapticScene> scene, ScenePtr source);
    /// What a line of sight (workspace) meets first at `time` (s, the servo's), and how stiff it will be.
    [[nodiscard]] std::optional<PointedSurface> look(const Ray& ray, double time,
                                                     const HapticSettings& settings);
    /// From where an object of the scene (HapticScene::objects) is at `time` to where it is in the rest pose,
    /// both in the workspace.
    [[nodiscard]] Similarity restFromNow(int object, double time);

  private:
    std::shared_ptr<const HapticScene> scene_;
    MovingObjects moving_;
};

} // namespace touchstone
