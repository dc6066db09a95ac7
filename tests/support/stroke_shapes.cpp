#include "tests/support/stroke_shapes.h"

#include <glm/gtc/matrix_transform.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

namespace touchstone::test {

namespace {

using assets::Shape;

/// Draws of one seed.
class Dice {
  public:
    explicit Dice(uint32_t seed) : engine_(seed) {}
    double in(double low, double high) { return low + (high - low) * unit_(engine_); }
    double log(double low, double high) { return std::exp(in(std::log(low), std::log(high))); }
    bool chance(double p) { return unit_(engine_) < p; }
    uint32_t below(uint32_t n) { return static_cast<uint32_t>(engine_() % n); }
    glm::dvec3 inCube(double half) { return {in(-half, half), in(-half, half), in(-half, half)}; }

  private:
    std::mt19937 engine_;
    std::uniform_real_distribution<double> unit_{0.0, 1.0};
};

void add(Shape& shape, const Shape& other, const glm::dmat4& place = glm::dmat4(1.0)) {
    const auto base = static_cast<uint32_t>(shape.positions.size());
    for (const glm::vec3& p : other.positions)
        shape.positions.emplace_back(glm::dvec3(place * glm::dvec4(glm::dvec3(p), 1.0)));
    for (const uint32_t index : other.indices)
        shape.indices.push_back(base + index);
}

/// Heights over a square of 100 mm on a grid of `cells`, facing +z.
Shape terrain(uint32_t cells, const std::function<double(double, double)>& height) {
    Shape shape;
    for (uint32_t y = 0; y <= cells; ++y)
        for (uint32_t x = 0; x <= cells; ++x) {
            const double u = static_cast<double>(x) / cells - 0.5, v = static_cast<double>(y) / cells - 0.5;
            shape.positions.emplace_back(0.1 * u, 0.1 * v, height(u, v));
        }
    for (uint32_t y = 0; y < cells; ++y)
        for (uint32_t x = 0; x < cells; ++x) {
            const uint32_t a = y * (cells + 1) + x, b = a + 1, c = a + cells + 1, d = c + 1;
            for (const uint32_t index : {a, b, d, a, d, c})
                shape.indices.push_back(index);
        }
    return shape;
}

Shape body(Dice& dice) {
    switch (dice.below(5)) {
    case 0:
        return assets::box({dice.log(0.01, 0.1), dice.log(0.01, 0.1), dice.log(0.01, 0.1)});
    case 1:
        return assets::boxWithSharedCorners(glm::dvec3(dice.log(0.02, 0.1)));
    case 2:
        return assets::sphere(dice.log(0.01, 0.05), 3 + dice.below(40), 3 + dice.below(40));
    case 3:
        return assets::torus(dice.in(0.02, 0.06), dice.log(0.002, 0.02), 3 + dice.below(60),
                             3 + dice.below(30));
    default:
        return assets::prism(3 + dice.below(20), dice.log(0.005, 0.05), dice.log(0.01, 0.1), false);
    }
}

/// A sphere whose vertices are moved along their radius: spikes and pits.
Shape star(Dice& dice) {
    Shape shape = assets::sphere(0.05, 4 + dice.below(40), 4 + dice.below(40));
    const double rough = dice.log(0.001, 0.9);
    for (glm::vec3& p : shape.positions)
        p *= static_cast<float>(1.0 - rough * dice.in(0.0, 1.0));
    return shape;
}

Shape bump(Dice& dice) {
    const uint32_t kind = dice.below(5);
    const double amplitude = dice.log(1e-6, 0.05), waves = dice.in(1.0, 12.0);
    return terrain(2 + dice.below(60), [&](double u, double v) {
        const double phase = 2.0 * std::numbers::pi * waves * u;
        switch (kind) {
        case 0:
            return amplitude * dice.in(0.0, 1.0); // noise
        case 1:
            return amplitude * std::sin(phase) * std::cos(0.7 * phase); // waves
        case 2:
            return std::sin(phase) > 0.0 ? amplitude : 0.0; // steps
        case 3:
            return amplitude * std::abs(std::sin(0.5 * phase)); // V grooves
        default:
            return amplitude * (u * u + v * v); // a shallow dish
        }
    });
}

Shape thin(Dice& dice) {
    const double thickness = dice.chance(0.3) ? 0.0 : dice.log(1e-6, 2e-3);
    switch (dice.below(3)) {
    case 0:
        return assets::box({dice.in(0.02, 0.1), dice.in(0.02, 0.1), thickness}); // a plate
    case 1:
        return assets::box({std::max(thickness, 1e-6), 0.1, std::max(thickness, 1e-6)}); // a rod
    default:
        return assets::plane(dice.in(0.02, 0.1), dice.in(0.02, 0.1), 1 + dice.below(9), 1 + dice.below(9));
    }
}

Shape bits(Dice& dice) {
    Shape shape;
    const uint32_t count = 1 + dice.below(dice.chance(0.3) ? 2 : 60);
    const double size = dice.log(1e-4, 0.05);
    for (uint32_t i = 0; i < count; ++i) {
        const glm::dvec3 centre = dice.inCube(0.05);
        for (uint32_t k = 0; k < 3; ++k) {
            shape.positions.emplace_back(centre + dice.inCube(size));
            shape.indices.push_back(3 * i + k);
        }
    }
    return shape;
}

/// Bodies that stand beside, in and through each other.
Shape heap(Dice& dice) {
    Shape shape;
    const uint32_t count = 2 + dice.below(8);
    for (uint32_t i = 0; i < count; ++i) {
        glm::dmat4 place = glm::translate(glm::dmat4(1.0), dice.inCube(0.05));
        if (dice.chance(0.5))
            place = glm::rotate(place, dice.in(0.0, 6.0), glm::normalize(dice.inCube(1.0) + 1e-3));
        add(shape, body(dice), place);
    }
    return shape;
}

/// Two sheets face to face, `gap` apart.
Shape gap(Dice& dice) {
    Shape shape;
    const double apart = dice.log(2e-4, 0.03);
    const Shape sheet = assets::plane(0.1, 0.1, 1 + dice.below(4), 1 + dice.below(4));
    add(shape, sheet);
    add(shape, sheet, glm::translate(glm::dmat4(1.0), {0.0, apart, 0.0}));
    return shape;
}

} // namespace

Scene strokeScene(const Shape& shape, const glm::dmat4& sceneFromMesh) {
    Scene scene;
    scene.path = "random";
    scene.materials.emplace_back();
    scene.nodes.emplace_back();
    Mesh& mesh = scene.meshes.emplace_back();
    for (size_t t = 0; t < shape.triangleCount(); ++t) {
        const auto corner = [&](size_t k) { return shape.positions[shape.indices[3 * t + k]]; };
        const glm::dvec3 a(corner(0)),
            normal = glm::cross(glm::dvec3(corner(1)) - a, glm::dvec3(corner(2)) - a);
        const double length = glm::length(normal);
        for (size_t k = 0; k < 3; ++k) {
            mesh.positions.push_back(corner(k));
            mesh.normals.push_back(length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0, 1, 0));
            mesh.indices.push_back(static_cast<uint32_t>(3 * t + k));
            scene.bounds.include(glm::dvec3(sceneFromMesh * glm::dvec4(glm::dvec3(corner(k)), 1.0)));
        }
    }
    Instance& instance = scene.instances.emplace_back();
    instance.node = instance.mesh = 0;
    instance.sceneFromMesh = sceneFromMesh;
    return scene;
}

