#include "haptics/comparison/ray_proxy.h"

#include "engine/math/few_planes.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// A target displacement shorter than this ends the solve, object units: far below the clearance, above
/// rounding.
template <class Real>
constexpr Real kStill = Real(sizeof(Real) == sizeof(double) ? 1e-11 : 1.5e-7);
/// The same after `moves` in this tick: from the ninth on it doubles with every second one, up to a quarter
/// of the clearance. Where facets meet at hundredths of a degree, moves of that length would circle.
template <class Real>
Real stillAfter(uint32_t moves) {
    constexpr uint32_t kPatient = 8;
    return moves <= kPatient ? kStill<Real>
                             : std::min(std::ldexp(kStill<Real>, static_cast<int>((moves - kPatient) / 2)),
                                        std::max(Real(0.25) * kRayClearance<Real>, kStill<Real>));
}
/// Consecutive rays that may find planes without moving the god-object. Three make a corner.
constexpr int kFruitlessRays = 8;
constexpr uint32_t kRaysPerMove = 4;

} // namespace

template <class Real>
RayProxy<Real>::RayProxy(const HapticScene& scene, ObjectMotions motions, int budget, DeviceState& state,
                         SolveResult& rest) noexcept
    : scene_(scene), motions_(motions), state_(state), rest_(rest), moves_(static_cast<uint32_t>(budget)),
      rays_(kRaysPerMove * static_cast<uint32_t>(budget)), path_(scene, motions, state.reference),
      at_(state.proxy) {
    rest_.contactCount = 0;
    rest_.iterations = 0;
    rest_.flags = 0;
    rest_.activeSet = SubGoal{};
}

template <class Real>
bool RayProxy<Real>::begin() noexcept {
    if (state_.placed)
        return true;
    placeAt(motions_[static_cast<size_t>(state_.reference)].workspaceFromObject.inversePoint(state_.hip));
    state_.placed = mayBegin(scene_, motions_, state_);
    return state_.placed;
}

template <class Real>
void RayProxy<Real>::placeAt(const glm::dvec3& p) noexcept {
    at_ = Vec(p);
    state_.proxy = glm::dvec3(at_);
    heldCount_ = 0;
}

/// The target displacement that the planes allow, and the planes that hold the god-object: the others are
/// dropped.
template <class Real>
void RayProxy<Real>::target(const Vec& goal) noexcept {
    target_ = goal - at_;
    multiplier_ = {};
    if (heldCount_ == 0)
        return;
    FewPlanes<Real> planes;
    planes.count = heldCount_;
    for (size_t i = 0; i < heldCount_; ++i)
        planes.plane[i] = {held_[i].normal, held_[i].clearance - path_.height(held_[i], at_)};
    const FewPlanesGoal<Real> nearest = nearestOnPlanes<Real>(target_, planes);
    target_ = nearest.point;
    if (!nearest.found) // between planes that leave no room: all of them hold it
        return;
    std::array<RayStrike<Real>, 4> holding;
    for (size_t i = 0; i < nearest.count; ++i) {
        holding[i] = held_[nearest.active[i]];
        multiplier_[i] = nearest.multiplier[i];
    }
    held_ = holding;
    heldCount_ = nearest.count;
}

/// Adds or updates a plane. There is always room: after `target` at most three are held.
template <class Real>
void RayProxy<Real>::add(const RayStrike<Real>& hit) noexcept {
    for (size_t i = 0; i < heldCount_; ++i)
        if (held_[i].object == hit.object && held_[i].triangle == hit.triangle) {
            held_[i] = hit;
            return;
        }
    if (heldCount_ == held_.size())
        --heldCount_;
    held_[heldCount_++] = hit;
}

/// Out of moves over the surface that it was sliding on: that surface still holds the HIP off, or the force
/// would drop out.
template <class Real>
void RayProxy<Real>::holdInTheAir(const Vec& goal) noexcept {
    if (heldCount_ > 0 || last_.object < 0)
        return;
    held_[0] = last_;
    multiplier_[0] = std::max(glm::dot(at_ - goal, last_.normal), Real(0));
    heldCount_ = 1;
}

