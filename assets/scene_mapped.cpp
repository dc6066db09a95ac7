#include "assets/glb_writer.h"
#include "assets/picture.h"
#include "assets/scenes.h"

#include <cmath>
#include <numbers>

namespace touchstone::assets {

namespace {

constexpr double kTile = 0.014;    // m, of one image on the doughnut's outer side
constexpr double kHeight = 0.0004; // m, trough to crest
constexpr int kMapSize = 256;

/// Rounded studs, two by two in a tile.
double studs(double u, double v) {
    const double x = std::sin(2.0 * std::numbers::pi * u), y = std::sin(2.0 * std::numbers::pi * v);
    const double s = x * x * y * y;
    return s * s * (3.0 - 2.0 * s);
}

} // namespace

SceneFile mapped() {
    GlbWriter glb("mapped");
    glb.describe("one image on a doughnut, a rod, a box and a ball without texture coordinates");
    const int height = glb.addTexture("studs, heights", png(heightMap(studs, kMapSize)));
    const int normal = glb.addTexture("studs, normals", png(normalMap(studs, kMapSize, kTile, kHeight)));
    const int friction = glb.addTexture("studs, friction", png(factorMap(studs, kMapSize)));
    const auto material = [&](const char* name, const glm::dvec3& colour, const Json& mapping) {
        return glb.addMaterial(
            {{"name", name},
             {"pbrMetallicRoughness",
              {{"baseColorFactor", {colour.x, colour.y, colour.z, 1.0}},
               {"baseColorTexture", {{"index", friction}}},
               {"metallicFactor", 0.0},
               {"roughnessFactor", 0.4}}},
             {"normalTexture", {{"index", normal}}},
             {"extensions",
              {{"TOUCHSTONE_materials_haptic",
                {{"staticFriction", 0.5},
                 {"dynamicFriction", 0.4},
                 {"frictionTexture", {{"index", friction}, {"min", 0.4}, {"max", 1.0}}},
                 {"heightTexture", {{"index", height}, {"scale", kHeight}, {"midLevel", 0.0}}},
                 {"textureMapping", mapping}}}}}});
    };
    const auto add = [&](const char* name, const Shape& shape, const glm::dvec3& colour, const Json& mapping,
                         double x) {
        glb.addNode(name, glb.addMesh(name, shape, material(name, colour, mapping)), {x, 0.0, 0.0});
    };
    add("doughnut by a sphere", torus(0.028, 0.012, 96, 48), {0.85, 0.55, 0.40},
        {{"surface", "sphere"}, {"repeat", {16, 16}}}, -0.068);
    // The prism stands along y: the cylinder's axis, z, is turned there.
    const double half = std::sqrt(0.5);
    add("rod by a cylinder", prism(64, 0.014, 0.060, true, 8), {0.50, 0.70, 0.85},
        {{"surface", "cylinder"}, {"repeat", {6, 4}}, {"rotation", {-half, 0.0, 0.0, half}}}, -0.006);
    add("box by a box", box({0.036, 0.036, 0.036}, 6), {0.60, 0.80, 0.50},
        {{"surface", "box"}, {"repeat", {3, 3}}}, 0.036);
    add("ball by a plane", sphere(0.019, 47, 96), {0.80, 0.60, 0.80},
        {{"surface", "plane"}, {"repeat", {3, 3}}}, 0.082);
    return {"mapped.glb", glb.finish()};
}

} // namespace touchstone::assets
