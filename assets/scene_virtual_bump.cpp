#include "assets/glb_writer.h"
#include "assets/picture.h"
#include "assets/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::assets {

namespace {

constexpr double kSide = 0.15;        // m
constexpr double kBumpRadius = 0.045; // m
constexpr double kBumpHeight = 0.006; // m; slopes up to 11.8 degrees
constexpr int kMapSize = 256;

double bump(double u, double v) {
    const double distance = std::min(1.0, kSide / kBumpRadius * std::hypot(u - 0.5, v - 0.5));
    return 0.5 + 0.5 * std::cos(std::numbers::pi * distance);
}

} // namespace

SceneFile virtualBump() {
    GlbWriter glb("virtual bump");
    glb.describe("flat, and feels curved");
    const int height = glb.addTexture("bump, heights", png(heightMap(bump, kMapSize)));
    // No roughness is stated, so that no friction is derived: the lateral force comes from the bump alone.
    const int material = glb.addMaterial(
        {{"name", "a plane that feels curved"},
         {"doubleSided", true},
         {"pbrMetallicRoughness", {{"baseColorFactor", {0.36, 0.46, 0.62, 1.0}}, {"metallicFactor", 0.0}}},
         {"extensions",
          {{"TOUCHSTONE_materials_haptic",
            {{"heightTexture", {{"index", height}, {"scale", kBumpHeight}, {"midLevel", 0.0}}}}}}}});
    glb.addNode("plane", glb.addMesh("plane", plane(kSide, kSide), material));
    return {"virtual_bump.glb", glb.finish()};
}

} // namespace touchstone::assets
