#pragma once
// Motion of a rigid part of a scene while its animation plays.

#include "engine/math/similarity.h"

#include <vector>

namespace touchstone {

/// Transform from the static pose to the current pose, device frame, periodic in the animation. Immutable;
/// `at` may be called from any thread and does not allocate.
class PartMotion {
  public:
    /// `samples`: at equal times from 0 to `duration` s, both included; at least one.
    PartMotion(std::vector<Similarity> samples, double duration)
        : samples_(std::move(samples)), duration_(duration) {}

    /// `time`: of the animation, as TickInput's. Linear between the samples.
    [[nodiscard]] Similarity at(double time) const noexcept;
    [[nodiscard]] double duration() const { return duration_; } ///< s

  private:
    std::vector<Similarity> samples_;
    double duration_; ///< s
};

} // namespace touchstone
