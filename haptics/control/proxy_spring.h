#pragma once
// The control loop apart from contact [000 §7]: a spring and damper towards the last proxy and planes that
// contact has sent, at a rate of its own. docs/control.md has the argument why late contact cannot make it
// unstable.

#include "engine/device_io/device_io.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/solve/sub_goal.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace touchstone {

/// What contact says of one moment. Workspace, m.
struct ContactGoal {
    bool touching = false;    ///< false: no force
    glm::dvec3 proxy{0.0};    ///< the spring pulls the hand here
    double stiffness = 600.0; ///< N/m, in metres of the device
    double damping = 0.0;     ///< N s/m: the D of the control loop, at its rate
    /// Unit normals, out of the surface, of planes through the proxy: the spring's end slides along them with
    /// the hand until the next goal. None: it stays at the proxy, which feels sticky where contact is slow.
    std::array<glm::dvec3, 3> planes{};
    uint32_t planeCount = 0;
};

/// Why a goal is refused; null: it is none. A goal may come from another program and say anything.
[[nodiscard]] const char* problemOf(const ContactGoal& goal) noexcept;

struct ProxySpringSettings {
    /// W that goals may add to the spring, besides what its damper has taken: moved objects and textures push
    /// the hand by it. 0: a goal never stretches the spring, so that no message, late, lost or wrong, gives
    /// energy. Infinite: each goal holds at once, as in [000].
    double power = 0.0;
    /// s without a goal after which contact counts as gone, and the spring fades out within kFadeTime. A
    /// longer one bears slower contact, but holds a hand longer to a place that nobody renders any more.
    double silence = 0.25;
    PassivityMode passivity = PassivityMode::Off; ///< of the safety stage
};

/// One hand's spring. The end of the spring in the device's frame is the state; between two goals the spring
/// is conservative (a fixed point, or fixed planes), and a new goal moves its end only as far towards the new
/// place as the energy that is allowed reaches. Pure: no clock, no allocation. One thread.
class ProxySpring {
  public:
    static constexpr double kFadeTime = 0.05; ///< s
    /// J of the damper's work that is kept as credit for goals.
    static constexpr double kMostCredit = 2e-3;

    explicit ProxySpring(const ProxySpringSettings& settings = {}) : settings_(settings) {}

    /// The newest goal. False, and the one before stays, where problemOf names something.
    bool hear(const ContactGoal& goal) noexcept;
    /// No goal holds any more; those that come may add `power` W.
    void forget(double power) noexcept;
    /// Control loop: the command of the tick, `dt` s after the last, from the safety stage. `late`: the tick
    /// before missed its deadline; kLateTicksToLatch of them in a row take the force away.
    [[nodiscard]] DeviceCommand step(const DeviceSample& sample, double dt, bool forceEnabled,
                                     bool late = false) noexcept;

    [[nodiscard]] const glm::dvec3& end() const { return end_; }     ///< of the spring, m, device frame
    [[nodiscard]] const glm::dvec3& force() const { return force_; } ///< N, device frame, before safety
    [[nodiscard]] double stiffness() const { return stiffness_; }    ///< N/m, of the last step
    [[nodiscard]] uint32_t flags() const { return flags_; }          ///< TickFlag bits of the last step
    /// J that goals have added to the spring beyond what its damper had taken; at most power times time.
    [[nodiscard]] double added() const { return added_; }
    [[nodiscard]] bool holds() const { return goal_.touching && silent_ < settings_.silence + kFadeTime; }

  private:
    void slide(const glm::dvec3& hand) noexcept;
    void takePlanes(const DeviceMapping& mapping) noexcept;
    [[nodiscard]] double left() const noexcept;
    void moveEnd(const glm::dvec3& hand, const DeviceSample& sample, double dt) noexcept;
    void measure(const glm::dvec3& hand, double dt) noexcept;

    ProxySpringSettings settings_;
    ContactGoal goal_;
    double silent_ = 0.0; ///< s since the last goal
    glm::dvec3 end_{0.0}, force_{0.0}, damping_{0.0};
    glm::dvec3 last_{0.0}, velocity_{0.0};
    bool placed_ = false; ///< last_ is of the last step
    /// Of the goal that holds, device frame: the spring's end slides along them.
    std::array<ConstraintPlane, 3> planes_{};
    size_t planeCount_ = 0;
    double stiffness_ = 0.0; ///< N/m, of the last step, faded
    double credit_ = 0.0, added_ = 0.0;
    ForceLimiterState limiter_;
    uint32_t flags_ = 0;
};

} // namespace touchstone
