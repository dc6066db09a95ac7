#pragma once
// Settings that a person may change during touch. Plain data: copied to the servo by a triple buffer.

#include "engine/core/field_table.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// Neighbourhood: Ho's walk over the mesh, for a point (comparison/neighbourhood_watch.h). Rays: Zilles'
/// god-object moved by rays, also a point (comparison/ray_proxy.h). VirtualPoint: Kim's contact point of a
/// field, Potential: the force proportional to the field, both of a point (comparison/virtual_point.h).
enum class ContactMethod : uint8_t { Sweep, Neighbourhood, Rays, VirtualPoint, Potential };
/// Of the contact query and the proxy solve of contact=rays; the others are double.
enum class Precision : uint8_t { Double, Single };
/// Material: each material's forceShading (auto is two-pass). The others apply to every material that is not
/// off. SingleRound: two-pass shading once a tick, as published (shading/force_shading.h).
enum class ShadingMode : uint8_t { Off, TwoPass, Projected, Direction, Material, SingleRound };
/// How the bump height of the maps becomes force (force/spring_damper.h).
enum class TextureMode : uint8_t { Off, Law, Blinn, Minsky, BlinnMagnitude };
/// Interpolation between texels. Mip: bilinear in the level whose texel is two strokes long, which leaves out
/// what would alias at the servo rate; the others read the finest level, whatever the stroke.
enum class TextureFilter : uint8_t { Nearest, Bilinear, Bicubic, Mip };
/// The slope of a height map. Central: differences over half a texel to either side of the place.
/// Precomputed: differences stored for each texel, interpolated like the heights. Analytic: the derivative of
/// the filter.
enum class TextureGradient : uint8_t { Central, Precomputed, Analytic };
enum class FrictionMode : uint8_t { Off, Zilles, Ho, Elastoplastic, VelocityThreshold, Kim };
/// Haptic programs (haptics/program). Dual, Central, None: where the gradient of a displacement comes from
/// (ProgramGradient). Off: surfaces are plain.
enum class ProgramMode : uint8_t { Off, Dual, Central, NoGradient };
/// How the state of a body follows from forces (body/body_world.h). Explicit: [000]'s Euler step.
enum class BodyIntegrator : uint8_t { Explicit, SemiImplicit, Implicit };
/// A hand takes hold of the body that it touches (body/hold_body.h). Button: while its first button is down.
/// Touch: for as long as the setting says so.
enum class GraspMode : uint8_t { Off, Button, Touch };
/// The response of safety to energy that the device gives the hand (safety/passivity.h).
enum class PassivityMode : uint8_t { Off, Observe, Control };

/// Default-constructed: the program's start values. SI units; lengths in workspace metres.
struct HapticSettings {
    ContactMethod contact = ContactMethod::Sweep;
    Precision precision = Precision::Double;
    /// Applies where the material and the model's normals allow it.
    ShadingMode forceShading = ShadingMode::Material;
    TextureMode texture = TextureMode::Law;
    FrictionMode friction = FrictionMode::Zilles;
    ProgramMode programs = ProgramMode::Dual;
    bool deformation = true; ///< surfaces give way where their material says so (state/dents.h)
    /// m; 0 is Zilles' god-object. Larger closes wider cracks and rounds grooves. See feltRadius.
    double proxyRadius = 0.0;
    /// N/m; 0: the material's, else the device's recommendation.
    double stiffness = 0.0;
    /// N·s/m; < 0: the material's, else 0.
    double damping = -1.0;
    /// < 0: the material's, else 0.
    double staticFriction = -1.0, dynamicFriction = -1.0;
    /// Of friction=velocityThreshold. m/s along the surface, below which a sliding contact sticks again.
    double frictionThreshold = 0.01;
    /// The same law's friction over the speed while it slides, N·s/m.
    double frictionViscosity = 2.0;
    /// Of friction=kim: d of [002 eq. 4], 1/m, by which friction grows with the depth.
    double frictionDepth = 0.0;
    /// N, of contact=virtualPoint and potential: the force is no larger [002 §4.2]; 0: no threshold.
    double forceThreshold = 0.0;
    /// rad, 30°: the papers' stable range [000 §4].
    double shadingTiltLimit = 0.5235987755982988;
    /// rad, 25°. Steeper felt normals are compressed below it; >= pi/2: no limit.
    double textureTiltLimit = 0.4363323129985824;
    /// 0..1, scales height and the normal map's tilt.
    double textureStrength = 1.0;
    TextureFilter textureFilter = TextureFilter::Mip;
    TextureGradient textureGradient = TextureGradient::Central;
    /// Proxy moves a tick; fewer is safe, but touch feels sticky [000 §7].
    int iterationBudget = 64;
    PassivityMode passivity = PassivityMode::Observe;
    /// Of the scene's animation: its seconds in one, and s that it is ahead. See animationTime.
    double animationSpeed = 1.0, animationOffset = 0.0;
    /// Of a scene's rigid bodies; a scene without bodies reads neither.
    BodyIntegrator integrator = BodyIntegrator::SemiImplicit;
    /// m/s^2, downwards (-y of the workspace).
    double gravity = 9.81;
    GraspMode grasp = GraspMode::Off;
    /// 0..1, the fraction of the contact's force that the safety stage passes on to the device.
    double forceScale = 1.0;
    /// false: the force-off key; contact continues, commands are zero.
    bool forceEnabled = true;

    bool operator==(const HapticSettings&) const = default;
};

/// The animation's time in a tick at `time`, s; any sign, not wrapped.
[[nodiscard]] constexpr double animationTime(const HapticSettings& settings, double time) {
    return settings.animationOffset + settings.animationSpeed * time;
}

/// The radius of touch, m: 0 for all methods but the sweep, whatever proxyRadius is.
[[nodiscard]] constexpr double feltRadius(const HapticSettings& settings) {
    return settings.contact == ContactMethod::Sweep ? settings.proxyRadius : 0.0;
}

/// Warnings about settings that do not combine, one sentence each.
[[nodiscard]] std::vector<std::string> settingWarnings(const HapticSettings& settings);

/// Every setting: for `--set`, `--help`, the panels, what the window remembers, figures and recordings. Does
/// not compile while a member of HapticSettings is missing.
[[nodiscard]] std::span<const StructField<HapticSettings>> settingFields();

/// Sets NAME to VALUE. Returns an empty string, or an error message with the allowed values; then `settings`
/// is unchanged. Not for the servo thread.
[[nodiscard]] std::string setSetting(HapticSettings& settings, std::string_view name, std::string_view value);

/// The value of NAME as `--set` would take it; empty if there is no such setting.
[[nodiscard]] std::string settingValue(const HapticSettings& settings, std::string_view name);

} // namespace touchstone
