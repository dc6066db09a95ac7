#pragma once
// How far places, and the surface of a field, are from a mesh.

#include "engine/volume/volume_mesh.h"
#include "haptics/shape/field/field_grid.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace touchstone::test {

/// C. Ericson, *Real-Time Collision Detection*, section 5.1.5, by clamping in turn.
inline double distanceFromTriangle(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b,
                                   const glm::dvec3& c) {
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const auto beside = [&](const glm::dvec3& from, const glm::dvec3& to) {
        return glm::dot(glm::cross(to - from, p - from), normal) < 0.0;
    };
    if (glm::dot(normal, normal) > 0.0 && !beside(a, b) && !beside(b, c) && !beside(c, a))
        return std::abs(glm::dot(p - a, normal)) / glm::length(normal);
    double nearest = INFINITY;
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
        const glm::dvec3 way = to - from;
        const double squared = glm::dot(way, way);
        const double t = squared > 0.0 ? std::clamp(glm::dot(p - from, way) / squared, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::distance(p, from + t * way));
    }
    return nearest;
}

class MeshDistance {
  public:
    /// Distances up to `reach` are found.
    MeshDistance(const SurfaceMesh& mesh, double reach) : mesh_(mesh), reach_(reach) {
        for (size_t i = 0; i + 2 < mesh.corners.size(); i += 3) {
            const glm::dvec3 a = corner(i), b = corner(i + 1), c = corner(i + 2);
            const auto low = boxOf(glm::min(a, glm::min(b, c)) - reach),
                       high = boxOf(glm::max(a, glm::max(b, c)) + reach);
            for (int z = low[2]; z <= high[2]; ++z)
                for (int y = low[1]; y <= high[1]; ++y)
                    for (int x = low[0]; x <= high[0]; ++x)
                        boxes_[{x, y, z}].push_back(i);
        }
    }
    /// INFINITY beyond the reach, where the boxes hold nothing nearer.
    [[nodiscard]] double operator()(const glm::dvec3& place) const {
        const auto found = boxes_.find(boxOf(place));
        double nearest = INFINITY;
        if (found != boxes_.end())
            for (const size_t i : found->second)
                nearest =
                    std::min(nearest, distanceFromTriangle(place, corner(i), corner(i + 1), corner(i + 2)));
        return nearest;
    }

  private:
    using Box = std::array<int, 3>;
    [[nodiscard]] Box boxOf(const glm::dvec3& place) const {
        const glm::ivec3 box(glm::floor(place / (4.0 * reach_)));
        return {box.x, box.y, box.z};
    }
    [[nodiscard]] glm::dvec3 corner(size_t i) const { return glm::dvec3(mesh_.positions[mesh_.corners[i]]); }

    const SurfaceMesh& mesh_;
    double reach_;
    std::map<Box, std::vector<size_t>> boxes_;
};

/// Places where a field's surface crosses the edges of its grid.
struct Crossings {
    size_t count = 0;
    double worst = 0.0; ///< voxels from the mesh
};
inline Crossings crossingsOf(const FieldGrid& grid, const SurfaceMesh& mesh) {
    const FieldLayout& layout = grid.layout();
    const MeshDistance distance(mesh, layout.voxel);
    Crossings crossings;
    for (int z = 0; z < layout.cells.z; ++z)
        for (int y = 0; y < layout.cells.y; ++y)
            for (int x = 0; x < layout.cells.x; ++x) {
                const double f = grid.node({x, y, z});
                for (int axis = 0; axis < 3; ++axis) {
                    glm::ivec3 next(x, y, z);
                    ++next[axis];
                    const double g = grid.node(next);
                    if ((f < 0.0) == (g < 0.0))
                        continue;
                    glm::dvec3 place(x, y, z);
                    place[axis] += f / (f - g);
                    ++crossings.count;
                    crossings.worst = std::max(crossings.worst,
                                               distance(layout.origin + layout.voxel * place) / layout.voxel);
                }
            }
    return crossings;
}

} // namespace touchstone::test
