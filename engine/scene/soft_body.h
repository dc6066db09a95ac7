#pragma once
// What makes a mesh a soft body (extension TOUCHSTONE_soft_body of a node, docs/deforming.md).

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace touchstone {

enum class SoftKind : uint8_t {
    Cloth, ///< a sheet: keeps the lengths of its edges
    Jelly  ///< a closed surface: keeps its volume and comes back to its shape
};

/// All numbers are finite and in their ranges. SI, lengths in model m.
struct SoftBody {
    SoftKind kind = SoftKind::Jelly;
    double mass = 0.05;           ///< kg, > 0: of all vertices that are not held
    double stretch = 0.5;         ///< 0..1: share of an edge's change of length that a step takes back
    double shapeFrequency = 0.0;  ///< Hz: of a vertex about its place in the shape at rest; 0: free
    double volumeStiffness = 0.0; ///< Pa: pressure for a volume halved to none; 0: free
    double damping = 10.0;        ///< 1/s: at which all motion decays
    double friction = 0.3;        ///< 0..1, on what it lies on
    double thickness = 1e-3;      ///< m, of the gap that it keeps from what it lies on
    double touchRadius = 6e-3;    ///< m, over which a hand's force spreads
    double breath = 0.0;          ///< share of the volume, 0..0.5, by which it swells and shrinks
    double breathTime = 4.0;      ///< s, of one breath
    /// m, scene: vertices in this box are held where they are.
    std::optional<glm::dvec3> fixedLow, fixedHigh;
    std::vector<int> over; ///< Scene::instances that it lies on, by the convex hull of each
};

/// Vertices of a soft body: their forces and neighbours are worked through 250 times in a second.
inline constexpr size_t kMaxSoftVertices = 4096;
/// Soft bodies of a scene.
inline constexpr size_t kMaxSoftBodies = 8;

} // namespace touchstone