StrokeShape strokeShape(uint32_t seed) {
    using Maker = Shape (*)(Dice&);
    static constexpr std::array<std::pair<const char*, Maker>, 7> kFamilies{{{"body", body},
                                                                             {"star", star},
                                                                             {"relief", bump},
                                                                             {"thin", thin},
                                                                             {"bits", bits},
                                                                             {"heap", heap},
                                                                             {"gap", gap}}};
    Dice dice(seed);
    const auto& [name, make] = kFamilies[seed % kFamilies.size()];
    const Shape shape = make(dice);
    glm::dmat4 place(1.0);
    if (dice.chance(0.6))
        place = glm::rotate(place, dice.in(0.0, 6.0), glm::normalize(dice.inCube(1.0) + 1e-3));
    else if (dice.chance(0.7)) // a quarter turn: faces seen exactly face-on or edge-on
        place =
            glm::mat4_cast(glm::normalize(glm::dquat(1.0, dice.below(2), dice.below(2) ? 0.0 : 1.0, 0.0)));
    if (dice.chance(0.2))
        place = glm::scale(place, {1.0, 1.0, -1.0});
    place = glm::scale(place, glm::dvec3(dice.chance(0.5) ? 1.0 : dice.log(1e-3, 1e3)));
    StrokeShape result{name, strokeScene(shape, place)};
    if (dice.chance(0.1))
        for (Material& material : result.scene.materials)
            material.haptic.sides = SideChoice::Front;
    return result;
}

} // namespace touchstone::test
