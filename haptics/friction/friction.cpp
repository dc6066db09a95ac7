#include "haptics/friction/friction.h"

#include "haptics/comparison/comparison_solver.h"
#include "haptics/friction/friction_law.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

FrictionAnswer askLaw(FrictionMode mode, const FrictionInput& input) {
    switch (mode) {
    case FrictionMode::Ho:
        return hoLaw(input);
    case FrictionMode::Elastoplastic:
        return elastoplasticLaw(input);
    case FrictionMode::VelocityThreshold:
        return velocityThresholdLaw(input);
    case FrictionMode::Kim:
        return kimLaw(input);
    case FrictionMode::Zilles:
    case FrictionMode::Off:
        break;
    }
    return zillesLaw(input);
}

/// The further input of velocityThresholdLaw. Out of line: the other laws need no velocity.
[[gnu::noinline]] void addSlip(const HapticSettings& settings, const FrictionCone& cone,
                               const glm::dvec3& velocity, FrictionInput& input) {
    const glm::dvec3& down = cone.down();
    const double squared = glm::dot(down, down), referencePerWorkspace = 1.0 / cone.workspacePerReference();
    const double into = squared > 0.0 ? glm::dot(velocity, down) / squared : 0.0;
    input.slip = referencePerWorkspace * (velocity - into * down);
    input.threshold = referencePerWorkspace * settings.frictionThreshold;
    input.viscosity = cone.stiffness() > 0.0 ? settings.frictionViscosity / cone.stiffness() : 0.0;
}

/// Moves the proxy onto the surface at `goal`, a place on the chord between two places of the surface: below
/// it where the surface is convex, above it, in the air, where it is concave.
template <class Solver>
bool settle(const glm::dvec3& goal, const glm::dvec3& down, double tolerance, Solver& proxy,
            const DeviceState& state, const SolveResult& rest) {
    proxy.moveTowards(goal);
    if (!touches(rest))
        proxy.dropTowards(goal + down);
    return touches(rest) && glm::length(state.proxy - goal) <= tolerance;
}

/// Moves the proxy to the place of the surface at `stretch` from the frictionless one. It ends only where a
/// solve reached the surface: an end in the air, since the moves are used up or the path down passes a rim,
/// is discarded. A place in the air would hold the proxy there for as long as it sticks.
template <class Solver>
void holdBack(const glm::dvec3& held, const glm::dvec3& stretch, const glm::dvec3& down, Solver& proxy,
              DeviceState& state, const SolveResult& rest) {
    // Where a wall stands between the last place and this one, or the surface bends sharply, the proxy
    // approaches from the frictionless side.
    constexpr double kNear = 0.1;
    const glm::dvec3 frictionless = state.frictionless;
    if (proxy.slideOnFacet(frictionless + stretch))
        return;
    const double tolerance = kNear * glm::length(stretch);
    proxy.startAt(held);
    if (settle(frictionless + stretch, down, tolerance, proxy, state, rest))
        return;
    proxy.startAt(frictionless);
    if (settle(frictionless + stretch, down, tolerance, proxy, state, rest) || touches(rest))
        return;
    // The frictionless place is itself in the air where the budget ended that solve.
    const glm::dvec3 hip = frictionless + down;
    if (!proxy.returnTo(frictionless, hip) && !proxy.returnTo(held, hip))
        (void)proxy.returnTo(frictionless, hip);
}

} // namespace

template <class Solver>
glm::dvec3 applyFriction(const HapticSettings& settings, const FrictionCone& cone, const glm::dvec3& velocity,
                         double dt, const glm::dvec3& held, Solver& proxy, DeviceState& state,
                         SolveResult& rest) noexcept {
    const FrictionMode mode = settings.friction;
    if (!cone.rough()) {
        state.friction = FrictionState::Free;
        return glm::dvec3(0.0);
    }
    if (state.friction == FrictionState::Free && !touches(rest))
        return glm::dvec3(0.0); // the budget ended the first solve in the air: nothing sticks there
    const glm::dvec3 before = state.frictionless;
    const glm::dvec3 frictionless = state.frictionless = state.proxy;
    if (state.friction == FrictionState::Free) {
        // First contact: the stiction point is the point of contact.
        state.friction = FrictionState::Sticking;
        state.stictionPoint = frictionless;
        return glm::dvec3(0.0);
    }
    // Ho's spring is softer than the surface: its stiction point is farther away than the proxy. In the other
    // laws it is the proxy itself, wherever moving objects may have pushed it.
    const glm::dvec3 point = mode == FrictionMode::Ho ? state.stictionPoint : held;
    const FrictionCone::Limit limit = cone.along(point - frictionless);
    FrictionInput input{.state = state.friction,
                        .stretch = point - frictionless,
                        .lastLength = glm::length(held - before),
                        .depth = limit.depth,
                        .staticFriction = limit.staticFriction,
                        .dynamicFriction = limit.dynamicFriction,
                        .dt = dt};
    if (mode == FrictionMode::VelocityThreshold)
        addSlip(settings, cone, velocity, input);
    if (mode == FrictionMode::Kim)
        input.growth = settings.frictionDepth * cone.workspacePerReference() * limit.depth;
    const FrictionAnswer answer = askLaw(mode, input);
    state.friction = answer.state;
    const bool ownPlace = mode != FrictionMode::Ho;
    if (answer.stays && ownPlace && proxy.touchesAt(held)) {
        proxy.placeAt(held);
        state.stictionPoint = held;
        return held - frictionless;
    }
    const glm::dvec3 target = answer.share * answer.stretch;
    if (target != glm::dvec3(0.0) || !touches(rest)) // else the proxy is already there
        holdBack(held, target, cone.down(), proxy, state, rest);
    state.stictionPoint = ownPlace ? state.proxy : answer.stays ? point : frictionless + answer.stretch;
    // Where the surface is curved or a wall is in the way, the chord differs from the requested stretch. The
    // force follows the chord, no longer than that stretch and never more than the contacts bear along it.
    const glm::dvec3 kept = state.proxy - frictionless;
    double asked = glm::dot(target, target);
    const double got = glm::dot(kept, kept);
    if (cone.several()) {
        const FrictionCone::Limit borne = cone.along(kept);
        asked = std::min(asked, borne.staticFriction * borne.depth * borne.staticFriction * borne.depth);
    }
    return got > asked ? std::sqrt(asked / got) * kept : kept;
}

template glm::dvec3 applyFriction(const HapticSettings&, const FrictionCone&, const glm::dvec3&, double,
                                  const glm::dvec3&, ProxySolver&, DeviceState&, SolveResult&) noexcept;
template glm::dvec3 applyFriction(const HapticSettings&, const FrictionCone&, const glm::dvec3&, double,
                                  const glm::dvec3&, ComparisonSolver&, DeviceState&, SolveResult&) noexcept;

} // namespace touchstone
