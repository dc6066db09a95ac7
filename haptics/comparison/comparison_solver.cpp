#include "haptics/comparison/comparison_solver.h"

#include "haptics/settings/tick_flags.h"

#include <algorithm>

namespace touchstone {

namespace {

using Solver = std::variant<NeighbourhoodWatch, RayProxy<double>, RayProxy<float>>;

Solver solverFor(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                 DeviceState& state, SolveResult& rest) noexcept {
    const int budget = settings.iterationBudget;
    if (settings.contact == ContactMethod::Neighbourhood)
        return NeighbourhoodWatch(scene, motions, budget, state, rest);
    if (settings.precision == Precision::Single)
        return RayProxy<float>(scene, motions, budget, state, rest);
    return RayProxy<double>(scene, motions, budget, state, rest);
}

/// The watch ignores jammed objects, and restarts where its reference object jumps.
void leaveCarry(ObjectMotions motions, DeviceState& state, uint32_t& flags) noexcept {
    if (state.jammed.count > 0) {
        state.jammed.count = 0;
        state.candidates.ignore({});
    }
    for (size_t k = 0; k < motions.size(); ++k) {
        if (!motions[k].jumped)
            continue;
        flags = flags | TickFlag::ObjectJumped;
        if (static_cast<int>(k) == state.reference) {
            state.watch.touching = state.placed = false;
            state.friction = FrictionState::Free;
        }
    }
}

} // namespace

bool comparisonIsReady(const HapticScene& scene, const HapticSettings& settings) noexcept {
    // They would let the hand into a shape, and the sweep would then push it out.
    const auto isShape = [](const auto& object) { return object->shape != nullptr; };
    if (settings.contact != ContactMethod::Sweep && std::ranges::any_of(scene.objects, isShape))
        return false;
    switch (settings.contact) {
    case ContactMethod::Rays:
        return scene.hasRays();
    case ContactMethod::Neighbourhood:
        return scene.neighbourhoods() != nullptr;
    case ContactMethod::Sweep:
        break;
    }
    return false;
}

/// The watch meets moving objects along the HIP's path relative to them.
void ComparisonSolver::followObjects(const HapticScene& scene, ObjectMotions motions,
                                     const HapticSettings& settings, DeviceState& state,
                                     uint32_t& flags) noexcept {
    leaveCarry(motions, state, flags);
    if (settings.contact != ContactMethod::Rays)
        return;
    leaveComparison(scene, motions, state);
    sweepMovingObstaclesByRays(scene, motions, state, flags);
}

ComparisonSolver::ComparisonSolver(const HapticScene& scene, ObjectMotions motions,
                                   const HapticSettings& settings, DeviceState& state,
                                   SolveResult& rest) noexcept
    : state_(state), solver_(solverFor(scene, motions, settings, state, rest)) {}

bool ComparisonSolver::begin() noexcept {
    return std::visit([](auto& solver) { return solver.begin(); }, solver_);
}

void ComparisonSolver::resumeFrom(const glm::dvec3& place) noexcept {
    startAt(place);
}

void ComparisonSolver::moveTowards(const glm::dvec3& goal) noexcept {
    std::visit([&](auto& solver) { solver.moveTowards(goal); }, solver_);
}

void ComparisonSolver::dropTowards(const glm::dvec3& goal) noexcept {
    std::visit([&](auto& solver) { solver.dropTowards(goal); }, solver_);
}

void ComparisonSolver::startAt(const glm::dvec3& place) noexcept {
    if (!std::holds_alternative<NeighbourhoodWatch>(solver_))
        placeAt(place);
}

void ComparisonSolver::placeAt(const glm::dvec3& place) noexcept {
    std::visit([&](auto& solver) { solver.placeAt(place); }, solver_);
}

bool ComparisonSolver::returnTo(const glm::dvec3&, const glm::dvec3& hip) noexcept {
    moveTowards(hip);
    return true;
}

void leaveComparison(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept {
    if (state.watch.touching)
        leaveWatch(scene, motions, state);
}

} // namespace touchstone
