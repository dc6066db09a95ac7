#pragma once
// A hand that taps and strokes a model anywhere: repeatable, knows nothing of the solver.

#include "study/truth/soup.h"

#include <random>
#include <vector>

namespace touchstone::test {

using namespace truth;

struct HandOptions {
    double speed = 0.1;  ///< fitted m/s, 1 kHz
    double depth = 1e-3; ///< fitted m under the surface, at most
    /// Fitted m above it, where it starts and ends. No multiple of a step: the HIP should not stop on the
    /// surface.
    double height = 2.3e-3;
    double length = 8e-3; ///< fitted m of each stroke; 0: taps
};

class SurfaceHand {
  public:
    /// `unit`: fitted m per unit of the soup's frame.
    SurfaceHand(const Soup& soup, double unit, const HandOptions& options, unsigned seed);

    /// HIPs of one stroke with a tap at both ends, soup's frame: it comes down on a random triangle, runs
    /// over the surface in a random direction at a wavering depth and lifts off. Never faster than the speed.
    [[nodiscard]] std::vector<LVec3> stroke();

  private:
    const Soup& soup_;
    long double unit_;
    HandOptions options_;
    std::mt19937 random_;
    std::vector<double> area_; ///< running sum over the triangles
};

} // namespace touchstone::test
