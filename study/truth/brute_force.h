#pragma once
// Distance queries of the oracle: point to triangle in long double; shares no code with haptics/.

#include "haptics/shape/mesh/haptic_object.h"

#include <glm/glm.hpp>

#include <vector>

namespace touchstone::truth {

using LVec3 = glm::vec<3, long double>;

/// Any frame.
struct Corners {
    LVec3 a{0.0L}, b{0.0L}, c{0.0L};
};

struct BruteContact {
    LVec3 normal{0.0L}; ///< unit, from the surface to the point
    long double distance = 0.0L;
    size_t triangle = 0;
};

/// Distance of `p` from one triangle of any aspect ratio.
[[nodiscard]] BruteContact distanceFrom(const Corners& corners, const LVec3& p);
/// The minimum over all triangles of the object, one by one but for those whose box is farther; object frame.
[[nodiscard]] BruteContact bruteNearest(const HapticObject& object, const LVec3& p);
/// All triangles within `reach` of `p`, likewise; object frame.
[[nodiscard]] std::vector<BruteContact> bruteWithin(const HapticObject& object, const LVec3& p,
                                                    long double reach);

} // namespace touchstone::truth
