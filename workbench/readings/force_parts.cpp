#include "workbench/readings/force_parts.h"

namespace touchstone {

glm::dvec3 surfaceNormal(const HapticOutput& tick) {
    if (tick.contacts == 0)
        return glm::dvec3(0.0);
    glm::dvec3 sum(0.0);
    for (uint32_t i = 0; i < tick.planeCount; ++i)
        sum += tick.planes[i];
    // The planes of a thin gap cancel.
    const double length = glm::length(sum);
    return length > 1e-6 ? sum / length : tick.normal;
}

ForceParts forceParts(const HapticOutput& tick) {
    const glm::dvec3 normal = surfaceNormal(tick);
    if (normal == glm::dvec3(0.0))
        return {};
    const double along = glm::dot(tick.force, normal);
    return {along, glm::length(tick.force - along * normal)};
}

bool forceSent(const HapticOutput& tick, const HapticSettings& settings) {
    return settings.forceEnabled && settings.forceScale > 0.0 && !has(tick.flags, TickFlag::SafetyLatched) &&
           !has(tick.flags, TickFlag::ForceFault);
}

} // namespace touchstone
