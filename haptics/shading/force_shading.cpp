#include "haptics/shading/force_shading.h"

#include "haptics/comparison/comparison_solver.h"
#include "haptics/settings/tick_flags.h"
#include "haptics/shading/patch_normal.h"
#include "haptics/shading/tilt_limit.h"
#include "haptics/shape/mesh/triangle.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// The error of the goal contracts by depth over radius of curvature in each round (0.04 on a 25 mm torus
/// pressed 1 mm, 0.15 on the ten-sided prism of [000 Fig. 6]); twelve rounds bring the worst of these below a
/// nanometre.
constexpr int kMaxRounds = 12;
/// Object units: 1.5 nm on a fitted model, 1.5 µN at 1000 N/m.
constexpr double kGoalTolerance = 1e-8;
/// rad: a normal that turned farther in one tick crossed an edge and does not predict the next.
constexpr double kLargestTurn = 0.1;

/// The goal that the interpolated planes through the proxy define.
struct ShadedGoal {
    glm::dvec3 goal{0.0};   ///< reference object frame
    glm::dvec3 normal{0.0}; ///< unit, from the HIP to the goal; meaningful while held
    bool tilted = false;    ///< some interpolated normal differs from the true one
    bool held = false;      ///< a tilted plane holds the HIP off
    int facet = -1;         ///< the one contact whose plane holds it; -1: several do
};

/// A goal above all true planes would lift the proxy off: it is projected onto the nearest of them [000 §4].
glm::dvec3 onTruePlanes(const glm::dvec3& goal, const glm::dvec3& proxy, const SolveResult& rest) {
    double nearest = INFINITY;
    glm::dvec3 normal(0.0);
    for (uint32_t i = 0; i < rest.contactCount; ++i) {
        const Contact& contact = rest.contacts[i];
        const double above = glm::dot(contact.normal, goal - proxy) - (kContactGap - contact.gap);
        if (above < nearest) {
            nearest = above;
            normal = contact.normal;
        }
    }
    return nearest > 0.0 && rest.contactCount > 0 ? goal - nearest * normal : goal;
}

/// First pass: the nearest point to the HIP on the interpolated planes, projected onto the nearest true plane
/// where it is above all of them, since such a goal would lift the proxy off [000 §4].
ShadedGoal shadedGoal(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                      const DeviceState& state, const glm::dvec3& hip, SolveResult& rest) {
    auto& planes = rest.shadedPlanes;
    ShadedGoal result;
    for (uint32_t i = 0; i < rest.contactCount; ++i) {
        const Contact& contact = rest.contacts[i];
        const ShadingMode mode = shadingMode(settings, materialOf(scene, contact));
        const bool shaded = isTwoPass(mode);
        planes[i] = {shaded ? interpolatedNormal(scene, motions, state.reference, contact,
                                                 settings.shadingTiltLimit, mode == kBezierShading)
                            : contact.normal,
                     0.0};
        result.tilted |= planes[i].normal != contact.normal;
    }
    const glm::dvec3 target = hip - state.proxy;
    const SubGoal pass = rest.shadedActiveSet = nearestFeasible(target, {planes.data(), rest.contactCount});
    result.goal = state.proxy + pass.point;
    if (pass.count == 0)
        return result;
    const glm::dvec3 towards = pass.point - target;
    const double length = glm::length(towards);
    result.held = result.tilted && length > 0.0;
    if (result.held) {
        result.normal = towards / length;
        result.facet = pass.count == 1 ? pass.active[0] : -1;
    }
    result.goal = onTruePlanes(result.goal, state.proxy, rest);
    return result;
}

/// The turn of the shaded normal, where it predicts the next tick; else zero.
glm::dvec3 smallTurn(const glm::dvec3& turn) {
    return glm::dot(turn, turn) > kLargestTurn * kLargestTurn ? glm::dvec3(0.0) : turn;
}

[[gnu::always_inline]] inline glm::dvec3 normalAt(const HapticObject& object, uint32_t triangle,
                                                  const glm::dvec3& point, bool patch) {
    const uint32_t* const source = &object.sourceIndices[3 * static_cast<size_t>(triangle)];
    const Triangle corners = triangleOf(object, triangle);
    const glm::dvec3 weight = barycentric(corners, point); // before the normals: fewer values at once
    const glm::dvec3 a = normalOf(object, source[0]), b = normalOf(object, source[1]),
                     c = normalOf(object, source[2]);
    if (patch)
        return patchNormal({corners.a, corners.b, corners.c}, {a, b, c}, weight);
    return weight.x * a + weight.y * b + weight.z * c;
}

