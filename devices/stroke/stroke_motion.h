#pragma once
// How a hand moves along a laid curve in time.

#include "devices/stroke/laid_curve.h"
#include "devices/stroke/stroke_path.h"

#include <vector>

namespace touchstone {

/// Writes a closed motion piece by piece: where along the curve, and how far out of the pressed place.
/// Reaches begin and end as people's do, with minimum jerk (Flash and Hogan 1985: 10 t³ - 15 t⁴ + 6 t⁵, whose
/// peak speed is 15/8 of its mean).
class StrokeMotion {
  public:
    /// s between control points; at 0.5 m/s they are 1 mm apart, and a tremor of 12 Hz loses 0.4 %.
    static constexpr double kInterval = 0.002;

    /// Begins `hover` m out of the pressed place at the curve's start.
    StrokeMotion(const LaidCurve& curve, double hover);

    void liftTo(double lift, double speed); ///< a reach out or in, `speed` m/s at its fastest
    void reachTo(double way, double speed); ///< a reach along the curve, `speed` at its fastest
    /// Along the curve at `speed` but for the first and last 0.1 s, in which it comes and goes.
    void runTo(double way, double speed);
    void rest(double seconds);
    /// Rests with a tremor of `amplitude` m at 8 to 12 Hz, in all directions; it swells and fades.
    void tremble(double seconds, double amplitude);

    /// What was written, for ever. It should have come back to where it began.
    /// `place`: on the surface.
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
