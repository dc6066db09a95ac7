#pragma once
// Distance fields of closed forms, each alone in a scene.

#include "haptics/scene/shape_object.h"
#include "haptics/shape/field/field_shape.h"
#include "tests/support/corner.h"
#include "tests/support/touch_bench.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>

namespace touchstone::test {

using Distance = std::function<double(const glm::dvec3&)>;

/// A cube of 1.2 about the origin, `cells` a side; object units.
inline FieldLayout cubeOf(int cells) {
    return {.origin = glm::dvec3(-0.6), .voxel = 1.2 / cells, .cells = glm::ivec3(cells)};
}

inline std::shared_ptr<const FieldGrid> gridOf(const Distance& distance, int cells) {
    return std::make_shared<FieldGrid>(gridOfDistance(cubeOf(cells), 0.2, 0.1, distance));
}
inline std::shared_ptr<const FieldShape> fieldOf(const Distance& distance, int cells) {
    return std::make_shared<FieldShape>(gridOf(distance, cells));
}

inline double ball(const glm::dvec3& p) {
    return glm::length(p) - 0.4;
}
inline double torus(const glm::dvec3& p) {
    return std::hypot(std::hypot(p.x, p.y) - 0.3, p.z) - 0.12;
}
inline double box(const glm::dvec3& p, const glm::dvec3& half) {
    const glm::dvec3 q = glm::abs(p) - half;
    return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}
inline double block(const glm::dvec3& p) {
    return box(p, glm::dvec3(0.4));
}

/// Alone in a scene: the corner's floor lies far below.
struct FieldBench : TouchBench {
    explicit FieldBench(const std::shared_ptr<const Shape>& shape, double scale = 0.15,
                        const Wall& material = {.normal = {0, 1, 0}, .stiffness = 600.0})
        : TouchBench(cornerScene({material}), cornerSettings()) {
        settings.proxyRadius = 0.0;
        const std::shared_ptr<HapticScene> both = copyOf(*scene);
        addShape(*both, "field", shape, 0, Similarity{scale, {1, 0, 0, 0}, kMiddle});
        scene = both;
    }
    static constexpr glm::dvec3 kMiddle{0.0, 0.5, 0.0};
};

} // namespace touchstone::test
