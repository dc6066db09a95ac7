#pragma once
// Data exchange between a device's I/O thread and the servo.

#include "devices/link/steady_clock.h"
#include "engine/device_io/device_io.h"
#include "engine/device_io/pad_command.h"
#include "engine/device_io/servo_silence.h"
#include "engine/exchange/triple_buffer.h"

#include <atomic>
#include <cstdint>
#include <limits>

namespace touchstone {

/// The latest state of the hand, device frame.
struct DeviceReading {
    glm::dvec3 position{0.0}; ///< m
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
    /// For rate-controlled devices: -1..1 on each axis.
    glm::dvec3 push{0.0}, turn{0.0};
    uint32_t buttons = 0;
    int64_t takenNs = 0; ///< steadyNs of the measurement; never later than the arrival
    bool valid = false;  ///< false: not plugged in, or the device has no valid position
};

/// The force commanded by the servo, device frame.
struct ForceOrder {
    glm::dvec3 force{0.0};  ///< N
    glm::dvec3 torque{0.0}; ///< N·m
    int64_t givenNs = 0;    ///< steadyNs; 0: never
    glm::dvec2 location{
        0.0}; ///< m, on the pad; it outlives the force: a display that is left stays where it is
};

/// Wait-free in both directions: the servo never waits for a bus.
class DeviceMailbox {
  public:
    // I/O thread.
    void publish(const DeviceReading& reading) noexcept { readings_.write(reading); }
    /// True if the order may have changed since the last call: the servo has given one, or letGo or takeUp
    /// was called.
    bool updateOrder() noexcept {
        const int64_t until = voidNs_.load(std::memory_order_acquire);
        const bool changed = until != seenVoidNs_;
        seenVoidNs_ = until;
        return orders_.update() || changed;
    }
    /// The order in force at `nowNs`: zero once the servo has been silent for kServoSilence, and while the
    /// device is not in use.
    [[nodiscard]] ForceOrder order(int64_t nowNs) const noexcept {
        const ForceOrder& newest = orders_.value();
        const bool alive =
            newest.givenNs != 0 && static_cast<double>(nowNs - newest.givenNs) < 1e9 * kServoSilence;
        return alive && newest.givenNs > voidNs_.load(std::memory_order_acquire)
                   ? newest
                   : ForceOrder{.location = newest.location};
    }

    // Owner thread.
    /// Orders are zero from now on, whatever the servo gives or has given.
    void letGo() noexcept { voidNs_.store(std::numeric_limits<int64_t>::max(), std::memory_order_release); }
    /// Orders given from now on are valid again.
    void takeUp() noexcept { voidNs_.store(steadyNs(), std::memory_order_release); }

    // Servo thread.
    void give(const DeviceCommand& command) noexcept {
        orders_.write({command.force(), command.torque(), steadyNs(), location_});
    }
    /// With the next order.
    void show(const PadCommand& command) noexcept { location_ = command.location(); }
    /// The latest reading; valid until the next call.
    [[nodiscard]] const DeviceReading& reading() noexcept {
        readings_.update();
        return readings_.value();
    }

  private:
    TripleBuffer<DeviceReading> readings_;
    TripleBuffer<ForceOrder> orders_;
    std::atomic<int64_t> voidNs_{0}; ///< steadyNs: orders given until then are void
    int64_t seenVoidNs_ = 0;         ///< I/O thread
    glm::dvec2 location_{0.0};       ///< servo thread
};

/// The sample of a reading at `nowNs`. Servo thread.
[[nodiscard]] inline DeviceSample sampleOf(const DeviceReading& reading, int64_t nowNs) noexcept {
    DeviceSample sample;
    sample.position = reading.position;
    sample.orientation = reading.orientation;
    sample.buttons = reading.buttons;
    sample.age = nowNs > reading.takenNs ? 1e-9 * static_cast<double>(nowNs - reading.takenNs) : 0.0;
    sample.valid = reading.valid;
    return sample;
}

} // namespace touchstone
