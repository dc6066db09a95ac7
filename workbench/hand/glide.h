#pragma once
// Going over from one hand to another. Pure.

#include "engine/math/similarity.h"

#include <glm/glm.hpp>

#include <algorithm>

namespace touchstone {

inline constexpr double kHandGlideTime = 0.4;      ///< s that going over takes
inline constexpr double kHandCouplingTime = 0.050; ///< s, from no force to all of it once it is there

/// From one place to another without a jump of the velocity; `share` of kHandGlideTime.
[[nodiscard]] inline glm::dvec3 glide(const glm::dvec3& from, const glm::dvec3& to, double share) {
    const double t = std::clamp(share, 0.0, 1.0);
    return glm::mix(from, to, t * t * (3.0 - 2.0 * t));
}

/// Whether a place keeps its meaning: else between it and the one before lies no way, and no energy is to be
/// booked for one.
[[nodiscard]] inline bool sameFrame(const Similarity& a, const Similarity& b) {
    return a.scale == b.scale && a.translation == b.translation;
}

} // namespace touchstone
