#include "haptics/comparison/virtual_point.h"

#include "haptics/proxy/place_proxy.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Place in an object's frame where the line from `tip`, where f < 0, along the unit `direction` first leaves
/// the object; on the outer side of the root by at most 1e-15. A step is half a voxel, or more where the
/// Lipschitz bound of f excludes a root: thinner gaps may be missed. `reach`: a length after which f is
/// positive.
glm::dvec3 leavesAt(const PotentialField& field, const glm::dvec3& tip, const glm::dvec3& direction,
                    double depth, double reach) {
    constexpr int kBisections = 60;
    const double shortest = 0.5 * field.voxel();
    double inside = 0.0, outside = 0.0, f = -depth;
    while (f < 0.0 && outside < reach) {
        inside = outside;
        outside += std::max(shortest, -f / field.lipschitz());
        f = field.value(tip + outside * direction);
    }
    for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (inside + outside);
        if (!(middle > inside) || !(middle < outside))
            break;
        (field.value(tip + middle * direction) < 0.0 ? inside : outside) = middle;
    }
    return tip + outside * direction;
}

/// After this length every line through the object has left it.
double reachOf(const HapticObject& object) {
    return 2.0 * object.boundingRadius + object.shape->potential()->voxel();
}

} // namespace

VirtualPoint::VirtualPoint(const HapticScene& scene, ObjectMotions motions, ContactMethod method,
                           DeviceState& state, SolveResult& rest) noexcept
    : scene_(scene), motions_(motions), method_(method), state_(state), rest_(rest), tip_(state.proxy) {
    rest_.contactCount = 0;
    rest_.iterations = 0;
    rest_.flags = 0;
    rest_.activeSet = SubGoal{};
}

bool VirtualPoint::begin() noexcept {
    if (!state_.watch.touching)
        state_.friction = FrictionState::Free; // what the sweep left sticks at the centre of a ball
    if (state_.placed)
        return true;
    placeAt(motions_[static_cast<size_t>(state_.reference)].workspaceFromObject.inversePoint(state_.hip));
    state_.placed = mayBegin(scene_, motions_, state_);
    return state_.placed;
}

void VirtualPoint::moveTowards(const glm::dvec3& goal) noexcept {
    tip_ = state_.proxy = goal;
    rest_.contactCount = 0;
    rest_.activeSet = SubGoal{};
    state_.watch.touching = false;
    ++rest_.iterations;

    const Similarity& workspaceFromReference =
        motions_[static_cast<size_t>(state_.reference)].workspaceFromObject;
    const glm::dvec3 tip = workspaceFromReference.point(goal);
    int touched = -1;
    double deepest = 0.0; // m
    for (size_t k = 0; k < scene_.objects.size(); ++k) {
        const Similarity& workspaceFromObject = motions_[k].workspaceFromObject;
        const glm::dvec3 inObject = workspaceFromObject.inversePoint(tip);
        const double reach = scene_.objects[k]->boundingRadius;
        if (scene_.objects[k]->empty() || glm::dot(inObject, inObject) > reach * reach)
            continue;
        const double depth =
            -workspaceFromObject.scale * scene_.objects[k]->shape->potential()->value(inObject);
        if (depth > deepest) {
            deepest = depth;
            touched = static_cast<int>(k);
        }
    }
    if (touched < 0)
        return;
    state_.watch.touching = true; // also without a direction: the sweep may not start from here

    const HapticObject& object = *scene_.objects[static_cast<size_t>(touched)];
    const PotentialField& field = *object.shape->potential();
    const Similarity& workspaceFromObject = motions_[static_cast<size_t>(touched)].workspaceFromObject;
    const glm::dvec3 inObject = workspaceFromObject.inversePoint(tip), gradient = field.gradient(inObject);
    const double steepness = glm::length(gradient), depth = -field.value(inObject);
    if (!(steepness > 0.0))
        return;
    const glm::dvec3 normal = gradient / steepness;
    const glm::dvec3 place = method_ == ContactMethod::Potential
                                 ? inObject + depth * normal
                                 : leavesAt(field, inObject, normal, depth, reachOf(object));
    state_.proxy = workspaceFromReference.inversePoint(workspaceFromObject.point(place));
    report(touched, glm::conjugate(workspaceFromReference.rotation) * workspaceFromObject.direction(normal));
}

bool VirtualPoint::slideTo(const glm::dvec3& place) noexcept {
    state_.proxy = place;
    if (method_ == ContactMethod::Potential || rest_.contactCount == 0)
        return true;
    const int touched = rest_.contacts[0].object;
    const HapticObject& object = *scene_.objects[static_cast<size_t>(touched)];
    const PotentialField& field = *object.shape->potential();
    const Similarity objectFromReference =
        motions_[static_cast<size_t>(touched)].workspaceFromObject.inverseTimes(
            motions_[static_cast<size_t>(state_.reference)].workspaceFromObject);
    const glm::dvec3 tip = objectFromReference.point(tip_), line = objectFromReference.point(place) - tip;
    const double length = glm::length(line), depth = -field.value(tip);
    if (length > 0.0 && depth > 0.0)
        state_.proxy =
            objectFromReference.inversePoint(leavesAt(field, tip, line / length, depth, reachOf(object)));
    return true;
}

/// One contact, whose plane holds the tip off along `normal` (unit, reference object frame).
void VirtualPoint::report(int object, const glm::dvec3& normal) noexcept {
    rest_.contacts[0] = {
        .normal = normal, .point = state_.proxy, .gap = kContactGap, .object = object, .feature = 0};
    rest_.contactCount = 1;
    rest_.activeSet.active[0] = 0;
    rest_.activeSet.multiplier[0] = glm::length(state_.proxy - tip_);
    rest_.activeSet.count = 1;
}

} // namespace touchstone
