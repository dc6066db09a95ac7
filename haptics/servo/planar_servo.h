#pragma once
// The haptic thread of a finger in the plane [004]: read - touch - limit - write, as ServoLoop's for scenes.

#include "engine/exchange/handover.h"
#include "engine/exchange/triple_buffer.h"
#include "haptics/finger/planar_touch.h"
#include "haptics/safety/location_limiter.h"
#include "haptics/servo/force_switch.h"
#include "haptics/servo/servo_loop.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <thread>

namespace touchstone {

/// What the finger touches: a curve and how it is rendered. The plane is z = 0 of the workspace.
struct PlanarScene {
    PlanarSurface surface;
    PlanarRendering rendering;
};

/// One tick of the finger. Workspace.
struct PlanarTick {
    uint64_t tick = 0;
    double dt = 0.0;        ///< s
    uint32_t scene = 0;     ///< number that PlanarServo::offer returned; 0: nothing can be touched
    bool sampled = false;   ///< the hand's position is known
    FingerPose pose;        ///< while sampled
    PlanarTouch::Felt felt; ///< before safety
    glm::dvec3 force{0.0};  ///< N, before safety: of the curve, and of the plane
    DeviceCommand command;  ///< after safety
    PadCommand location;    ///< after safety; the middle for a device without a display
    uint32_t flags = 0;     ///< TickFlag
    bool missed = false;    ///< the tick ended after the next deadline
};

/// The owner thread constructs, starts, stops and offers. The device's position is the middle of the pad's
/// skin; the turn of its x axis in the plane is the pitch. A spring holds the hand in the plane.
class PlanarServo {
  public:
    /// N/m and N: of the plane's spring. Stiff enough to be felt as a wall beside the curve, and weaker than
    /// a device's limits, so that it does not take the force of the curve.
    static constexpr double kPlaneStiffness = 300.0, kPlaneForce = 1.5;

    /// Throws Error where the rate or the port is none of ServoLoop's.
    explicit PlanarServo(DevicePort port, const ServoConfig& config = {});
    ~PlanarServo();
    PlanarServo(const PlanarServo&) = delete;
    PlanarServo& operator=(const PlanarServo&) = delete;

    void start();
    void stop(); ///< joins; the last command sent is zero

    /// From the next tick on; null: nothing. Where the curve comes to be around the finger, nothing is felt
    /// before the finger has left it. The force fades in.
    uint32_t offer(std::shared_ptr<const PlanarScene> scene);
    [[nodiscard]] ForceSwitch& forceSwitch() { return forceSwitch_; } ///< any thread

    /// Makes one tick of 1 / rate on the calling thread: the same code. Not while the thread runs.
    PlanarTick step();

    /// Owner thread: the newest tick.
    [[nodiscard]] const PlanarTick& tick() {
        scene_.collect();
        snapshot_.update();
        return snapshot_.value();
    }
    [[nodiscard]] uint64_t ticks() const { return ticks_.load(std::memory_order_relaxed); } ///< any thread
    [[nodiscard]] uint64_t missed() const { return missed_.load(std::memory_order_relaxed); }

  private:
    struct Offer {
        explicit Offer(std::shared_ptr<const PlanarScene> with, uint32_t offered)
            : scene(std::move(with)), touch(scene->surface, scene->rendering), number(offered) {}
        std::shared_ptr<const PlanarScene> scene;
        mutable PlanarTouch touch; // servo thread once adopted
        uint32_t number;
    };
    struct Held {
        std::unique_ptr<const Offer> offer; // null: nothing
    };

    void run() noexcept;
    void makeTick(double dt, bool late) noexcept;
    void feel(const Offer& offer, const DeviceSample& sample) noexcept;

    DevicePort port_;
    ServoConfig config_;
    ForceSwitch forceSwitch_;
    Handover<Held> scene_;
    TripleBuffer<PlanarTick> snapshot_;
    uint32_t offered_ = 0; // owner thread
    std::atomic<bool> stopping_{false};
    std::atomic<uint64_t> ticks_{0}, missed_{0};
    std::thread thread_;
    // Servo thread:
    PlanarTick now_;
    uint32_t adopted_ = 0;
    bool mustLeave_ = false;
    double unsampled_ = 0.0; // s since the last known position
    ForceLimiterState limiter_;
    LocationLimiterState location_;
    TouchFeedback felt_; // of the last tick
    glm::dvec3 plane_{0.0};
};

} // namespace touchstone
