#pragma once
// Stage 5, the part that is constant over a material: all of it where no map or attribute is read.

#include "haptics/settings/plain_tick.h"
#include "haptics/surface/surface_sample.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

/// The contact with the largest load; the first one where no plane holds.
[[nodiscard]] inline const Contact& loadedContact(const SolveResult& rest,
                                                  const SubGoal& activeSet) noexcept {
    size_t loaded = 0;
    double most = -1.0;
    for (size_t i = 0; i < static_cast<size_t>(activeSet.count); ++i)
        if (activeSet.multiplier[i] > most) {
            most = activeSet.multiplier[i];
            loaded = static_cast<size_t>(activeSet.active[i]);
        }
    return rest.contacts[loaded];
}

/// True where readSurface would find no map, no vertex attribute and no friction with an effect. A map of a
/// coefficient that the material does not state takes effect when the session sets the coefficient.
[[nodiscard]] inline bool feelsPlain(const HapticMaterialData& material,
                                     const HapticSettings& settings) noexcept {
    return material.plain && !(settings.staticFriction > 0.0) &&
           (material.dampingMap.map.empty() || !(settings.damping > 0.0));
}

/// N/m that the settings or the material specify, before maps and attributes scale it.
[[nodiscard]] inline double specifiedStiffness(const HapticMaterialData& material,
                                               const HapticSettings& settings,
                                               const DeviceLimits& limits) noexcept {
    return settings.stiffness > 0.0         ? settings.stiffness
           : std::isnan(material.stiffness) ? limits.recommendedStiffness
                                            : material.stiffness;
}

/// The part of it that a device can bear. A value that a person sets explicitly is not reduced.
[[nodiscard]] inline double bornStiffness(double stiffness, const HapticSettings& settings,
                                          const DeviceLimits& limits) noexcept {
    return settings.stiffness > 0.0 ? stiffness : std::min(stiffness, limits.maxStiffness);
}

/// N·s/m that the settings or the material specify.
[[nodiscard]] inline double specifiedDamping(const HapticMaterialData& material,
                                             const HapticSettings& settings) noexcept {
    return settings.damping >= 0.0 ? settings.damping : std::isnan(material.damping) ? 0.0 : material.damping;
}

/// The initial sample of every contact, written into a default-constructed `feel`; readSurface adds what
/// varies. Arguments as there.
inline void plainSample(const HapticScene& scene, const HapticSettings& settings, const DeviceLimits& limits,
                        const Contact& contact, const glm::dvec3& normal, double depth,
                        SurfaceSample& feel) noexcept {
    const int index = scene.objects[static_cast<size_t>(contact.object)]->material;
    const HapticMaterialData& material = scene.materials[static_cast<size_t>(index)];
    feel.touching = true;
    feel.object = contact.object;
    feel.triangle = contact.feature;
    feel.material = index;
    feel.normal = feel.textured = normal;
    feel.depth = depth;
    feel.stiffness = bornStiffness(specifiedStiffness(material, settings, limits), settings, limits);
    feel.damping = specifiedDamping(material, settings);
}

/// Stage 7 for it: a spring and a damper that never pulls. Zero without contact.
[[nodiscard]] inline glm::dvec3 plainForce(const SurfaceSample& feel, const glm::dvec3& velocity) noexcept {
    const double push = feel.stiffness * feel.depth;
    return (push + std::max(-feel.damping * glm::dot(velocity, feel.normal), -push)) * feel.normal;
}

} // namespace touchstone
