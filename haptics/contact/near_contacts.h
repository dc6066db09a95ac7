#pragma once
// Queries of the proxy solver about everything near it: triangles of meshes and other shapes alike. Reference
// frame, object units.

#include "haptics/contact/candidates.h"
#include "haptics/shape/contact.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>

namespace touchstone {

/// Writes the contacts of a ball of `radius` at p within `within` of it, planes that are equal to the last
/// bits once; returns their number. `full` becomes true where `found` has no room for all.
[[nodiscard]] uint32_t findContacts(CandidateCache& cache, const glm::dvec3& p, double radius, double within,
                                    std::span<Contact> found, bool& full) noexcept;

/// Of the contacts that findContacts gives, however many, the one whose plane (planeOffset) a move to p +
/// `to` breaks most; none where it breaks no plane by more than `tolerance`. `all` becomes false where a
/// shape has more features than it can tell.
[[nodiscard]] std::optional<Contact> mostBroken(CandidateCache& cache, const glm::dvec3& p, double radius,
                                                double within, const glm::dvec3& to, double tolerance,
                                                bool& all) noexcept;

/// The minimum distance from p of the features that a proxy of `radius` does not ignore
/// (CandidateCache::passes), within `reach` of p; INFINITY where there is none. The ball of the cache covers
/// p.
[[nodiscard]] double nearestDistance(CandidateCache& cache, const glm::dvec3& p, double reach,
                                     double radius) noexcept;

/// The distance of a contact's feature from p; INFINITY where the cache no longer contains it.
[[nodiscard]] double distanceOf(CandidateCache& cache, const Contact& contact, const glm::dvec3& p) noexcept;

/// Moves a contact on a facet to where a ball of `radius` at `place` touches it. False, and nothing changed,
/// where that facet does not hold the ball there with its face.
[[nodiscard]] bool moveOnFacet(CandidateCache& cache, const glm::dvec3& place, double radius,
                               Contact& contact) noexcept;

/// The path of a ball around the rounded edge or corner of one triangle: straight to `corner`, then to `end`.
struct RollOver {
    glm::dvec3 corner{0.0}, end{0.0};
};
/// Around a rounded edge or corner whose axis is a distance e from the goal, slides and drops creep: each
/// turns the proxy by e / radius of the remaining angle. But a rounded triangle is convex, and the goal's
/// shortest exit from it is the proxy's resting place on it. The path there leads over a place on both
/// tangent planes, which never enter a convex body. `start`: where the ball touches the triangle of
/// `contact`; `reach`: its radius and the gap. Empty where the end is not nearer to the goal, or the feature
/// is no triangle.
[[nodiscard]] std::optional<RollOver> rollOver(CandidateCache& cache, const Contact& contact,
                                               const glm::dvec3& start, const glm::dvec3& goal,
                                               double reach) noexcept;

} // namespace touchstone
