#pragma once

#include "session/tick_subscriber.h"

#include <memory>
#include <optional>
#include <vector>

namespace touchstone {

/// Hands, a servo, the scene that they touch, and the subscribers to its ticks: what a program that touches
/// in real time consists of, with or without a window. Owner thread; the servo runs the ticks on its own.
class Session {
  public:
    /// One port per hand; the devices outlive the session. Throws as ServoLoop.
    explicit Session(std::vector<DevicePort> hands, const ServoConfig& config = {})
        : servo_(std::move(hands), config) {}

    /// From the next scene and the next tick on; it outlives the last `touch`, `identify` and `pump`.
    void subscribe(TickSubscriber& subscriber) { subscribers_.push_back(&subscriber); }

    void start() { servo_.start(); }
    /// The last command of every device is zero. The remaining ticks wait for `pump`.
    void stop() { servo_.stop(); }

    /// Touches a scene from the next tick on (ServoLoop::offerScene). Returns its number. Null: nothing can
    /// be touched, and the scene offered to the subscribers has the number 0.
    /// `sculpted`: where the present scene was sculpted, the new one has the same objects and takes their
    /// fields over, and `driven` is that of the present scene; else it is as ServoLoop::offerScene's.
    uint32_t touch(std::shared_ptr<const HapticScene> scene, ScenePtr source, SceneIdentity identity,
                   SceneSwap swap = SceneSwap::Anew, bool sculpted = false,
                   std::shared_ptr<DrivenObjects> driven = nullptr);
    /// Touches a scene with settings of its own: no tick has the one without the other.
    uint32_t touch(std::shared_ptr<const HapticScene> scene, ScenePtr source, SceneIdentity identity,
                   const HapticSettings& settings);
    /// The scene's file is another one now, or has been saved.
    void identify(SceneIdentity identity);
    /// The newest scene; its number is 0 before the first.
    [[nodiscard]] const OfferedScene& scene() const { return scene_; }
    /// The servo has adopted it.
    [[nodiscard]] bool touching() const { return touches(tick()); }
    /// In that tick, of any hand.
    [[nodiscard]] bool touches(const TickRecord& tick) const {
        return scene_.number != 0 && tick.root == scene_.number;
    }

    /// For the next tick; no-op where they are those of the last call.
    void set(const HapticSettings& settings);
    /// Any thread.
    [[nodiscard]] ForceSwitch& forceSwitch() { return servo_.forceSwitch(); }

    /// Passes all ticks since the last call to the subscribers, and renews `tick`. `now`: s, any steady
    /// clock.
    void pump(double now);
    /// The newest tick of hand 0 at the last `pump`.
    [[nodiscard]] const TickRecord& tick() const { return servo_.snapshot(); }

    /// Sculpts what is touched; its thread starts with the first active tool.
    [[nodiscard]] LiveSculptor& sculptor() { return sculptor_; }
    [[nodiscard]] const LiveSculptor& sculptor() const { return sculptor_; }

    [[nodiscard]] ServoLoop& servo() { return servo_; }
    [[nodiscard]] const ServoLoop& servo() const { return servo_; }

  private:
    void tellSculpted();
    void begin(OfferedScene scene);

    ServoLoop servo_;
    LiveSculptor sculptor_{servo_};
    uint32_t told_ = 0; // number of the last sculpted scene that the subscribers know
    std::vector<TickSubscriber*> subscribers_;
    OfferedScene scene_;
    std::optional<HapticSettings> settings_; // last sent
};

} // namespace touchstone
