#pragma once

#include "haptics/body/contact_finder.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <span>

namespace touchstone::body {

/// Volume (m^3), its centre, and its second moment about the origin: the integral of p p^T, m^5.
struct VolumeMoments {
    double volume = 0.0;
    glm::dvec3 first{0.0}; ///< m^4, volume times centre
    glm::dmat3 second{0.0};

    VolumeMoments& operator+=(const VolumeMoments& other);
    /// In the frame to which `pose` leads.
    [[nodiscard]] VolumeMoments in(const Pose& pose) const;
};

/// Of what a closed surface encloses, counter-clockwise seen from outside.
[[nodiscard]] VolumeMoments momentsOf(std::span<const glm::dvec3> points, std::span<const uint32_t> indices);
/// Of a collider, in its frame. Of a hull or a mesh the volume of its triangles, or where they enclose none
/// that of their box.
[[nodiscard]] VolumeMoments momentsOf(const ColliderForm& form, std::span<const uint32_t> triangles);

/// Inertia of a unit of density about the centre from the moments, kg m^2.
[[nodiscard]] glm::dmat3 inertiaOf(const VolumeMoments& moments);

/// The eigenvalues of a symmetric matrix and the rotation of its axes (Jacobi).
struct PrincipalAxes {
    glm::dvec3 values{0.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
};
[[nodiscard]] PrincipalAxes principalAxes(const glm::dmat3& matrix);

} // namespace touchstone::body
