#include "tests/property/hard_shapes.h"

#include <glm/gtc/constants.hpp>

#include <cmath>
#include <random>

namespace touchstone::test {

namespace {

/// A grid of cells * cells squares over 0.1 m, whose vertices `height` lifts.
template <class Height>
assets::Shape terrain(uint32_t cells, Height height) {
    assets::Shape shape;
    const double cell = 0.1 / cells;
    for (uint32_t j = 0; j <= cells; ++j)
        for (uint32_t i = 0; i <= cells; ++i)
            shape.positions.emplace_back(glm::dvec3(cell * i, cell * j, height(i, j)));
    for (uint32_t j = 0; j < cells; ++j)
        for (uint32_t i = 0; i < cells; ++i) {
            const uint32_t a = j * (cells + 1) + i, b = a + 1, c = a + cells + 1, d = c + 1;
            for (const uint32_t index : {a, b, d, a, d, c})
                shape.indices.push_back(index);
        }
    return shape;
}

/// A fan of `sides` triangles around an apex at `height`, in a ring of radius 0.05 m; jittered, so that no
/// two facets are mirror images.
assets::Shape fan(uint32_t sides, double height) {
    assets::Shape shape;
    std::mt19937 random(4);
    std::uniform_real_distribution<double> jitter(-0.2, 0.2);
    shape.positions.emplace_back(glm::dvec3(0.0, 0.0, height));
    for (uint32_t i = 0; i < sides; ++i) {
        const double angle = glm::two_pi<double>() * (i + jitter(random)) / sides;
        shape.positions.emplace_back(
            glm::dvec3(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.002 * jitter(random)));
    }
    for (uint32_t i = 0; i < sides; ++i)
        for (const uint32_t index : {0u, 1 + i, 1 + (i + 1) % sides})
            shape.indices.push_back(index);
    return shape;
}

/// Two shapes that do not know of each other.
assets::Shape together(assets::Shape a, const assets::Shape& b, const glm::vec3& offset) {
    const auto base = static_cast<uint32_t>(a.positions.size());
    for (const glm::vec3& p : b.positions)
        a.positions.push_back(p + offset);
    for (const uint32_t index : b.indices)
        a.indices.push_back(base + index);
    a.normals.clear();
    return a;
}

/// A plate of strips whose triangles are `width` wide and 0.1 m long, of aspect 0.1 / width, between normal
/// ones.
assets::Shape slivers(double width) {
    assets::Shape shape;
    double y = 0.0;
    for (uint32_t row = 0; row <= 12; ++row) {
        for (const double x : {0.0, 0.1})
            shape.positions.emplace_back(glm::dvec3(x, y, 1e-4 * std::sin(3.0 * row + x)));
        y += row % 2 == 0 ? 0.01 : width;
    }
    for (uint32_t row = 0; row < 12; ++row) {
        const uint32_t a = 2 * row;
        for (const uint32_t index : {a, a + 1, a + 3, a, a + 3, a + 2})
            shape.indices.push_back(index);
    }
    return shape;
}

} // namespace

std::vector<HardShape> hardShapes() {
    std::mt19937 random(9);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::vector<HardShape> all;
    const auto rough = [&](uint32_t, uint32_t) { return 0.004 * unit(random); };
    all.push_back({"rough", terrain(30, rough)});
    const auto spiky = [&](uint32_t i, uint32_t j) { return (i + j) % 2 == 0 ? 0.006 * unit(random) : 0.0; };
    all.push_back({"spiky", terrain(40, spiky)});
    const auto faint = [&](uint32_t, uint32_t) { return 1e-7 * unit(random); };
    all.push_back({"almost flat", terrain(30, faint)});
    all.push_back({"grooves", terrain(40, [](uint32_t i, uint32_t) { return i % 2 == 0 ? 0.0 : 0.007; })});
    all.push_back({"hill of 12", fan(12, 0.01)});
    all.push_back({"pit of 12", fan(12, -0.01)});
    all.push_back({"pit of 100", fan(100, -0.01)});
    all.push_back({"needle", fan(16, 0.1)});
    all.push_back({"slivers 1e5", slivers(1e-6)});
    all.push_back({"spheres in spheres", together(assets::sphere(0.05, 24, 24), assets::sphere(0.03, 20, 20),
                                                  glm::vec3(0.03f, 0.01f, 0.02f))});
    all.push_back({"sheets 2 um apart", together(terrain(20, rough), terrain(20, faint), {0, 0, 2e-6f})});
    return all;
}

} // namespace touchstone::test
