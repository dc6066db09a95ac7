#pragma once

#include "devices/device/device.h"
#include "devices/plant/plant.h"

namespace touchstone {

/// What such a device can do, for the safety stage: a Phantom Premium 1.5's limits with the plant's own
/// force, mass, friction, resolution and delay.
[[nodiscard]] DeviceLimits limitsOf(const PlantParameters& parameters);

/// A device in a hand that yields: the hand wants to be where `intention` is (the simulated hand, a recorded
/// path), and holds a device with mass, friction, a sensor with steps and a force that is held from tick to
/// tick. This closes the loop: position to force to motion. Deterministic: samples depend on the times and
/// commands alone.
class HandImpedance final : public Device {
  public:
    /// s. After a longer gap between samples the hand is placed anew: a suspended machine is not made up for.
    static constexpr double kLongestGap = 10.0;

    /// `intention` outlives the hand. Throws Error where a parameter is outside its range.
    explicit HandImpedance(Device& intention, const PlantParameters& parameters = {});

    [[nodiscard]] std::string name() const override { return intention_.name() + " that yields"; }
    [[nodiscard]] DeviceLimits limits() const override { return limitsOf(plant_.parameters()); }
    /// The plant moves on to `time` under the last command, and its sensor is read. The first sample (and one
    /// at a time that does not come after the last) places the hand at rest where it wants to be. Invalid
    /// while the intention is.
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    /// Held from now on; with a delay of one tick from the next sample on.
    void apply(const DeviceCommand& command) noexcept override { push(command.force()); }
    /// The same for a force that no safety stage has seen: for studies of the bare loop.
    void push(const glm::dvec3& force) noexcept;

    [[nodiscard]] const Plant& plant() const { return plant_; }
    [[nodiscard]] Plant& plant() { return plant_; }

  private:
    Device& intention_;
    Plant plant_;
    bool placed_ = false;
    double time_ = 0.0;
    glm::dvec3 intended_{0.0};
    glm::dvec3 held_{0.0}, pending_{0.0}; ///< N; pending: until the next sample
};

} // namespace touchstone
