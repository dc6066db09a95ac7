#pragma once
// What contacts and joints have in common in the solver. Private to its files.

#include "haptics/body/body_solver.h"

#include <cstddef>
#include <span>

namespace touchstone::body {

inline constexpr double kFree = 1e300; // an impulse or a force without a limit
/// m. A penetration that is left, so that bodies at rest keep their contacts.
inline constexpr double kSlop = 1e-5;

inline bool moves(const SolverState& s, int body) {
    return body >= 0 && s.active[static_cast<size_t>(body)] != 0;
}

inline Pose poseOf(std::span<const BodyState> states, int body) {
    return body >= 0 ? states[static_cast<size_t>(body)].pose : Pose{};
}

/// Moves two bodies by an impulse on positions.
template <class Row>
void nudge(const SolverState& s, const Row& row, double impulse) {
    if (moves(s, row.a))
        s.states[static_cast<size_t>(row.a)].pose.move((row.inverseA * impulse) * row.linear,
                                                       impulse * row.turnA);
    if (moves(s, row.b))
        s.states[static_cast<size_t>(row.b)].pose.move((-row.inverseB * impulse) * row.linear,
                                                       impulse * row.turnB);
}

} // namespace touchstone::body
