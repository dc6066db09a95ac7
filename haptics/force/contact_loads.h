#pragma once
// Where several planes hold the HIP off: the load of each contact, and the resulting force.

#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/solve/solve_result.h"
#include "haptics/surface/surface_sample.h"

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

struct ProgramRun; // haptics/surface/program_surface.h
struct DentPress;  // haptics/surface/press_dents.h

/// One active plane's part in p - h = sum lambda_i n_i (p: proxy without friction, h: HIP). Reference frame,
/// workspace m.
struct ContactLoad {
    glm::dvec3 surface{0.0}; ///< unit normal of the true plane
    glm::dvec3 plane{0.0}; ///< n_i: unit normal of the plane of the solve; interpolated with two-pass shading
    double length = 0.0;   ///< lambda_i >= 0
    /// Depth of the HIP below the plane, n_i . (p - h), along feel.normal; with `projected` both this and
    /// feel.depth are longer.
    double depth = 0.0;
    /// Its `normal` is the one felt (turned by `direction` or `projected`), its `depth` is lambda_i along it.
    /// Stiffness, damping and viscous term are those that the device can bear at this zoom.
    SurfaceSample feel;
};

/// The elastic force is
///     F = K (p - h) + beta sum (f_i - K lambda_i n_i),   f_i = k_i lambda_i (n_i + t_i (m_i - n_i)),
/// with t_i = min(1, H_i / max(d_i, lambda_i)): the displacement law of spring_damper.h at the HIP's depth
/// d_i below the plane, times the plane's fraction lambda_i / d_i of it; where walls meet at less than a
/// right angle (d_i < lambda_i), the whole law at the depth lambda_i. For one plane it is that law; at right
/// angles each plane contributes its whole bump height; almost parallel planes share one. Where all k_i are
/// equal and nothing is textured or turned F = k (p - h), also where a solve ended before its rest. K = sum
/// k_i lambda_i / sum lambda_i. F is continuous in h wherever p, the normals and the samples are, since f_i
/// vanishes with lambda_i.
///
/// Two walls that almost oppose each other carry loads far beyond the resultant (lambda = 1 / (2 sin(a / 2))
/// times it in a groove of angle a); beta = min(1, kMaxLoad |p - h| / sum lambda_i) bounds the effect of a
/// difference of their stiffness and of friction on them. It is 1 where the smallest singular value of the
/// normals is 0.1: sum lambda_i <= sqrt(3) |p - h| / 0.1.
struct ContactLoads {
    int count = 0; ///< at least 2 where these are used
    std::array<ContactLoad, 3> contacts;
    glm::dvec3 offset{0.0}; ///< p - h, m
    double stiffness = 0.0; ///< K, N/m
    double bounding = 1.0;  ///< beta
    int loaded = 0;         ///< the contact with the largest k_i lambda_i
};

/// Bound of sum lambda_i over |p - h|, beyond which beta scales the loads down.
inline constexpr double kMaxLoad = 20.0;

/// Reads the surface under every active plane of `hold`; with `twoPass` these are shadedPlanes. `offset`: p -
/// h, reference object units. `velocity` of the HIP relative to the surface, m/s, reference object frame.
/// `zoom` as in bearableShare, which limits each contact's stiffness separately: a stiffer plane that joins
/// without load changes nothing. `programs`: null where no program runs; `dents`:
/// where nothing gives way.
void readLoads(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
               const DeviceLimits& limits, int reference, const SolveResult& rest, const SubGoal& activeSet,
               bool twoPass, const glm::dvec3& offset, double workspacePerReference,
               const glm::dvec3& velocity, double zoom, double dt, ProgramRun* programs, DentPress* dents,
               ContactLoads& loads) noexcept;

/// F above, N, reference object frame.
[[nodiscard]] glm::dvec3 elasticForce(const ContactLoads& loads) noexcept;

/// The force of each contact, whose sum is the whole force. Reference object frame. Contact i bears
///     K lambda_i n_i + beta (f_i - K lambda_i n_i)
/// of F above (they sum to F, since p - h = sum lambda_i n_i), its own damping, and the part mu_i N_i / sum
/// mu_j N_j of everything else: friction, and what a solve that ended early leaves between p - h and the sum.
/// Without a coefficient of friction that part is N_i / sum N_j.
struct ContactForces {
    size_t count = 0;                ///< of valid entries; the others are not initialised
    std::array<glm::dvec3, 3> force; ///< N
    std::array<glm::dvec3, 3> point; ///< on the surface, reference object units
    std::array<int, 3> object;       ///< HapticScene::objects
    std::array<double, 3> load;      ///< N_i, N; at least 0
    std::array<double, 3> grip;      ///< mu_i N_i, N; at least 0

    /// The rest of the force `whole` (N).
    void complete(const glm::dvec3& whole) noexcept;
};

/// Elastic force and damping of every contact; `grip` of static friction.
void splitForces(const ContactLoads& loads, const glm::dvec3& velocity, ContactForces& forces) noexcept;

/// The plane's fraction of the load that almost parallel planes share: lambda_i / d_i, at most 1.
[[nodiscard]] inline double partOf(const ContactLoad& contact) noexcept {
    return contact.depth > contact.feel.depth ? contact.feel.depth / contact.depth : 1.0;
}

/// Damping of every contact along its normal, N: -c_i min(1, lambda_i / d_i) (v . n_i) n_i, and no contact
/// pulls. Almost parallel planes share one damper.
[[nodiscard]] glm::dvec3 dampingForce(const ContactLoads& loads, const glm::dvec3& velocity) noexcept;

} // namespace touchstone
