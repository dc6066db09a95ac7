#include "haptics/comparison/neighbourhood_watch.h"

#include "haptics/proxy/place_proxy.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/settings/tick_flags.h"
#include "haptics/shape/mesh/ray.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace touchstone {

namespace {

/// Error bound of Embree's floats in the object's frame: the HIP's path is extended by this at both ends, and
/// its hits are verified in double.
double floatMargin(const glm::dvec3& p) {
    return 4e-7 * (1.0 + glm::length(p));
}

} // namespace

NeighbourhoodWatch::NeighbourhoodWatch(const HapticScene& scene, ObjectMotions motions, int budget,
                                       DeviceState& state, SolveResult& rest) noexcept
    : scene_(scene), motions_(motions), state_(state),
      rest_(rest), budget_{.steps = static_cast<uint32_t>(budget)}, steps_(budget_.steps),
      before_(state.watch.side) {
    rest_.contactCount = 0;
    rest_.iterations = 0;
    rest_.flags = 0;
    rest_.activeSet = SubGoal{};
}

SurfaceView NeighbourhoodWatch::surface(size_t object) const noexcept {
    return {*scene_.objects[object], (*scene_.neighbourhoods())[object]};
}

bool NeighbourhoodWatch::begin() noexcept {
    if (!state_.placed) {
        state_.proxy =
            motions_[static_cast<size_t>(state_.reference)].workspaceFromObject.inversePoint(state_.hip);
        state_.watch.touching = false;
        state_.placed = mayBegin(scene_, motions_, state_);
    }
    if (state_.placed)
        query();
    return state_.placed;
}

void NeighbourhoodWatch::query() noexcept {
    const auto reference = static_cast<size_t>(state_.reference);
    if (state_.watch.touching) {
        const glm::dvec3 hip = motions_[reference].workspaceFromObject.inversePoint(state_.hip);
        const SurfacePlace here = walkTowards(surface(reference), state_.watch.side, hip, budget_);
        state_.watch.side = here.side;
        if (budget_.spent || !isOnFreeSide(surface(reference), here, hip, budget_))
            return;
        // Off this surface: from the point where it left, another surface may bar the path to the HIP.
        state_.watch.touching = false;
        state_.shaded = false;
        if (acquire(here.point, true))
            return;
    } else {
        acquire(state_.proxy, false);
    }
}

/// Finds the first triangle of any object that the HIP's path crosses, in each object's own frame, so that a
/// path to a resting HIP also crosses what moves towards it. `start`: reference object frame, where the path
/// begins; `left`: on the reference object's surface, which the proxy has just left.
bool NeighbourhoodWatch::acquire(const glm::dvec3& start, bool left) noexcept {
    const auto reference = static_cast<size_t>(state_.reference);
    const glm::dvec3 begin = motions_[reference].before.point(start);
    double first = 1.0;
    int hit = -1;
    SurfacePlace place;
    for (size_t k = 0; k < scene_.objects.size(); ++k) {
        ObjectMotion motion = motions_[k];
        if (motion.jumped)
            motion.before = motion.workspaceFromObject; // a jump sweeps nothing
        const double near = glm::length(state_.hip - motion.workspaceFromObject.translation) -
                            glm::length(begin - state_.hip) -
                            glm::length(motion.workspaceFromObject.translation - motion.before.translation);
        if (near > 1.01 * motion.workspaceFromObject.scale * scene_.objects[k]->boundingRadius)
            continue;
        const glm::dvec3 from = k == reference ? start : motion.before.inversePoint(begin);
        const glm::dvec3 to = motion.workspaceFromObject.inversePoint(state_.hip);
        // The surface that it has just left lies under its first step.
        const double skip = left && k == reference ? 2.0 * floatMargin(from) : -floatMargin(from);
        if (strikes(k, from, to, skip, first, place))
            hit = static_cast<int>(k);
    }
    if (hit < 0)
        return false;
    changeReference(state_, motions_, hit);
    state_.watch = {.side = place.side, .touching = true};
    state_.friction = FrictionState::Free; // a new place: nothing sticks there yet
    return true;
}

