#include "haptics/world/mesh_interval.h"

#include <algorithm>

namespace touchstone {

void MeshInterval::fit(std::span<const glm::vec3> from, std::span<const glm::vec3> to,
                       std::span<const uint32_t> indices) noexcept {
    longest = radius = 0.0;
    for (size_t v = 0; v < from.size(); ++v) {
        const glm::dvec3 a(from[v]), z(to[v]);
        longest = std::max(longest, glm::distance(a, z));
        radius = std::max({radius, glm::length(a), glm::length(z)});
    }
    tree.refit(from, to, indices);
}

void MovedMesh::step(HapticScene& scene, const MeshMoment& before, const MeshMoment& now, double travel,
                     bool moves) noexcept {
    instant.now = now.places;
    instant.before = before.places;
    instant.normals = now.normals;
    instant.tree = &now.interval->tree;
    instant.travel = moves ? travel * (1.0 + 1e-12) + 1e-15 : 0.0; // blends round
    own->instant = &instant;
    own->boundingRadius = scene.boundingRadii[object] =
        std::max(now.interval->radius, before.interval->radius) * (1.0 + 1e-12);
}

} // namespace touchstone
