#pragma once
// How a rigid part of a scene moves while its animation plays, for a hand that rides on it.

#include "engine/math/similarity.h"

#include <vector>

namespace touchstone {

/// deviceNow from device in the static pose, over one round of the animation, again and again. Immutable;
/// `at` may be called from any thread, allocates nothing.
class PartMotion {
  public:
    /// `samples`: at equal times from 0 to `duration` s, both included; at least one.
    PartMotion(std::vector<Similarity> samples, double duration)
        : samples_(std::move(samples)), duration_(duration) {}

    /// `time`: of the animation, as TickInput's. Straight between the samples.
    [[nodiscard]] Similarity at(double time) const noexcept;
    [[nodiscard]] double duration() const { return duration_; } ///< s

  private:
    std::vector<Similarity> samples_;
    double duration_; ///< s
};

} // namespace touchstone
