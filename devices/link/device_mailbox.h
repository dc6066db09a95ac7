#pragma once
// What a device's own I/O thread and the servo tell each other.

#include "devices/link/steady_clock.h"
#include "engine/device_io/device_io.h"
#include "engine/exchange/triple_buffer.h"

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

/// s without an order after which the I/O thread takes the servo for dead and sends zero force. As long as
/// DeviceLimits::staleAge and for the same reason.
inline constexpr double kServoSilence = 0.02;

/// Wait-free both ways: the servo never waits for a bus.
class DeviceMailbox {
  public:
    // I/O thread.
    void publish(const DeviceReading& reading) noexcept { readings_.write(reading); }
    /// True if the servo has given an order since the last call.
    bool updateOrder() noexcept { return orders_.update(); }
    /// The order that holds at `nowNs`: none other than zero once the servo has been silent.
    [[nodiscard]] ForceOrder order(int64_t nowNs) const noexcept {
        const ForceOrder& newest = orders_.value();
        const bool alive =
            newest.givenNs != 0 && static_cast<double>(nowNs - newest.givenNs) < 1e9 * kServoSilence;
        return alive ? newest : ForceOrder{};
    }

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
