#pragma once
// The triangles along a path, in a tree: what a hand on that path can meet.

#include "devices/surface/triangle_source.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

class NearTriangles {
  public:
    /// Those within `reach` m of any of `points` (and some that are a little farther). One pass through all
    /// triangles. Neighbouring points must be at most about `reach` apart.
    NearTriangles(const TriangleSource& triangles, std::span<const glm::dvec3> points, double reach);

    /// Calls `visit` with every triangle whose box overlaps the box of the segment from `from` to `to`.
    template <class Visit>
    void along(const glm::dvec3& from, const glm::dvec3& to, Visit visit) const {
        const glm::dvec3 low = glm::min(from, to) - slack_, high = glm::max(from, to) + slack_;
        const auto meets = [&](const glm::dvec3& l, const glm::dvec3& h) {
            return l.x <= high.x && h.x >= low.x && l.y <= high.y && h.y >= low.y && l.z <= high.z &&
                   h.z >= low.z;
        };
        // Depth first; a node's first child follows it, so the index after a leaf is the next node.
        for (uint32_t at = 0; at < nodes_.size();) {
            const Node& node = nodes_[at];
            if (!meets(node.low, node.high)) {
                at = node.next;
                continue;
            }
            for (uint32_t i = node.first; i < node.last; ++i)
                visit(triangles_[i]);
            ++at;
        }
    }
    [[nodiscard]] bool empty() const { return triangles_.empty(); }

  private:
    struct Node {
        glm::dvec3 low{0.0}, high{0.0};
        uint32_t first = 0, last = 0; ///< triangles of a leaf; else none
        uint32_t next = 0;            ///< the node after its whole subtree
    };
    struct Item {
        glm::vec3 middle;
        uint32_t triangle;
    };
    void build(std::span<Item> items);

    /// Ordered by the leaves once the tree is built.

    std::vector<SurfaceTriangle> triangles_;
    std::vector<Node> nodes_;
    size_t built_ = 0;   ///< triangles in the leaves so far
    double slack_ = 0.0; ///< m
};

} // namespace touchstone
