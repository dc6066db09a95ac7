#pragma once
// The oracle: the virtual proxy over all triangles in long double, without search tree, cache, warm start or
// budget. Slow on purpose; shares no code with haptics/.

#include "haptics/contact/haptic_object.h"
#include "tests/support/brute_force.h"

#include <vector>

namespace touchstone::test {

struct OracleRest {
    LVec3 proxy{0.0L};
    std::vector<LVec3> touching; ///< unit normals of the surfaces at the rest
    int moves = 0;
    bool settled = false; ///< false: it ran out of moves (kOracleMoves)
};

inline constexpr int kOracleMoves = 20000;

/// Moves a sphere of `radius` from `from` (free) towards `goal` along free space until it rests; object
/// frame.
[[nodiscard]] OracleRest oracleRest(const HapticObject& object, const LVec3& from, const LVec3& goal,
                                    long double radius);

/// What is left of the wish to move at `proxy`, given the surfaces that touch there: the distance from
/// goal - proxy to the cone that the inward normals span. Zero at a valid rest. Object units.
[[nodiscard]] long double restResidual(const std::vector<LVec3>& touching, const LVec3& proxy,
                                       const LVec3& goal);

} // namespace touchstone::test
