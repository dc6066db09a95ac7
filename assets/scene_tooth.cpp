#include "assets/glb_writer.h"
#include "assets/program_material.h"
#include "assets/scenes.h"

#include <array>
#include <cmath>

namespace touchstone::assets {

namespace {

constexpr uint32_t kCells = 28;          // along the side of a chart
constexpr double kGutter = 6.0 / 1024.0; // around a chart, of the texture's side
constexpr glm::dvec3 kCrown{0.030, 0.034, 0.026};

/// A molar, ten times as large as life: a rounded block with four cusps above and a root that narrows below.
/// `direction`: unit, from its middle; m.
glm::dvec3 toothAt(const glm::dvec3& direction) {
    constexpr double kSquare = 3.2; // exponent of the rounded block
    double sum = 0.0;
    for (int k = 0; k < 3; ++k)
        sum += std::pow(std::abs(direction[k]) / kCrown[k], kSquare);
    glm::dvec3 p = std::pow(sum, -1.0 / kSquare) * direction;
    const double up = p.y / kCrown.y;
    if (up > 0.0) {
        const glm::dvec2 cusp = (glm::abs(glm::dvec2(p.x, p.z)) - glm::dvec2(0.016, 0.014)) / 0.010;
        p.y += 0.009 * up * up * (std::exp(-glm::dot(cusp, cusp)) - 0.35);
    } else {
        const double down = up * up * (3.0 + 2.0 * up); // 0 at the widest place, 1 at the tip, smooth
        const double narrow = 1.0 - 0.45 * down;
        p = {p.x * narrow, p.y * (1.0 + 0.6 * down), p.z * narrow};
    }
    return p;
}

/// A function of the direction alone, so that the charts agree to the bit where they meet.
glm::dvec3 normalAt(const glm::dvec3& direction) {
    constexpr double kStep = 1e-4;
    const glm::dvec3 axis = std::abs(direction.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 a = glm::normalize(glm::cross(axis, direction)), b = glm::cross(direction, a);
    const auto slope = [&](const glm::dvec3& along) {
        return toothAt(glm::normalize(direction + kStep * along)) -
               toothAt(glm::normalize(direction - kStep * along));
    };
    return glm::normalize(glm::cross(slope(a), slope(b)));
}

/// The six faces of a cube blown up to the tooth, each a chart of the texture: three beside each other, two
/// above each other.
Shape tooth() {
    Shape shape;
    std::array<double, kCells + 1> cuts{};
    for (uint32_t i = 0; i <= kCells / 2; ++i) { // angles of equal size; symmetric to the bit
        cuts[kCells - i] = std::tan(0.25 * 3.141592653589793 * (1.0 - 2.0 * i / kCells));
        cuts[i] = -cuts[kCells - i];
    }
    cuts[0] = -1.0;
    cuts[kCells] = 1.0;
    for (uint32_t face = 0; face < 6; ++face) {
        const int axis = static_cast<int>(face / 2), s = (axis + 1) % 3, t = (axis + 2) % 3;
        const double sign = face % 2 == 0 ? 1.0 : -1.0;
        const auto first = static_cast<uint32_t>(shape.positions.size());
        const glm::dvec2 corner{face % 3 / 3.0, face / 3 / 2.0}, size{1.0 / 3.0, 0.5};
        for (uint32_t j = 0; j <= kCells; ++j)
            for (uint32_t i = 0; i <= kCells; ++i) {
                glm::dvec3 cube(0.0);
                cube[axis] = sign;
                cube[s] = cuts[i];
                cube[t] = cuts[j];
                const glm::dvec3 direction = glm::normalize(cube);
                shape.positions.emplace_back(toothAt(direction));
                shape.normals.emplace_back(normalAt(direction));
                const glm::dvec2 at{static_cast<double>(i) / kCells, static_cast<double>(j) / kCells};
                shape.uv.emplace_back(corner + kGutter + at * (size - 2.0 * kGutter));
            }
        for (uint32_t j = 0; j < kCells; ++j)
            for (uint32_t i = 0; i < kCells; ++i) {
                const uint32_t a = first + j * (kCells + 1) + i, b = a + 1, c = a + kCells + 1, d = c + 1;
                for (const uint32_t index :
                     {a, sign > 0.0 ? b : d, sign > 0.0 ? d : b, a, sign > 0.0 ? d : c, sign > 0.0 ? c : d})
                    shape.indices.push_back(index);
            }
    }
    return shape;
}

} // namespace

SceneFile plaque() {
    GlbWriter glb("plaque");
    glb.describe("a tooth under plaque, which touch wears off: a persistent texture over six charts");
    const ProgramMaterial material{.program = "plaque.glsl",
                                   .colour = {0.80, 0.76, 0.66},
                                   .roughness = 0.4,
                                   .haptic = {{"staticFriction", 0.3}, {"dynamicFriction", 0.2}},
                                   .texture = {{"width", 1024}, {"height", 1024}}};
    glb.addNode("tooth", glb.addMesh("tooth", tooth(), addMaterial(glb, material)));
    return {"plaque.glb", glb.finish()};
}

} // namespace touchstone::assets
