#pragma once
// A contact of the proxy, and the tolerances of contact. Lengths in object units (the object's longest side
// is 1).

#include "haptics/shape/shape.h"

#include <glm/glm.hpp>

#include <cmath>
#include <cstdint>

namespace touchstone {

/// Distance that a resting proxy keeps from the surface besides its radius: far above double rounding
/// (1e-16), far below anything felt (0.2 pm on a fitted model).
inline constexpr double kContactGap = 1e-12;
/// A feature nearer than the radius and this is in contact. Hardly more than the gap itself: a triangle that
/// is merely near has a tilted distance gradient (a coplanar neighbour seen from beside its edge by as much
/// as sqrt(2 reach / radius)), and its plane would hold back a free proxy.
inline constexpr double kContactReach = 2.0 * kContactGap;

/// Offset of the plane of a contact at this gap, from the proxy: it lets the proxy down to the resting gap,
/// or lifts it there after a hit. Around that gap it is zero: between planes a millionth of a degree apart,
/// an offset of a tenth of the gap would be a tenth of a micrometre of sideways motion, again in every move.
[[nodiscard]] inline double planeOffset(double gap) noexcept {
    constexpr double kContent = 0.3 * kContactGap;
    const double lack = kContactGap - gap;
    return std::abs(lack) > kContent ? lack : 0.0;
}

struct Contact {
    /// The value of `candidate` for a contact that is no triangle of the cache.
    static constexpr uint32_t kNoCandidate = UINT32_MAX;

    glm::dvec3 normal{0.0}; ///< unit, from the surface to the proxy's centre, reference object frame
    glm::dvec3 point{0.0};  ///< on the surface, reference object frame
    double gap = 0.0;       ///< distance minus radius, object units
    int object = -1;        ///< HapticScene::objects
    FeatureId feature = 0;  ///< of that object's shape; of a mesh the triangle
    uint32_t candidate = kNoCandidate; ///< index in the CandidateCache, until it gathers again
};

} // namespace touchstone
