#pragma once

#include "devices/device/device.h"
#include "devices/plant/plant.h"

namespace touchstone {

/// Limits of such a device for the safety stage: a Phantom Premium 1.5's, with the plant's own force, mass,
/// friction, resolution and delay.
[[nodiscard]] DeviceLimits limitsOf(const PlantParameters& parameters);

/// A device in a compliant hand. The hand intends to be at `intention` (the simulated hand, a recorded path)
/// and holds a device with mass, friction, a quantised sensor and a zero-order-hold force. This closes the
/// loop from position to force to motion. Deterministic: samples depend on the times and commands alone.
class HandImpedance final : public Device {
  public:
    /// s. After a longer gap between samples the hand is placed at its intention; the gap is not simulated.
    static constexpr double kLongestGap = 10.0;

    /// `intention` outlives the hand. Throws Error where a parameter is outside its range.
    explicit HandImpedance(Device& intention, const PlantParameters& parameters = {});

    [[nodiscard]] std::string name() const override { return intention_.name() + " that yields"; }
    [[nodiscard]] DeviceLimits limits() const override { return limitsOf(plant_.parameters()); }
    void feel(const TouchFeedback& felt) noexcept override { intention_.feel(felt); }
    /// Advances the plant to `time` under the last command and reads its sensor. The first sample (and one
    /// whose time does not increase) places the hand at rest at its intention. Invalid while the intention
    /// is.
    [[nodiscard]] DeviceSample sample(double time) noexcept override;
    /// Held from now on; with a delay of one tick, from the next sample on.
    void apply(const DeviceCommand& command) noexcept override { push(command.force()); }
    /// The same for a force that bypasses the safety stage: for studies of the bare loop.
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
