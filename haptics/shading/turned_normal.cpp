#include "haptics/shading/turned_normal.h"

#include "haptics/shading/force_shading.h"

#include <algorithm>

namespace touchstone {

TurnedNormal turnedNormal(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                          int reference, const Contact& contact, const glm::dvec3& normal) noexcept {
    const ShadingMode mode = shadingMode(settings, materialOf(scene, contact));
    if (mode != ShadingMode::Direction && mode != ShadingMode::Projected)
        return {.normal = normal};
    const glm::dvec3 m = interpolatedNormal(scene, motions, reference, contact, settings.shadingTiltLimit);
    if (mode == ShadingMode::Direction)
        return {.normal = m};
    constexpr double kSteepest = 0.05; // cosine; beyond 87 degrees the projection diverges
    return {.normal = m, .cosine = std::max(glm::dot(m, contact.normal), kSteepest)};
}

} // namespace touchstone
