#pragma once
// What a device's own I/O thread and the servo tell each other.

#include "devices/link/steady_clock.h"
#include "engine/device_io/device_io.h"
#include "engine/device_io/servo_silence.h"
#include "engine/exchange/triple_buffer.h"

#include <atomic>
#include <cstdint>
#include <limits>

namespace touchstone {

/// The newest that is known of the hand, in the device frame.
struct DeviceReading {
    glm::dvec3 position{0.0}; ///< m
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
    /// Of devices that are pushed instead of moved: -1..1 on each axis.
    glm::dvec3 push{0.0}, turn{0.0};
    uint32_t buttons = 0;
    int64_t takenNs = 0; ///< steadyNs when it was known to be so; never later than it arrived
    bool valid = false;  ///< false: not plugged in, or the device itself does not know
};

/// What the servo wants the device to do, in the device frame.
struct ForceOrder {
    glm::dvec3 force{0.0};  ///< N
    glm::dvec3 torque{0.0}; ///< N·m
    int64_t givenNs = 0;    ///< steadyNs; 0: never
};

/// Wait-free both ways: the servo never waits for a bus.
class DeviceMailbox {
  public:
    // I/O thread.
    void publish(const DeviceReading& reading) noexcept { readings_.write(reading); }
    /// True if what is to be sent may have changed since the last call: the servo has given an order, or the
    /// device was let go or taken up.
    bool updateOrder() noexcept {
        const int64_t until = voidNs_.load(std::memory_order_acquire);
        const bool changed = until != seenVoidNs_;
        seenVoidNs_ = until;
        return orders_.update() || changed;
    }
    /// The order that holds at `nowNs`: none other than zero once the servo has been silent, and while nobody
    /// holds the device.
    [[nodiscard]] ForceOrder order(int64_t nowNs) const noexcept {
        const ForceOrder& newest = orders_.value();
        const bool alive =
            newest.givenNs != 0 && static_cast<double>(nowNs - newest.givenNs) < 1e9 * kServoSilence;
        return alive && newest.givenNs > voidNs_.load(std::memory_order_acquire) ? newest : ForceOrder{};
    }

    // Owner thread.
    /// From now on the order is zero, whatever the servo gives or has given.
    void letGo() noexcept { voidNs_.store(std::numeric_limits<int64_t>::max(), std::memory_order_release); }
    /// What the servo gives from now on holds again.
    void takeUp() noexcept { voidNs_.store(steadyNs(), std::memory_order_release); }

    // Servo thread.
    void give(const DeviceCommand& command) noexcept {
        orders_.write({command.force(), command.torque(), steadyNs()});
    }
    /// The newest reading; valid until the next call.
    [[nodiscard]] const DeviceReading& reading() noexcept {
        readings_.update();
        return readings_.value();
    }

  private:
    TripleBuffer<DeviceReading> readings_;
    TripleBuffer<ForceOrder> orders_;
    std::atomic<int64_t> voidNs_{0}; ///< steadyNs: what was given until then holds no more
    int64_t seenVoidNs_ = 0;         ///< I/O thread
};

/// The sample that a reading is at `nowNs`. Servo thread.
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
