#include "haptics/shape/mesh/mesh_adjacency.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// A triangle at an edge.
struct Wing {
    uint64_t edge;   // lower vertex << 32 | upper vertex
    uint32_t corner; // 3 * triangle + edge of that triangle
    bool forward;    // its winding runs from the lower to the upper vertex
};

/// Angle of the wing about the edge, which runs from lower to upper vertex.
double wingAngle(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices, const Wing& wing,
                 const glm::dvec3& zero, const glm::dvec3& quarter) {
    const uint32_t first = wing.corner - wing.corner % 3;
    const glm::dvec3 lower(vertices[wing.edge >> 32]);
    const glm::dvec3 third = glm::dvec3(vertices[indices[first + (wing.corner + 2) % 3]]) - lower;
    return std::atan2(glm::dot(third, quarter), glm::dot(third, zero));
}

/// Sorts the wings of one edge by their angle about it.
void sortAround(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices,
                std::span<Wing> wings) {
    const glm::dvec3 along =
        glm::dvec3(vertices[wings[0].edge & 0xffffffffu]) - glm::dvec3(vertices[wings[0].edge >> 32]);
    const glm::dvec3 helper =
        std::abs(along.x) < std::abs(along.y) ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 zero = glm::cross(along, helper);
    if (!(glm::dot(zero, zero) > 0.0))
        return; // an edge of zero length: any order will do
    const glm::dvec3 unit = glm::normalize(zero);
    const glm::dvec3 quarter = glm::cross(glm::normalize(along), unit);
    std::stable_sort(wings.begin(), wings.end(), [&](const Wing& a, const Wing& b) {
        return wingAngle(vertices, indices, a, unit, quarter) <
               wingAngle(vertices, indices, b, unit, quarter);
    });
}

} // namespace

MeshAdjacency::MeshAdjacency(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices) {
    std::vector<Wing> wings;
    wings.reserve(indices.size());
    across_.resize(2 * indices.size());
    for (size_t first = 0; first + 2 < indices.size(); first += 3) {
        const auto triangle = static_cast<uint32_t>(first / 3);
        const uint32_t* i = &indices[first];
        const bool collapsed = i[0] == i[1] || i[1] == i[2] || i[2] == i[0];
        for (uint32_t k = 0; k < 3; ++k) {
            across_[6 * triangle + k] = 2 * triangle + 1;
            across_[6 * triangle + 3 + k] = 2 * triangle;
            const uint64_t a = i[k], b = i[(k + 1) % 3];
            if (!collapsed)
                wings.push_back(
                    {std::min(a, b) << 32 | std::max(a, b), static_cast<uint32_t>(first) + k, a < b});
        }
    }
    std::sort(wings.begin(), wings.end(), [](const Wing& a, const Wing& b) {
        return a.edge != b.edge ? a.edge < b.edge : a.corner < b.corner;
    });
    for (size_t begin = 0; begin < wings.size();) {
        size_t end = begin;
        while (end < wings.size() && wings[end].edge == wings[begin].edge)
            ++end;
        const size_t count = end - begin;
        ++edges_;
        borderEdges_ += count == 1 ? 1 : 0;
        nonManifoldEdges_ += count > 2 ? 1 : 0;
        if (count > 2)
            sortAround(vertices, indices, {&wings[begin], count});
        // A turn away from a wing leaves it on the side that its winding faces if the winding runs with the
        // edge, and meets the next one from the other side.
        for (size_t w = begin; w < end; ++w) {
            const Wing &from = wings[w], &to = wings[w + 1 < end ? w + 1 : begin];
            const TriangleSide leaving = 2 * (from.corner / 3) + (from.forward ? 0 : 1);
            const TriangleSide arriving = 2 * (to.corner / 3) + (to.forward ? 1 : 0);
            across_[3 * static_cast<size_t>(leaving) + from.corner % 3] = arriving;
            across_[3 * static_cast<size_t>(arriving) + to.corner % 3] = leaving;
        }
        begin = end;
    }
}

} // namespace touchstone
