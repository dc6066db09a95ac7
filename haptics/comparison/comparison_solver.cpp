#include "haptics/comparison/comparison_solver.h"

#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

constexpr bool isOfFields(ContactMethod method) {
    return method == ContactMethod::VirtualPoint || method == ContactMethod::Potential;
}

/// Where a model does not handle every object it would let the hand into one, and the sweep would then push
/// it out.
bool handles(const HapticScene& scene, ContactMethod method) noexcept {
    if (method == ContactMethod::Sweep)
        return true;
    return std::ranges::all_of(scene.objects, [&](const auto& object) {
        if (object->empty())
            return true; // hidden
        if (object->instant != nullptr)
            return false; // its rays and its adjacency are those of the static pose
        return isOfFields(method) ? object->shape != nullptr && object->shape->potential() != nullptr
                                  : object->shape == nullptr;
    });
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
    if (!handles(scene, settings.contact))
        return false;
    switch (settings.contact) {
    case ContactMethod::Rays:
        return scene.hasRays();
    case ContactMethod::Neighbourhood:
        return scene.neighbourhoods() != nullptr;
    case ContactMethod::VirtualPoint:
    case ContactMethod::Potential:
        return true;
    case ContactMethod::Sweep:
        break;
    }
    return false;
}

std::string refusalOf(const HapticScene& scene, const HapticSettings& settings) {
    if (handles(scene, settings.contact))
        return {};
    const bool fields = isOfFields(settings.contact);
    if (std::ranges::any_of(scene.objects, [](const auto& object) { return object->instant != nullptr; }))
        return "contact=" + settingValue(settings, "contact") + " touches no surface that deforms: swept";
    return "contact=" + settingValue(settings, "contact") +
           (fields
                ? " touches distance fields, and the scene has a mesh (representation: implicit makes it a "
                  "field)"
                : " touches meshes, and the scene has a distance field") +
           ": swept";
}

std::vector<std::string> settingWarnings(const HapticScene& scene, const HapticSettings& settings) {
    std::vector<std::string> warnings = settingWarnings(settings);
    if (std::string refusal = refusalOf(scene, settings); !refusal.empty())
        warnings.push_back(std::move(refusal));
    return warnings;
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

ComparisonSolver::Solver ComparisonSolver::solverFor(const HapticScene& scene, ObjectMotions motions,
                                                     const HapticSettings& settings, DeviceState& state,
                                                     SolveResult& rest) noexcept {
    const int budget = settings.iterationBudget;
    if (settings.contact == ContactMethod::Neighbourhood)
        return NeighbourhoodWatch(scene, motions, budget, state, rest);
    if (isOfFields(settings.contact))
        return VirtualPoint(scene, motions, settings.contact, state, rest);
    if (settings.precision == Precision::Single)
        return RayProxy<float>(scene, motions, budget, state, rest);
    return RayProxy<double>(scene, motions, budget, state, rest);
}

ComparisonSolver::ComparisonSolver(const HapticScene& scene, ObjectMotions motions,
                                   const HapticSettings& settings, DeviceState& state,
                                   SolveResult& rest) noexcept
    : state_(state), forceThreshold_(settings.forceThreshold),
      solver_(solverFor(scene, motions, settings, state, rest)) {}

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

bool ComparisonSolver::slideOnFacet(const glm::dvec3& place) noexcept {
    auto* const solver = std::get_if<VirtualPoint>(&solver_);
    return solver != nullptr && solver->slideTo(place);
}

glm::dvec3 ComparisonSolver::asPublished(const glm::dvec3& force, const glm::dvec3& hip,
                                         double workspacePerReference, double stiffness, double damping,
                                         const glm::dvec3& velocity,
                                         const glm::dvec3& viscousForce) const noexcept {
    if (!std::holds_alternative<VirtualPoint>(solver_))
        return force;
    const glm::dvec3 published =
        stiffness * workspacePerReference * (state_.proxy - hip) - damping * velocity + viscousForce;
    const double length = glm::length(published);
    return forceThreshold_ > 0.0 && length > forceThreshold_ ? forceThreshold_ / length * published
                                                             : published;
}

bool ComparisonSolver::returnTo(const glm::dvec3&, const glm::dvec3& hip) noexcept {
    moveTowards(hip);
    return true;
}

void leaveComparison(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept {
    if (!state.watch.touching)
        return;
    if (scene.neighbourhoods() != nullptr &&
        scene.objects[static_cast<size_t>(state.reference)]->shape == nullptr) {
        leaveWatch(scene, motions, state);
        return;
    }
    // A virtual point has no side, and lies where the sweep may not start.
    state.watch.touching = state.placed = false;
    state.clearance = 0.0;
    state.friction = FrictionState::Free;
}

} // namespace touchstone
