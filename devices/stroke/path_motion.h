#pragma once
// How a path moves with the surface that it is laid on.

#include "devices/surface/part_motion.h"

#include <glm/glm.hpp>

#include <vector>

namespace touchstone {

/// As a rigid part does, or each stretch of the path as the place does that it is laid on. Immutable; `at`
/// may be called from any thread and does not allocate.
class PathMotion {
  public:
    /// `parts`: one for the whole path, or at equal steps of its period, between which places are blended; at
    /// least one.
    explicit PathMotion(std::vector<PartMotion> parts) : parts_(std::move(parts)) {}

    /// Where `rest`, the path's place after `share` of its period (any), is at `time` of the animation.
    [[nodiscard]] glm::dvec3 at(double share, double time, const glm::dvec3& rest) const noexcept;

  private:
    std::vector<PartMotion> parts_;
};

} // namespace touchstone
