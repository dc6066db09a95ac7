#pragma once
// The oracle's eye: every triangle of an object in long double, without any acceleration.

#include "haptics/contact/haptic_object.h"

#include <glm/glm.hpp>

#include <span>
#include <vector>

namespace touchstone::test {

using LVec3 = glm::vec<3, long double>;

struct BruteContact {
    LVec3 normal{0.0L}; ///< unit, from the surface to the point
    long double distance = 0.0L;
    size_t triangle = 0;
};

/// Distance of `p` (object frame) from one triangle of the object.
[[nodiscard]] BruteContact bruteDistance(const HapticObject& object, size_t triangle, const LVec3& p);
/// The least over all triangles.
[[nodiscard]] BruteContact bruteNearest(const HapticObject& object, const LVec3& p);
/// All triangles within `reach` of `p`.
[[nodiscard]] std::vector<BruteContact> bruteWithin(const HapticObject& object, const LVec3& p,
                                                    long double reach);

} // namespace touchstone::test
