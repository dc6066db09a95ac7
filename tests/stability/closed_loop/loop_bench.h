#pragma once
// A device in a hand against the whole haptic step, offline.

#include "devices/plant/hand_impedance.h"
#include "devices/simulated/told_hand.h"
#include "study/rate/closed_loop.h"
#include "study/rate/rate_ablation.h"
#include "tests/support/touch_bench.h"

#include <functional>

namespace touchstone::test {

using study::noLimits;
using study::pressedWallSettles;
/// No hand, no friction, an exact sensor, motors that do not saturate.
[[nodiscard]] PlantParameters bareDevice(double mass, double viscous);
/// No shading, texture and friction: k x and nothing else.
[[nodiscard]] HapticSettings plainWall(double stiffness, double damping = 0.0);

class LoopBench {
  public:
    LoopBench(const Scene& scene, const HapticSettings& settings, const PlantParameters& plant, double rateHz,
              const DeviceLimits& limits = noLimits(), Fit fit = Fit::None);

    /// Leads the device from `outside` to `position` and holds it fast while the safety stage fades its force
    /// in.
    void hold(const glm::dvec3& outside, const glm::dvec3& position);
    /// Lets it go from where it is.
    void release(const glm::dvec3& position, const glm::dvec3& velocity);
    /// Sample, haptic step, force.
    const HapticOutput& tick();

    std::function<glm::dvec3(double)> intention = [](double) { return glm::dvec3(0.0); }; ///< of time in s
    /// Clutch and zoom; null: bench.mapping as it is.
    std::function<void(DeviceSample&)> map;
    glm::dvec3 weight{0.0}; ///< N, constant, on the device
    [[nodiscard]] const Plant& plant() const { return hand_.plant(); }
    [[nodiscard]] double time() const { return static_cast<double>(ticks_) / rate_; }
    TouchBench bench;

  private:
    double rate_;
    IntendedHand target_;
    HandImpedance hand_;
    uint64_t ticks_ = 0;
};

/// How a device meets a wall: from above, or let go inside it.
struct Start {
    double height, speed; ///< m above the wall, m/s downwards
};
inline constexpr Start kWallStarts[]{{0.002, 0.05}, {0.002, 0.3}, {-0.0013, 0.0}, {-0.00071, -0.1}};

/// What becomes of a device after such a start: pressed into the plane with 0.7 N by its hand, or by a weight
/// where the hand has no spring.
struct Aftermath {
    bool rests = false; ///< to the bit, for 50 ms; the run ends there
    double swing = 0.0; ///< m, of the true motion in the last quarter, where it does not rest
};
[[nodiscard]] Aftermath meetWall(const PlantParameters& plant, const HapticSettings& wall, double rateHz,
                                 const Start& start, double seconds);

/// The largest K in low..high for which `stable` is true, to 1e-4 of itself; `stable` holds at low and not at
/// high.
[[nodiscard]] double largestStable(double low, double high, const std::function<bool(double)>& stable);

} // namespace touchstone::test
