#pragma once

#include "engine/scene/scene.h"

#include <glm/glm.hpp>

#include <optional>

namespace touchstone {

/// A vertex nearer to a clipping plane than this fraction of its mesh's diagonal lies on the plane: the cut
/// makes no triangle that is smaller than what welding merges.
inline constexpr double kClipTolerance = 1e-6;

/// The part of a mesh's triangles where dot(plane, (p, 1)) <= 0, with the attributes of its vertices; lines
/// and points are left out. nullopt: the plane cuts nothing off any triangle. The cut is open: no triangle
/// closes it. `plane` (mesh frame) gives the distance in any unit, `tolerance` in the same one. Two triangles
/// with a common edge are cut at one place, also where a seam gives each its own vertices. No vertex is
/// moved.
[[nodiscard]] std::optional<Mesh> clippedMesh(const Mesh& mesh, const glm::dvec4& plane, double tolerance);

/// `tolerance` for a mesh: kClipTolerance of its diagonal in the scene.
[[nodiscard]] double clipTolerance(const Mesh& mesh, const glm::dmat4& sceneFromMesh);

} // namespace touchstone
