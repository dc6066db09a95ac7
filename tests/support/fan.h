#pragma once
// Many facets about one vertex.

#include "assets/shapes.h"

#include <cmath>
#include <cstdint>
#include <numbers>

namespace touchstone::test {

/// Facets that all meet at (0, apex, 0), in a ring of radius `rim` in the plane y = `ring`, m; they face +y.
inline assets::Shape fan(uint32_t facets, double rim, double apex, double ring) {
    assets::Shape shape;
    shape.positions.emplace_back(glm::dvec3(0.0, apex, 0.0));
    for (uint32_t i = 0; i < facets; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / facets;
        shape.positions.emplace_back(glm::dvec3(rim * std::cos(angle), ring, rim * std::sin(angle)));
        shape.indices.insert(shape.indices.end(), {0u, 1 + (i + 1) % facets, 1 + i});
    }
    return shape;
}

} // namespace touchstone::test
