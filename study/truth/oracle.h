#pragma once
// The oracle: the virtual proxy over all triangles of a scene in long double, without cache, warm start or
// budget. Slow by design; shares no code with haptics/.

#include "study/truth/soup.h"

#include <vector>

namespace touchstone::truth {

struct OracleRest {
    LVec3 proxy{0.0L};
    std::vector<LVec3> touching; ///< unit normals of the surfaces in contact
    int moves = 0;
    bool settled = false; ///< false: it ran out of moves
};

/// Around a rounded edge of radius r, with the goal at distance e from its axis, one radian takes r / e
/// moves.
inline constexpr int kOracleMoves = 200000;

/// Moves a sphere of `radius` from `from` (free) through free space towards `goal` until it rests; the soup's
/// frame.
[[nodiscard]] OracleRest oracleRest(const Soup& soup, const LVec3& from, const LVec3& goal,
                                    long double radius, int maxMoves = kOracleMoves);

/// Residual of the displacement goal - proxy at `proxy`, given the surfaces in contact: its distance to the
/// cone that the inward normals span. Zero at a valid solve result. Object units.
[[nodiscard]] long double restResidual(const std::vector<LVec3>& touching, const LVec3& proxy,
                                       const LVec3& goal);

} // namespace touchstone::truth
