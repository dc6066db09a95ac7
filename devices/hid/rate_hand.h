#pragma once
// A cap that is pushed, not moved: how far it is pushed says how fast the hand goes.

#include "devices/link/device_mailbox.h"

namespace touchstone {

struct RateSettings {
    double fullSpeed = 0.25; ///< m/s at full deflection: across the workspace in about a second
    double fullTurn = 1.5;   ///< rad/s at full deflection
    double deadZone = 0.02;  ///< share of the deflection that a cap at rest may show
    /// rad/s. The speed follows the cap through a low-pass, which hides the steps of reports that come every
    /// 8 to 16 ms. Lower is smoother and overshoots more after letting go: speed / smoothing.
    double smoothing = 40.0;
    double reach = 0.2;              ///< m; the hand stays within this of the middle on each axis
    glm::dvec3 start{0.0, 0.0, 0.1}; ///< m; a fitted model reaches 0.075 m, so this is before it
};

/// Turns deflection into a place. Pure but for its memory; no clock.
class RateHand {
  public:
    explicit RateHand(const RateSettings& settings = {}) : settings_(settings), position_(settings.start) {}

    /// Moves on by `dt` s (kLongestStep at most). A deflection that is too old to be believed is one of zero:
    /// the hand stops, it does not drift. Servo thread.
    void follow(const DeviceReading& reading, bool fresh, double dt) noexcept;

    [[nodiscard]] const glm::dvec3& position() const { return position_; }
    [[nodiscard]] const glm::dquat& orientation() const { return orientation_; }

    /// s; what a stall may cost in distance is fullSpeed times this.
    static constexpr double kLongestStep = 0.010;

  private:
    RateSettings settings_;
    glm::dvec3 position_, velocity_{0.0}, spin_{0.0};
    glm::dquat orientation_{1.0, 0.0, 0.0, 0.0};
};

} // namespace touchstone
