#pragma once
// Stage 5: the surface at the contact, with its maps.

#include "haptics/proxy/proxy_solver.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"

#include <glm/glm.hpp>

namespace touchstone {

/// The surface under the proxy as the later stages need it. Directions in the reference object frame, lengths
/// in m.
struct SurfaceSample {
    bool touching = false;
    int object = -1;
    uint32_t triangle = 0;
    int material = 0;
    glm::dvec3 normal{0.0};   ///< n: the felt shape's unit normal (true or shaded)
    double depth = 0.0;       ///< d: distance of the HIP from the proxy, workspace m
    glm::dvec3 textured{0.0}; ///< m: unit normal with the texture's tilt
    double height = 0.0;      ///< H >= 0, workspace m
    bool hasHeight = false;   ///< H shortens the depth along n (texture=law); else only m turns the force
    double lengthening = 1.0; ///< of the force along m; texture=minsky: 1 / (n . m), which leaves k d along n
    double bump = 0.0; ///< texture=blinnMagnitude: what the bump map adds to d, workspace m, either sign
    bool tiltCompressed = false;
    double stiffness = 0.0; ///< N/m
    double damping = 0.0;   ///< N·s/m
    double staticFriction = 0.0, dynamicFriction = 0.0, viscousFriction = 0.0;
    /// A haptic program ran: what it adds to the elastic force of the surface with its stiffness, N
    /// (surface/program_surface.h).
    bool programmed = false;
    glm::dvec3 programForce{0.0};
    /// Local deformation: `depth` is already less by it, workspace m; the dent's slope adds to the force.
    double dent = 0.0;
    glm::dvec3 dentSlope{0.0}; ///< gradient of the dent's depth along the surface, 1
    bool coulomb = false;      ///< the coefficients are specified, though a map may make them zero here
};

/// Reads material, vertex attributes and maps at one contact. `normal` and `depth` are those felt there,
/// `limits` those of the hand's device. With textureFilter=mip `speed` (m/s along the surface) and `dt`
/// choose the level, which leaves out what would alias at the servo rate.
[[nodiscard]] SurfaceSample readSurface(const HapticScene& scene, ObjectMotions motions,
                                        const HapticSettings& settings, const DeviceLimits& limits,
                                        int reference, const Contact& contact, const glm::dvec3& normal,
                                        double depth, double speed, double dt) noexcept;

} // namespace touchstone
