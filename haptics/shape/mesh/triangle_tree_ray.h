#pragma once
// TriangleTree::walkRay.

#include "haptics/shape/mesh/triangle_tree.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace detail {

/// A ray in floats, prepared for box tests.
struct BoxRay {
    glm::vec3 from, perDirection;

    BoxRay(const glm::dvec3& start, const glm::dvec3& direction) : from(start) {
        for (glm::length_t k = 0; k < 3; ++k) {
            // Keeps every box from being parallel to a ray: 0 * infinity would be NaN.
            constexpr float kMin = 1e-20f;
            const auto d = static_cast<float>(direction[k]);
            perDirection[k] = 1.0f / (std::abs(d) < kMin ? std::copysign(kMin, d) : d);
        }
    }
    /// True if it meets the box within 0..end, and for some boxes that it misses by less than `kMargin`.
    [[nodiscard]] bool meets(const glm::vec3& low, const glm::vec3& high, float end) const noexcept {
        // Above float rounding in the coordinates and the quotients, for coordinates of magnitude one.
        constexpr float kMargin = 4e-6f;
        float enter = 0.0f, leave = end;
        for (glm::length_t k = 0; k < 3; ++k) {
            const float a = (low[k] - kMargin - from[k]) * perDirection[k],
                        b = (high[k] + kMargin - from[k]) * perDirection[k];
            enter = std::max(enter, std::min(a, b));
            leave = std::min(leave, std::max(a, b));
        }
        return enter <= leave;
    }
};

} // namespace detail

template <class Visit>
void TriangleTree::walkRay(const glm::dvec3& start, const glm::dvec3& direction, const double& end,
                           const Visit& visit) const noexcept {
    if (nodes_.empty())
        return;
    const detail::BoxRay ray(start, direction);
    // Upwards by more than float rounding, so that a hit at `end` itself is still found.
    const auto farthest = [&] { return static_cast<float>(end * (1.0 + 1e-6)) + 1e-6f; };
    std::array<uint32_t, kMaxDepth * kWidth> stack;
    size_t waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
        const uint32_t next = stack[--waiting];
        const float far = farthest();
        if ((next & kLeafBit) != 0) {
            const Leaf& leaf = leaves_[next & ~kLeafBit];
            for (size_t i = 0; i < leaf.count; ++i) {
                const auto corner = [&](const std::array<std::array<uint8_t, kLeafSize>, 3>& side) {
                    return leaf.origin + leaf.step * glm::vec3(side[0][i], side[1][i], side[2][i]);
                };
                if (ray.meets(corner(leaf.low), corner(leaf.high), far) && !visit(leaf.triangle[i]))
                    return;
            }
            continue;
        }
        const Node& node = nodes_[next];
        for (size_t i = 0; i < kWidth; ++i)
            // An unused child's box is inverted.
            if (node.low[0][i] <= node.high[0][i] &&
                ray.meets({node.low[0][i], node.low[1][i], node.low[2][i]},
                          {node.high[0][i], node.high[1][i], node.high[2][i]}, far))
                stack[waiting++] = node.child[i];
    }
}

} // namespace touchstone