template <class Real>
void RayProxy<Real>::solve(const glm::dvec3& towards, bool sliding) noexcept {
    const Vec goal(towards);
    heldCount_ = 0;
    bool touched = false;
    for (int fruitless = 0;;) {
        target(goal);
        const Real length = glm::length(target_), still = stillAfter<Real>(rest_.iterations);
        if (!(length > still) || fruitless > kFruitlessRays || (touched && !sliding))
            break;
        if (moves_ == 0 || rays_ == 0) {
            rest_.flags = rest_.flags | TickFlag::BudgetReached;
            holdInTheAir(goal);
            break;
        }
        --rays_;
        const std::optional<RayStrike<Real>> hit = path_.strike(at_, target_);
        if (path_.full()) {
            rest_.flags = rest_.flags | TickFlag::CandidatesFull;
            break;
        }
        const Real share = hit ? hit->share : Real(1);
        if (share * length > still) {
            at_ += share * target_;
            fruitless = 0;
            --moves_;
            ++rest_.iterations;
            size_t standing = 0;
            for (size_t i = 0; i < heldCount_; ++i)
                if (path_.stands(held_[i], at_))
                    held_[standing++] = held_[i];
            heldCount_ = standing;
        } else {
            ++fruitless;
        }
        touched = hit.has_value();
        if (hit) {
            add(*hit);
            last_ = *hit;
        }
    }
    report();
}

/// The active planes as the later stages read them: in contact at the proxy's place.
template <class Real>
void RayProxy<Real>::report() noexcept {
    state_.proxy = glm::dvec3(at_);
    rest_.contactCount = 0;
    rest_.activeSet = SubGoal{};
    for (size_t i = 0; i < std::min(heldCount_, rest_.activeSet.active.size()); ++i) {
        const RayStrike<Real>& plane = held_[i];
        const Vec foot = at_ - path_.height(plane, at_) * plane.normal;
        const auto k = static_cast<size_t>(rest_.contactCount++);
        rest_.contacts[k] = {.normal = glm::dvec3(plane.normal),
                             .point = glm::dvec3(foot),
                             .gap = kContactGap,
                             .object = plane.object,
                             .feature = plane.triangle};
        rest_.activeSet.active[k] = static_cast<int>(k);
        rest_.activeSet.multiplier[k] = static_cast<double>(multiplier_[i]);
        rest_.activeSet.count = static_cast<int>(k) + 1;
    }
}

template class RayProxy<double>;
template class RayProxy<float>;

namespace {

/// The path of the god-object past one object in this tick, in that object's frame; where it hits, the place
/// at which the object holds it from then on.
std::optional<glm::dvec3> runInto(const HapticScene& scene, const ObjectMotion& motion, size_t object,
                                  const glm::dvec3& before, const glm::dvec3& now) {
    const glm::dvec3 from = motion.before.inversePoint(before),
                     to = motion.workspaceFromObject.inversePoint(now);
    const double length = glm::length(to - from);
    constexpr double kClearance = kRayClearance<double>;
    if (!(length > 0.0) ||
        glm::length(from) - length > 1.01 * scene.objects[object]->boundingRadius + kClearance)
        return std::nullopt;
    const glm::dvec3 direction = (to - from) / length;
    const auto met = meetAlong<double>(*scene.objects[object], from, direction, length + kClearance);
    if (!met || met->height + length * met->rate >= kClearance)
        return std::nullopt;
    // Its former place, seen from the object, but off its surface.
    const double free = std::clamp((met->height - kClearance) / -met->rate, 0.0, length);
    return from + free * direction + std::max(kClearance - met->height, 0.0) * met->normal;
}

} // namespace

void sweepMovingObstaclesByRays(const HapticScene& scene, ObjectMotions motions, DeviceState& state,
                                uint32_t& flags) noexcept {
    state.clearance = 0.0;
    if (!state.placed || motions.data() == scene.restMotions.data())
        return;
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round) {
        const auto reference = static_cast<size_t>(state.reference);
        const glm::dvec3 before = motions[reference].before.point(state.proxy),
                         now = motions[reference].workspaceFromObject.point(state.proxy);
        int hitBy = -1;
        glm::dvec3 place(0.0);
        for (size_t k = 0; k < scene.objects.size() && hitBy < 0; ++k) {
            if (k == reference || motions[k].jumped)
                continue;
            if (const auto held = runInto(scene, motions[k], k, before, now)) {
                hitBy = static_cast<int>(k);
                place = *held;
            }
        }
        if (hitBy < 0)
            return;
        changeReference(state, motions, hitBy);
        state.proxy = place;
        state.friction = FrictionState::Free;
        state.shaded = false;
    }
    flags = flags | TickFlag::Jammed;
}

} // namespace touchstone
