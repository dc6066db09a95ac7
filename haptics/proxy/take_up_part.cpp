#include "haptics/proxy/take_up_part.h"

#include "engine/scene/mesh_deformation.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/query/clear_of_model.h"
#include "haptics/shape/mesh/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

/// Triangles asked one by one; with more around the proxy, a surface counts as near.
constexpr size_t kAsked = 512;

enum class Nearness { Far, Touching, Met };

/// How near the object comes to a ball that rests on its surfaces at `radius` (object units): rebuilt
/// vertices are floats, up to 1e-7 of the object from where they were, and the smallest radius is 5e-7.
Nearness nearnessOf(const HapticObject& object, const glm::dvec3& centre, double radius) noexcept {
    const double met = 0.5 * radius, touching = 1.5 * radius;
    if (object.empty() || glm::length(centre) > object.boundingRadius + touching)
        return Nearness::Far;
    double least = INFINITY;
    if (object.shape != nullptr) {
        std::array<FeatureDistance, 1> nearest;
        if (object.shape->near(centre, touching, nearest) > 0)
            least = nearest[0].distance;
    } else {
        std::array<TriangleTree::Near, kAsked> boxes;
        const size_t count =
            treeOf(object).collect(glm::vec3(centre), static_cast<float>(2.0 * radius), boxes);
        if (count == boxes.size())
            return Nearness::Met;
        for (size_t i = 0; i < count; ++i)
            least = std::min(least, distanceTo(triangleOf(object, boxes[i].triangle), centre).distance);
    }
    return least < met ? Nearness::Met : least <= touching ? Nearness::Touching : Nearness::Far;
}

/// True where the proxy is where it may be and every surface that holds it is still there.
bool mayGoOn(const HapticScene& scene, ObjectMotions motions, double workspaceRadius, const glm::dvec3& proxy,
             const DeviceState& state) noexcept {
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const HapticObject& object = *scene.objects[k];
        const Similarity& pose = motions[k].workspaceFromObject;
        const double radius = std::max(workspaceRadius / pose.scale, 0.5 * kWeldTolerance * object.diagonal);
        const Nearness nearness = nearnessOf(object, pose.inversePoint(proxy), radius);
        if (nearness == Nearness::Met)
            return false;
        for (uint32_t i = 0; i < state.rest.contactCount; ++i)
            if (state.rest.contacts[i].object == static_cast<int>(k) && nearness == Nearness::Far)
                return false;
    }
    return !isInsideAny(scene, motions, proxy);
}

} // namespace

bool canTakeUpPart(const Scene* source) {
    return source == nullptr || !hasSoftBodies(*source);
}

void takeUpPart(const HapticScene& scene, const HapticScene& now, const HapticScene* before,
                ObjectMotions motions, double radius, DeviceState& state) noexcept {
    letGoOfEmptied(now, motions, state);
    state.candidates.invalidate();
    state.obstacleCandidates.invalidate();
    state.shaded = false;
    state.shadedObject = -1;
    bool goesOn = state.placed && state.reference >= 0 && state.jammed.count == 0 && !state.watch.touching;
    if (goesOn) {
        const glm::dvec3 proxy =
            motions[static_cast<size_t>(state.reference)].workspaceFromObject.point(state.proxy);
        goesOn = mayGoOn(now, motions, radius, proxy, state) &&
                 (!isEnclosed(now, motions, proxy) ||
                  (before != nullptr && isEnclosedIn(*before, scene, now, motions, proxy)));
    }
    if (!goesOn)
        letGo(state);
}

} // namespace touchstone