/// True where the path from `from` to `to` ends behind a surface of this object that it crosses before
/// `first` (fraction of the path), which then becomes that fraction. `skip`: distance from `from` at which to
/// begin.
bool NeighbourhoodWatch::strikes(size_t object, const glm::dvec3& from, const glm::dvec3& to, double skip,
                                 double& first, SurfacePlace& place) noexcept {
    constexpr int kAttempts = 4;
    const SurfaceView view = surface(object);
    const double length = glm::length(to - from);
    if (!(length > 0.0))
        return false;
    const glm::dvec3 direction = (to - from) / length;
    const double margin = floatMargin(from);
    // Embree requires distances from 0 up: the ray starts where the path does, or just before.
    const glm::dvec3 origin = from + std::min(skip, 0.0) * direction;
    double near = std::max(skip, 0.0);
    bool passed = false;
    glm::dvec3 passedAt(0.0);
    const double far = length - std::min(skip, 0.0) + margin;
    for (int attempt = 0; attempt < kAttempts && near < far; ++attempt) {
        const std::optional<RayHit> hit = castRay(view.object, glm::vec3(origin), glm::vec3(direction),
                                                  static_cast<float>(near), static_cast<float>(far));
        if (!hit)
            return false;
        const auto distance = static_cast<double>(hit->distance);
        const double share = std::clamp((distance + std::min(skip, 0.0)) / length, 0.0, 1.0);
        if (share > first)
            return false;
        // Float has found the triangle; doubles decide whether the path crosses it, and whether its end is
        // then behind the surface. Where it is not, the path went through an edge of the body and out again:
        // the same place seen from within is no contact either.
        const glm::dvec3 normal = view.normal(2 * hit->triangle);
        const bool front = glm::dot(direction, normal) < 0.0;
        const double height = glm::dot(from - view.triangle(2 * hit->triangle).a, normal);
        const bool felt = front || !view.object.oneSided;
        if (felt && normal != glm::dvec3(0.0) && (front ? height >= 0.0 : height <= 0.0)) {
            const SurfacePlace there = walkTowards(view, 2 * hit->triangle + (front ? 0u : 1u), to, budget_);
            const bool seen = passed && glm::length(there.point - passedAt) < margin;
            if (!seen && (budget_.spent || !isOnFreeSide(view, there, to, budget_))) {
                first = share;
                place = there;
                return true;
            }
            passed = true;
            passedAt = there.point;
        }
        near = distance + 2.0 * margin;
    }
    return false;
}

void NeighbourhoodWatch::moveTowards(const glm::dvec3& goal) noexcept {
    if (!state_.watch.touching) {
        state_.proxy = goal;
        return;
    }
    report(goal);
}

/// Walks to the goal and reports the contact there: one feature, with the normal from the goal to it (on a
/// face the face's own, to the last bit).
void NeighbourhoodWatch::report(const glm::dvec3& goal) noexcept {
    const auto reference = static_cast<size_t>(state_.reference);
    const SurfaceView view = surface(reference);
    const SurfacePlace here = walkTowards(view, state_.watch.side, goal, budget_);
    state_.watch.side = here.side;
    state_.proxy = here.point;
    rest_.iterations = steps_ - budget_.steps;
    if (budget_.spent)
        rest_.flags = rest_.flags | TickFlag::BudgetReached;

    glm::dvec3 normal = view.normal(here.side);
    const double distance = std::sqrt(here.squared);
    if (here.feature != Feature::Face && distance > 100.0 * kContactGap) {
        const glm::dvec3 away = (goal - here.point) / distance;
        normal = isOnFreeSide(view, here, goal, budget_) ? away : -away;
    }
    rest_.contactCount = 1;
    rest_.contacts[0] = {.normal = normal,
                         .point = here.point,
                         .gap = kContactGap,
                         .object = state_.reference,
                         .feature = triangleOf(here.side)};
    rest_.activeSet = SubGoal{};
    rest_.activeSet.count = 1;
    rest_.activeSet.multiplier[0] = distance;
}

void NeighbourhoodWatch::placeAt(const glm::dvec3& p) noexcept {
    state_.proxy = p;
    state_.watch.side = before_;
}

void leaveWatch(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept {
    state.watch.touching = false;
    state.clearance = 0.0;
    // A sticking or sliding proxy stands on the facet itself, where it has no side for the sweep: it may not
    // return there.
    state.friction = FrictionState::Free;
    if (!state.placed)
        return;
    const auto reference = static_cast<size_t>(state.reference);
    const HapticObject& object = *scene.objects[reference];
    const auto* neighbourhoods = scene.neighbourhoods();
    if (neighbourhoods == nullptr) {
        state.placed = false;
        return;
    }
    const SurfaceView view{object, (*neighbourhoods)[reference]};
    state.proxy += kWeldTolerance * object.diagonal * view.normal(state.watch.side);
    state.candidates.invalidate();
    HapticSettings point;
    point.proxyRadius = 0.0;
    point.iterationBudget = 1;
    state.placed = ProxySolver(scene, motions, point, state, state.rest).isFree();
}

} // namespace touchstone
