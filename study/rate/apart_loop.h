#pragma once
// Contact apart from control [000 §7] in closed loop: a simulated device whose control loop follows the proxy
// and planes of a contact that comes more rarely, late, or not at all.

#include "devices/plant/hand_impedance.h"
#include "devices/simulated/told_hand.h"
#include "haptics/control/proxy_spring.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/tick/stepped_hand.h"

#include <functional>
#include <optional>
#include <random>

namespace touchstone::study {

struct ApartOptions {
    double controlHz = 4000.0;
    int controlTicks = 4; ///< of the control loop for one of contact, at least 1
    int late = 0;         ///< control ticks from a contact's sample to its goal
    double lost = 0.0;    ///< 0..1, of the goals, by a seeded generator
    bool planes = false;  ///< goals with their planes; else the proxy alone
    double stiffness = 600.0;
    double damping = 0.0;
    ProxySpringSettings spring{};
};

class ApartLoop {
  public:
    /// `scene` outlives it. `settings` are those of contact; its force is not used.
    ApartLoop(const HapticScene& scene, const HapticSettings& settings, const PlantParameters& plant,
              const ApartOptions& options, const DeviceLimits& limits);
    ApartLoop(const ApartLoop&) = delete;
    ApartLoop& operator=(const ApartLoop&) = delete;

    /// As ClosedLoop's.
    void hold(const glm::dvec3& outside, const glm::dvec3& position);
    void release(const glm::dvec3& position, const glm::dvec3& velocity);
    void tick();

    std::function<glm::dvec3(double)> intention = [](double) { return glm::dvec3(0.0); }; ///< of s; m
    glm::dvec3 weight{0.0};                                                               ///< N
    [[nodiscard]] const Plant& plant() const { return hand_.plant(); }
    [[nodiscard]] const ProxySpring& spring() const { return spring_; }
    [[nodiscard]] const HapticOutput& contact() const { return contact_.output; } ///< its last tick

  private:
    glm::dvec3 step(const glm::dvec3& position);

    SteppedHand contact_;
    HapticSettings settings_;
    ApartOptions options_;
    DeviceLimits limits_;
    ProxySpring spring_;
    IntendedHand target_{intention};
    HandImpedance hand_;
    std::mt19937 random_{1};
    std::optional<ContactGoal> underWay_;
    int arrives_ = 0; ///< control ticks until `underWay_` does
    uint64_t steps_ = 0, ticks_ = 0;
};

/// What contact at a rate of its own does to touch: docs/control.md.
struct ContactRateResult {
    double contactHz = 0.0;
    double together = 0.0; ///< N/m, stiffest stable wall where control runs at contact's rate
    double apart = 0.0;    ///< the same, control at 4 kHz towards the last proxy
    double planes = 0.0;   ///< towards the last planes
    double late = 0.0;     ///< towards a proxy that is one contact period late, each goal held at once
    double mended = 0.0;   ///< the same where goals give no energy
    /// N, mean drag on a hand that slides at 0.1 m/s over a plane of 600 N/m without friction, 1 mm deep.
    double drag = 0.0, dragPlanes = 0.0;
};

/// At a divisor of 4 kHz. Calling thread; some seconds.
[[nodiscard]] ContactRateResult studyContactRate(int controlTicks);

/// True if a device pressed 1 mm into a plane comes to rest along the plane and across it: no oscillation,
/// whose later part is as wide as its earlier one, is left of a push down and aside.
[[nodiscard]] bool apartSettles(const PlantParameters& device, const ApartOptions& options, double seconds);

} // namespace touchstone::study
