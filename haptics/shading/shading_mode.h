#pragma once
// The kind of force shading at a contact, from material and session.

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/bezier_shading.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/solve/solve_result.h"

namespace touchstone {

[[nodiscard]] inline const HapticMaterialData& materialOf(const HapticScene& scene,
                                                          const Contact& contact) noexcept {
    return scene.materials[static_cast<size_t>(scene.objects[static_cast<size_t>(contact.object)]->material)];
}

/// The shading mode of a material in this session: off where the material is off, else the session's choice.
[[nodiscard]] inline ShadingMode shadingMode(const HapticSettings& settings,
                                             const HapticMaterialData& material) noexcept {
    return settings.forceShading == ShadingMode::Material || material.shading == ShadingMode::Off
               ? material.shading
               : settings.forceShading;
}

/// True where interpolated planes move the proxy, to the fixed point or once a tick.
[[nodiscard]] constexpr bool isTwoPass(ShadingMode mode) noexcept {
    return mode == ShadingMode::TwoPass || mode == ShadingMode::SingleRound || mode == kBezierShading;
}

/// True where two-pass shading applies to some surface of the scene: else stage 4 moves nothing.
[[nodiscard]] inline bool anyTwoPass(const EffectPlan& plan, const HapticSettings& settings) noexcept {
    return settings.forceShading == ShadingMode::Material
               ? plan.twoPassShading
               : plan.anyShading && isTwoPass(settings.forceShading);
}

/// True where some surface may turn the force of one facet (Ho, Morgenbesser).
[[nodiscard]] inline bool anyOneFacet(const EffectPlan& plan, const HapticSettings& settings) noexcept {
    return settings.forceShading == ShadingMode::Material
               ? plan.oneFacetShading
               : plan.anyShading && (settings.forceShading == ShadingMode::Direction ||
                                     settings.forceShading == ShadingMode::Projected);
}

} // namespace touchstone
