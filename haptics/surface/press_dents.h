#pragma once
// Stage 5, local deformation [000]: a contact presses a dent into a surface that gives way.
//
// A dent of depth d and centre c lowers the surface by d phi(|p - c| / R) at a place p, with phi the
// material's polynomial (engine/scene/local_deformation.h). A contact whose HIP is `delta` below the surface
// at rest, over which D = sum d_i phi_i, is pushed by
//     F = k (delta - D) (n + grad D)   where delta > D,
// the gradient of the energy k (delta - D)^2 / 2: at rest in a dent's centre F = k k' / (k + k') delta, k'
// the ground's stiffness. The ground is a spring and a damper,
//     tau d_i' = N phi_i / k' - d_i,   N = k (delta - D),
// stepped implicitly, so that tau = 0 is its limit. The nearest dent moves towards the contact as fast as it
// relaxes, and at least so fast that it is a quarter of its radius behind; where the contact is outside of
// all a new one begins, at which all others have phi = 0: D is continuous. Energy k' d_i^2 / 2 is stored, and
// both laws only lose it.

#include "haptics/scene/haptic_scene.h"
#include "haptics/solve/solve_result.h"
#include "haptics/state/dents.h"
#include "haptics/surface/surface_sample.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

/// Of one hand in one tick.
struct DentPress {
    Dents& dents;
    double maxForce = 0.0; ///< N, that the device can exert: a dent is pressed by no more
    double dt = 1e-3;      ///< s
    uint32_t pressed = 0;  ///< bits: these have had their step
    glm::dvec3 shift{0.0}; ///< sum of the contacts' displacements of the surface, workspace m
};

/// Presses the dents at a contact that `feel` (readSurface) describes; its depth becomes that below the
/// dented surface, and its dentSlope the gradient. `speed` of the HIP along the surface, m/s. Nothing where
/// the material does not give way.
void pressDents(const HapticScene& scene, ObjectMotions motions, int reference, const Contact& contact,
                double speed, DentPress& press, SurfaceSample& feel) noexcept;

/// The step of the dents that are not in `pressed`: they relax.
void relaxDents(const HapticScene& scene, double dt, uint32_t pressed, Dents& dents) noexcept;

} // namespace touchstone
