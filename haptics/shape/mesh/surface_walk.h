#pragma once
// Descent over a surface from feature to feature: the work of the neighbourhood watch in a tick.

#include "haptics/shape/mesh/haptic_object.h"
#include "haptics/shape/mesh/mesh_adjacency.h"
#include "haptics/shape/mesh/triangle.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

/// A surface to walk on; the object's frame and units throughout.
struct SurfaceView {
    const HapticObject& object;
    const MeshAdjacency& adjacency;

    [[nodiscard]] Triangle triangle(TriangleSide side) const;
    /// The triangle's unit normal on that side; zero where it has none.
    [[nodiscard]] glm::dvec3 normal(TriangleSide side) const;
};

enum class Feature : uint8_t { Face, Edge, Vertex };

/// The point of a surface that a walk has reached.
struct SurfacePlace {
    TriangleSide side = 0;
    Feature feature = Feature::Face;
    uint32_t index = 0; ///< of the triangle's edges (from corner `index`) or corners
    glm::dvec3 point{0.0};
    double squared = 0.0; ///< distance to the walk's goal, squared
};

/// The remaining budget of a tick. No walk takes longer, whatever the mesh.
struct WalkBudget {
    static constexpr uint32_t kMaxTests = 8192; ///< triangles tested in a tick: 0.1 ms

    uint32_t steps = 0; ///< from one feature to the next
    uint32_t tests = kMaxTests;
    bool spent = false; ///< the budget ended before the work
};

/// The point of one triangle nearest to `goal`.
[[nodiscard]] SurfacePlace nearestOnTriangle(const SurfaceView& surface, TriangleSide side,
                                             const glm::dvec3& goal) noexcept;

/// Walks from `start` to the neighbour nearest to `goal`, and on for as long as the distance falls: over an
/// edge to the triangle beyond it on the same side of the surface, at a vertex to the nearest of its
/// triangles on the same side. Ends in a local minimum of the distance, or where the budget ends.
[[nodiscard]] SurfacePlace walkTowards(const SurfaceView& surface, TriangleSide start, const glm::dvec3& goal,
                                       WalkBudget& budget) noexcept;

/// True when `point`, to which `place` is nearest, is on the side of the surface of `place.side`, so that the
/// straight path to it is open: above the face; at an edge, in the sector between its two triangles; at a
/// vertex, outside by the angle-weighted normal (Baerentzen and Aanaes 2005). Always true past an open
/// border.
[[nodiscard]] bool isOnFreeSide(const SurfaceView& surface, const SurfacePlace& place,
                                const glm::dvec3& point, WalkBudget& budget) noexcept;

} // namespace touchstone
