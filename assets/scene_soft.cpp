#include "assets/glb_writer.h"
#include "assets/scenes.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone::assets {

namespace {

constexpr const char* kSoft = "TOUCHSTONE_soft_body";

Json skin(const char* name, std::array<double, 3> color, double roughness) {
    return {{"name", name},
            {"doubleSided", true},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", {color[0], color[1], color[2], 1.0}},
              {"metallicFactor", 0.0},
              {"roughnessFactor", roughness}}},
            {"extensions",
             {{"TOUCHSTONE_materials_haptic", {{"staticFriction", 0.3}, {"dynamicFriction", 0.2}}}}}};
}

/// A dome with a flat foot, about its middle: a sphere whose lower part is pressed to a plane, 3/2 `radius`
/// high.
Shape dome(double radius, uint32_t latitudes, uint32_t longitudes) {
    Shape shape = sphere(radius, latitudes, longitudes);
    for (size_t v = 0; v < shape.positions.size(); ++v)
        shape.positions[v].y = std::max(shape.positions[v].y, static_cast<float>(-0.5 * radius)) -
                               static_cast<float>(0.25 * radius);
    return shape;
}

} // namespace

SceneFile cloth() {
    GlbWriter glb("cloth");
    glb.describe("a cloth that lies over a ball (TOUCHSTONE_soft_body)");
    const int ball = glb.addNode(
        "ball",
        glb.addMesh("ball", sphere(0.030, 15, 24), glb.addMaterial(skin("ivory", {0.86, 0.82, 0.74}, 0.4))),
        {0.0, -0.012, 0.0});
    glb.addNode("plate",
                glb.addMesh("plate", box({0.16, 0.006, 0.14}),
                            glb.addMaterial(skin("slate", {0.33, 0.38, 0.45}, 0.6))),
                {0.0, -0.045, 0.0});
    Shape sheet = plane(0.10, 0.10, 24, 24);
    sheet.uv.clear();
    sheet.tangents.clear();
    const int node = glb.addNode(
        "cloth", glb.addMesh("cloth", sheet, glb.addMaterial(skin("linen", {0.70, 0.16, 0.20}, 0.9))),
        {0.0, 0.022, 0.0});
    glb.extendNode(node, kSoft,
                   {{"kind", "cloth"},
                    {"mass", 0.02},
                    {"stretch", 0.5},
                    {"damping", 20.0},
                    {"friction", 0.8},
                    {"thickness", 0.0015},
                    {"over", {ball}}});
    glb.useExtension(kSoft);
    return {"cloth.glb", glb.finish()};
}

SceneFile jelly() {
    GlbWriter glb("jelly");
    glb.describe(
        "a jelly that breathes, keeps its volume and comes back to its shape (TOUCHSTONE_soft_body)");
    glb.addNode("plate",
                glb.addMesh("plate", box({0.15, 0.006, 0.12}),
                            glb.addMaterial(skin("china", {0.90, 0.90, 0.88}, 0.25))),
                {0.0, -0.0235, 0.0});
    const int node = glb.addNode("jelly",
                                 glb.addMesh("jelly", dome(0.040, 17, 32),
                                             glb.addMaterial(skin("raspberry", {0.78, 0.10, 0.28}, 0.12))),
                                 {0.0, 0.010, 0.0});
    glb.extendNode(node, kSoft,
                   {{"kind", "jelly"},
                    {"mass", 0.06},
                    {"stretch", 0.1},
                    {"shapeFrequency", 30.0},
                    {"volumeStiffness", 8000.0},
                    {"damping", 60.0},
                    {"touchRadius", 0.010},
                    {"breath", 0.04},
                    {"breathTime", 4.0},
                    {"fixed", {{"min", {-1.0, -1.0, -1.0}}, {"max", {1.0, -0.0199, 1.0}}}}});
    glb.useExtension(kSoft);
    return {"jelly.glb", glb.finish()};
}

} // namespace touchstone::assets
