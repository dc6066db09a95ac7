#pragma once
// Switching from one hand to another. Pure.

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

#include <algorithm>

namespace touchstone {

inline constexpr double kHandGlideTime = 0.4;      ///< s, duration of a switch
inline constexpr double kHandCouplingTime = 0.050; ///< s, for the force to fade in after it

/// From one position to another with continuous velocity; `share`: fraction of kHandGlideTime.
[[nodiscard]] inline glm::dvec3 glide(const glm::dvec3& from, const glm::dvec3& to, double share) {
    const double t = std::clamp(share, 0.0, 1.0);
    return glm::mix(from, to, t * t * (3.0 - 2.0 * t));
}

/// Whether positions are comparable: otherwise there is no displacement between consecutive ones and no
/// energy to account for.
[[nodiscard]] inline bool sameFrame(const Similarity& a, const Similarity& b) {
    return a.scale == b.scale && a.translation == b.translation;
}

} // namespace touchstone
