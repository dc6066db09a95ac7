#pragma once
// Motion of a hand along a laid curve in time.

#include "devices/stroke/laid_curve.h"
#include "devices/stroke/stroke_path.h"

#include <vector>

namespace touchstone {

/// Builds a closed motion piece by piece: arc length along the curve, and lift out of the pressed position.
/// Reaches have a minimum-jerk profile, as people's do (Flash and Hogan 1985: 10 t³ - 15 t⁴ + 6 t⁵, whose
/// peak speed is 15/8 of its mean).
class StrokeMotion {
  public:
    /// s between control points; at 0.5 m/s they are 1 mm apart, and a tremor of 12 Hz loses 0.4 %.
    static constexpr double kInterval = 0.002;

    /// Starts `hover` m out of the pressed position at the curve's start.
    StrokeMotion(const LaidCurve& curve, double hover);

    void liftTo(double lift, double speed); ///< a reach out or in, `speed` m/s at its fastest
    void reachTo(double way, double speed); ///< a reach along the curve, `speed` at its fastest
    /// Along the curve at constant `speed`, except the first and last 0.1 s, in which it accelerates and
    /// decelerates.
    void runTo(double way, double speed);
    void rest(double seconds);
    /// Holds still with a tremor of `amplitude` m at 8 to 12 Hz, in all directions; it swells and fades.
    void tremble(double seconds, double amplitude);

    /// The motion so far as a periodic path; it should end where it started. `place`: on the surface.
    [[nodiscard]] StrokePath finish(const glm::dvec3& place) const;

  private:
    void add(double way, double lift) { control_.push_back(curve_.at(way, lift)); }
    template <class Place>
    void over(double seconds, const Place& place);

    const LaidCurve& curve_;
    double way_ = 0.0, lift_;
    std::vector<glm::dvec3> control_;
};

} // namespace touchstone
