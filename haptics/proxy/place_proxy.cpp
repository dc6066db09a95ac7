#include "haptics/proxy/place_proxy.h"

#include "haptics/query/clear_of_model.h"

#include <cmath>

namespace touchstone {

int nearestObject(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip) noexcept {
    int nearest = 0;
    double least = INFINITY;
    for (size_t k = 0; k < scene.objects.size(); ++k) {
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

} // namespace touchstone