/// Out of line: what rests, and has no patch, pays one branch.
[[gnu::noinline]] glm::dvec3 patchOrDeformed(const HapticObject& object, uint32_t triangle,
                                             const glm::dvec3& point, bool patch) {
    return normalAt(object, triangle, point, patch);
}

/// The interpolated vertex normal at a point of a triangle, or that of its patch; object frame, not of unit
/// length.
glm::dvec3 interpolated(const HapticObject& object, uint32_t triangle, const glm::dvec3& point, bool patch) {
    if (patch || object.instant != nullptr) [[unlikely]]
        return patchOrDeformed(object, triangle, point, patch);
    return normalAt(object, triangle, point, false);
}

/// True where stage 3 came to rest at the place that the first goal predicted, held by that facet alone: a
/// round would then find the same goal again.
bool cameTo(const FirstGoal& first, const DeviceState& state, const SolveResult& rest) {
    if (!first.onFacet || rest.contactCount != 1)
        return false;
    const Contact& contact = rest.contacts[0];
    const glm::dvec3 off = state.proxy - first.place;
    return contact.object == state.shadedObject && contact.feature == state.shadedTriangle &&
           glm::dot(off, off) <= kGoalTolerance * kGoalTolerance;
}

} // namespace

glm::dvec3 interpolatedNormal(const HapticScene& scene, ObjectMotions motions, int reference,
                              const Contact& contact, double tiltLimit, bool patch) noexcept {
    const auto k = static_cast<size_t>(contact.object);
    const HapticObject& object = *scene.objects[k];
    if (object.shape == nullptr && object.smooth[contact.feature] == 0)
        return contact.normal;
    glm::dvec3 point = contact.point, trueNormal = contact.normal;
    Similarity referenceFromObject;
    const bool foreign = contact.object != reference;
    if (foreign) {
        referenceFromObject = motions[static_cast<size_t>(reference)].workspaceFromObject.inverseTimes(
            motions[k].workspaceFromObject);
        const Similarity back = referenceFromObject.inverse();
        point = back.point(point);
        trueNormal = back.direction(trueNormal);
    }
    glm::dvec3 normal = object.shape != nullptr ? object.shape->shadingNormal(contact.feature, point)
                                                : interpolated(object, contact.feature, point, patch);
    const double length = glm::length(normal);
    if (!(length > 1e-6))
        return contact.normal; // opposed vertex normals cancel: no shading
    normal /= length;
    // The model's normals face outwards; a proxy on the back of a sheet feels the same curve from below.
    double cosine = glm::dot(normal, trueNormal);
    if (cosine < 0.0) {
        normal = -normal;
        cosine = -cosine;
    }
    if (leansBeyond(cosine, tiltLimit)) {
        const double limit = std::cos(tiltLimit);
        const glm::dvec3 sideways = normal - cosine * trueNormal;
        const double sine = glm::length(sideways);
        normal = sine > 0.0 ? limit * trueNormal + std::sin(tiltLimit) / sine * sideways : trueNormal;
    }
    return foreign ? referenceFromObject.direction(normal) : normal;
}

