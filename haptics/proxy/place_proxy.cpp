#include "haptics/proxy/place_proxy.h"

#include "haptics/proxy/proxy_solver.h"
#include "haptics/query/clear_of_model.h"

#include <cmath>

namespace touchstone {

int nearestObject(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip) noexcept {
    int nearest = 0;
    double least = INFINITY;
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        if (scene.objects[k]->empty())
            continue;
        const Similarity& pose = motions[k].workspaceFromObject;
        const double distance =
            glm::length(hip - pose.translation) - pose.scale * scene.objects[k]->boundingRadius;
        if (distance < least) {
            least = distance;
            nearest = static_cast<int>(k);
        }
    }
    return nearest;
}

bool isInsideAny(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip) noexcept {
    for (size_t k = 0; k < scene.objects.size(); ++k)
        if (!scene.objects[k]->oneSided &&
            insideObject(*scene.objects[k], motions[k].workspaceFromObject.inversePoint(hip)))
            return true;
    return false;
}

bool mayBegin(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept {
    if (state.mustLeave && !clearOfModel(scene, motions, state.hip))
        return false;
    if (isInsideAny(scene, motions, state.hip))
        return false;
    state.mustLeave = false;
    return true;
}

void beginTouch(DeviceState& state, bool mustLeave) noexcept {
    state.forgetTouch();
    state.mustLeave = mustLeave;
}

void letGo(DeviceState& state) noexcept {
    beginTouch(state, true);
}

void letGoOfEmptied(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept {
    const auto gone = [&](int object) {
        return object >= 0 && scene.objects[static_cast<size_t>(object)]->empty();
    };
    // The reference object need not be among them: in a scene at rest it stays the one nearest to where touch
    // began. The contacts are those of the last solve, also where the hand has not been sampled since.
    bool touched = state.watch.touching && gone(state.reference);
    for (uint32_t i = 0; state.placed && i < state.rest.contactCount; ++i)
        touched = touched || gone(state.rest.contacts[i].object);
    if (touched) {
        letGo(state);
    } else if (gone(state.reference)) {
        changeReference(state, motions, nearestObject(scene, motions, state.hip));
    }
    if (gone(state.grasp.object))
        state.grasp = {};
    // Else it may name an object of the scene before.
    if (state.shaded && gone(state.shadedObject)) {
        state.shaded = false;
        state.shadedObject = -1;
    }
}

void takeUpReshaped(const HapticScene& scene, ObjectMotions motions, std::span<const int> reshaped,
                    DeviceState& state) noexcept {
    state.candidates.invalidate();
    state.obstacleCandidates.invalidate();
    state.shaded = false;
    if (!state.placed || state.reference < 0)
        return;
    const glm::dvec3 proxy =
        motions[static_cast<size_t>(state.reference)].workspaceFromObject.point(state.proxy);
    for (const int object : reshaped) {
        const auto k = static_cast<size_t>(object);
        const Shape* const shape = scene.objects[k]->shape.get();
        const PotentialField* const field = shape != nullptr ? shape->potential() : nullptr;
        if (field == nullptr ||
            field->value(motions[k].workspaceFromObject.inversePoint(proxy)) >= -field->voxel())
            continue;
        letGo(state);
        return;
    }
}

} // namespace touchstone
