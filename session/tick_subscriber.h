#pragma once

#include "haptics/recording/scene_identity.h"
#include "haptics/servo/servo_loop.h"
#include "session/live_sculptor.h"

#include <cstdint>
#include <memory>

namespace touchstone {

/// A scene under the number by which ticks name it.
struct OfferedScene {
    uint32_t number = 0; ///< TickRecord::scene
    std::shared_ptr<const HapticScene> haptic;
    ScenePtr source; ///< whose animation moves the objects
    SceneIdentity identity;
};

/// Takes every tick of a session. Owner thread.
class TickSubscriber {
  public:
    virtual ~TickSubscriber() = default;

    /// Before the first tick of a scene, and again where its identity has changed (its file was saved).
    virtual void sceneOffered(const OfferedScene& scene) { (void)scene; }
    /// Before the first tick of a scene that was sculpted.
    virtual void sceneSculpted(const SculptedScene& scene) { (void)scene; }
    /// Every tick in order, one record per hand, that of hand 0 last; with the settings that it had.
    virtual void take(const TickRecord& record, const HapticSettings& settings) = 0;
    /// After each batch. `now`: s, any steady clock.
    virtual void flush(double now) { (void)now; }
};

} // namespace touchstone
