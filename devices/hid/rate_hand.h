#pragma once
// Rate control for a cap that is pushed rather than moved: deflection sets the velocity of the hand.

#include "devices/link/device_mailbox.h"

namespace touchstone {

struct RateSettings {
    double fullSpeed = 0.25; ///< m/s at full deflection: across the workspace in about 1 s
    double fullTurn = 1.5;   ///< rad/s at full deflection
    double deadZone = 0.02;  ///< fraction of the deflection that a cap at rest may report
    /// rad/s. The velocity follows the cap through a low-pass, which hides the steps of reports that arrive
    /// every 8 to 16 ms. Lower is smoother and overshoots more after release: speed / smoothing.
    double smoothing = 40.0;
    double reach = 0.2;              ///< m; bound of the hand's offset from the centre on each axis
    glm::dvec3 start{0.0, 0.0, 0.1}; ///< m; in front of a fitted model, which reaches 0.075 m
};

/// Integrates deflection to a position. Stateful, but without a clock.
class RateHand {
  public:
    explicit RateHand(const RateSettings& settings = {}) : settings_(settings), position_(settings.start) {}

    /// Advances by `dt` s (at most kLongestStep). A stale deflection counts as zero: the hand stops and does
    /// not drift. Servo thread.
    void follow(const DeviceReading& reading, bool fresh, double dt) noexcept;

    [[nodiscard]] const glm::dvec3& position() const { return position_; }
    [[nodiscard]] const glm::dquat& orientation() const { return orientation_; }

    /// s; a stall moves the hand by at most fullSpeed times this.
    static constexpr double kLongestStep = 0.010;

  private:
    RateSettings settings_;
    glm::dvec3 position_, velocity_{0.0}, spin_{0.0};
    glm::dquat orientation_{1.0, 0.0, 0.0, 0.0};
};

} // namespace touchstone