template <class Solver>
void shadeTwoPass(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                  const glm::dvec3& hip, const FirstGoal& first, Solver& proxy, DeviceState& state,
                  SolveResult& rest) noexcept {
    if (cameTo(first, state, rest)) {
        state.shadedTurn = smallTurn(first.normal - state.shadedNormal);
        state.shadedNormal = first.normal;
        rest.shadedActiveSet = SubGoal{};
        rest.shadedActiveSet.count = 1;
        return;
    }
    const bool wasShaded = state.shaded;
    const glm::dvec3 lastNormal = state.shadedNormal;
    glm::dvec3 lastGoal = first.goal, lastStep(0.0);
    double relax = 1.0;
    for (int round = 0; round < kMaxRounds; ++round) {
        const ShadedGoal shaded = shadedGoal(scene, motions, settings, state, hip, rest);
        state.shaded = shaded.held;
        state.shadedNormal = shaded.normal;
        state.shadedObject = -1;
        if (shaded.facet >= 0) {
            const Contact& facet = rest.contacts[static_cast<size_t>(shaded.facet)];
            state.shadedObject = facet.object;
            state.shadedTriangle = facet.feature;
        }
        state.shadedTurn = wasShaded && shaded.held ? smallTurn(shaded.normal - lastNormal) : glm::dvec3(0.0);
        if (!shaded.tilted && lastGoal == hip)
            return;
        glm::dvec3 step = shaded.goal - lastGoal;
        const double length = glm::length(step);
        if (length <= kGoalTolerance)
            return;
        // Steps shrink by a nearly constant ratio: extrapolate to their limit (Aitken). In a hollow pressed
        // deeper than it is wide the goal oscillates instead: take the midpoint.
        const glm::dvec3 change = lastStep - step;
        const double before = glm::dot(change, change);
        relax = before > 0.0 && shaded.held && glm::dot(lastStep, lastStep) > 0.0
                    ? std::clamp(relax * glm::dot(lastStep, change) / before, 0.1, 1.45)
                    : 1.0;
        lastGoal = shaded.held ? onTruePlanes(lastGoal + relax * step, state.proxy, rest) : shaded.goal;
        lastStep = shaded.held ? step : glm::dvec3(0.0);
        proxy.moveTowards(lastGoal);
        // Over a rounded edge the goal of the true planes is in the air: the surface is below it along the
        // shaded normal.
        if (rest.contactCount == 0 && shaded.held)
            proxy.dropTowards(hip);
        // At most a third of the tick's moves, so that the rest can return the proxy to the true contact.
        if (3 * rest.iterations >= static_cast<uint32_t>(settings.iterationBudget))
            break;
    }
    rest.flags = rest.flags | TickFlag::ShadingNotConverged;
    // Where the rounds do not converge, the true contact holds: a stable rest, and the same one in the next
    // tick.
    state.shaded = false;
    proxy.moveTowards(hip);
}

template <class Solver>
void findShaded(const glm::dvec3& hip, Solver& proxy, DeviceState& state, SolveResult& rest) noexcept {
    const glm::dvec3 place = state.proxy;
    proxy.moveTowards(place);
    if (rest.contactCount == 0)
        proxy.moveTowards(hip);
}

template <class Solver>
void shadeSingleRound(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                      const glm::dvec3& hip, Solver& proxy, DeviceState& state, SolveResult& rest) noexcept {
    const ShadedGoal first = shadedGoal(scene, motions, settings, state, hip, rest);
    proxy.moveTowards(first.held ? first.goal : hip);
    // The goal may lie beyond an edge, in the air: the proxy comes down "on the object surface" [000 §4].
    if (rest.contactCount == 0 && first.held)
        proxy.dropTowards(hip);
    // The planes of the place that it came to: what carries the hand, and what the next tick starts from.
    const ShadedGoal last = shadedGoal(scene, motions, settings, state, hip, rest);
    state.shaded = last.held;
    state.shadedNormal = last.normal;
    state.shadedTurn = glm::dvec3(0.0);
    state.shadedObject = -1;
}

template void findShaded(const glm::dvec3&, ProxySolver&, DeviceState&, SolveResult&) noexcept;
template void findShaded(const glm::dvec3&, ComparisonSolver&, DeviceState&, SolveResult&) noexcept;
template void shadeSingleRound(const HapticScene&, ObjectMotions, const HapticSettings&, const glm::dvec3&,
                               ProxySolver&, DeviceState&, SolveResult&) noexcept;
template void shadeSingleRound(const HapticScene&, ObjectMotions, const HapticSettings&, const glm::dvec3&,
                               ComparisonSolver&, DeviceState&, SolveResult&) noexcept;
template void shadeTwoPass(const HapticScene&, ObjectMotions, const HapticSettings&, const glm::dvec3&,
                           const FirstGoal&, ProxySolver&, DeviceState&, SolveResult&) noexcept;
template void shadeTwoPass(const HapticScene&, ObjectMotions, const HapticSettings&, const glm::dvec3&,
                           const FirstGoal&, ComparisonSolver&, DeviceState&, SolveResult&) noexcept;

} // namespace touchstone
