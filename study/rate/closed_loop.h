#pragma once
// A simulated device in a hand with the whole haptic step: position to force to motion, offline.

#include "devices/plant/hand_impedance.h"
#include "devices/simulated/told_hand.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/tick/stepped_hand.h"

#include <functional>

namespace touchstone::study {

/// Limits beyond any force of a study: the subject is the loop and not its safety stage.
[[nodiscard]] DeviceLimits noLimits();

class ClosedLoop {
  public:
    /// `scene` outlives it. The safety stage uses `limits` as the device's.
    ClosedLoop(const HapticScene& scene, const HapticSettings& settings, const PlantParameters& plant,
               double rateHz, const DeviceLimits& limits);
    ClosedLoop(const ClosedLoop&) = delete;
    ClosedLoop& operator=(const ClosedLoop&) = delete;

    /// Moves the device from `outside` to `position` without force, and holds it there until the safety stage
    /// has faded the force in.
    void hold(const glm::dvec3& outside, const glm::dvec3& position);
    /// Releases it there.
    void release(const glm::dvec3& position, const glm::dvec3& velocity);
    /// Sample, haptic step, force. The first tick without `hold` places the hand at its intention.
    const HapticOutput& tick();

    std::function<glm::dvec3(double)> intention = [](double) {
        return glm::dvec3(0.0);
    };                      ///< of s; workspace m
    glm::dvec3 weight{0.0}; ///< N, constant, on the device
    int64_t stepNs = 0;     ///< of the last tick's step, clock reading included
    [[nodiscard]] const Plant& plant() const { return hand_.plant(); }

  private:
    const HapticOutput& step(const glm::dvec3& position);

    SteppedHand touch_;
    HapticSettings settings_;
    DeviceLimits limits_;
    double rate_;
    IntendedHand target_{intention};
    HandImpedance hand_;
    uint64_t ticks_ = 0;
};

} // namespace touchstone::study
