#pragma once
// The friction that the contacts can bear: the sum of their cones, less the viscous term.

#include "haptics/force/contact_loads.h"
#include "haptics/surface/surface_sample.h"

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// The friction limit of one tick. With contacts of normal load N_i = beta k_i lambda_i the friction along a
/// unit vector u is at most
///     mu N (u) = sum mu_i N_i |u - (u . n_i) n_i|   (n_i: of the true planes),
/// the extent along u of the sum of the contacts' friction disks: all of sum mu_i N_i along the directions
/// that the planes leave free, and continuous where a plane joins, since N_i then is 0.
///
/// The viscous term takes its part first ([001] eq. 4.6: the total stays at mu N): V_i = min(c_i v_i min(1,
/// lambda_i / d_i), mu_d,i N_i) against the velocity along contact i; almost parallel planes share one term.
/// The stiction point bears the rest, max(0, mu N - sum V_i). A material without a friction coefficient has
/// no cone: its viscous term is c v.
class FrictionCone {
  public:
    FrictionCone() = default; ///< nothing is touched
    /// `velocity` of the HIP relative to the surface, m/s; `workspacePerReference` m per reference object
    /// unit.
    FrictionCone(const SurfaceSample& feel, const glm::dvec3& velocity,
                 double workspacePerReference) noexcept;
    FrictionCone(const ContactLoads& loads, const glm::dvec3& velocity,
                 double workspacePerReference) noexcept;

    /// The limit along a given stretch, as the law reads it. Lengths in reference object units.
    struct Limit {
        double depth = 0.0; ///< N / K
        double staticFriction = 0.0, dynamicFriction = 0.0;
    };
    [[nodiscard]] Limit along(const glm::dvec3& stretch) const noexcept;

    [[nodiscard]] bool several() const noexcept { return count_ > 1; } ///< the limit depends on the direction
    [[nodiscard]] bool rough() const noexcept { return rough_; }       ///< some mu_s is above 0
    [[nodiscard]] double stiffness() const noexcept { return stiffness_; } ///< K, N/m, of the stretch
    [[nodiscard]] const glm::dvec3& viscousForce() const noexcept {
        return viscousForce_;
    } ///< N, reference object frame
    [[nodiscard]] const glm::dvec3& down() const noexcept {
        return down_;
    } ///< h - p, reference object units; of one contact along its felt normal
    [[nodiscard]] double workspacePerReference() const noexcept { return workspacePerReference_; }

  private:
    struct Disk {
        glm::dvec3 normal{0.0};
        double load = 0.0; ///< N_i, N
        double staticFriction = 0.0, dynamicFriction = 0.0;
    };
    void addViscous(const SurfaceSample& feel, const glm::dvec3& normal, double load, double part,
                    const glm::dvec3& velocity) noexcept;

    std::array<Disk, 3> disks_;
    int count_ = 0;
    Limit single_; ///< of one contact, whatever the direction
    bool rough_ = false;
    double stiffness_ = 0.0, workspacePerReference_ = 1.0;
    double viscous_ = 0.0; ///< sum V_i of the contacts that have a cone, N
    glm::dvec3 viscousForce_{0.0}, down_{0.0};
};

} // namespace touchstone
