#include "assets/glb_writer.h"
#include "assets/scenes.h"

#include <array>

namespace touchstone::assets {

namespace {

const glm::dvec3 kPlate{0.15, 0.008, 0.15}, kBox{0.06, 0.03, 0.04}; // m
constexpr double kPlateY = -0.034, kLowY = -0.010, kHighY = 0.030;  // m, centres
constexpr float kHalfTurn = 2.0f;                                   // s; the loop is a full turn

Json paint(const char* name, std::array<double, 3> color, double roughness) {
    return {{"name", name},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", roughness}}}};
}

} // namespace

SceneFile moving() {
    GlbWriter glb("moving");
    glb.describe("a box that rises and turns");
    const int plate =
        glb.addMesh("plate", box(kPlate), glb.addMaterial(paint("slate", {0.40, 0.47, 0.53}, 0.5)));
    const int lift =
        glb.addMesh("box", box(kBox, 2), glb.addMaterial(paint("brick", {0.65, 0.30, 0.20}, 0.8)));
    glb.addNode("plate", plate, {0.0, kPlateY, 0.0});
    const int node = glb.addNode("box", lift, {0.0, kLowY, 0.0});
    // Up and down, at rest at both ends: with zero tangents a cubic spline is 3 t^2 - 2 t^3.
    const auto low = static_cast<float>(kLowY), high = static_cast<float>(kHighY);
    std::vector<float> heights;
    for (const float y : {low, high, low})
        heights.insert(heights.end(), {0, 0, 0, 0, y, 0, 0, 0, 0});
    glb.animate({node, "translation", "CUBICSPLINE", {0.0f, kHalfTurn, 2.0f * kHalfTurn}, heights});
    // About the y axis at constant speed. The last key is the negative of the first one, the same pose, so
    // every interval takes the short way.
    const float half = 0.70710678f;
    glb.animate({node,
                 "rotation",
                 "LINEAR",
                 {0.0f, 0.5f * kHalfTurn, kHalfTurn, 1.5f * kHalfTurn, 2.0f * kHalfTurn},
                 {0, 0, 0, 1, 0, half, 0, half, 0, 1, 0, 0, 0, half, 0, -half, 0, 0, 0, -1}});
    return {"moving.glb", glb.finish()};
}

} // namespace touchstone::assets
