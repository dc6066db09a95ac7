#include "assets/glb_writer.h"
#include "assets/picture.h"
#include "assets/scenes.h"

#include <cmath>
#include <numbers>

namespace touchstone::assets {

namespace {

constexpr double kRing = 0.060, kTube = 0.025; // m
// The maps repeat 12 times along the ring and 5 times around the tube: 12 : 5 = 60 : 25, so a tile is a
// square of 31.4 mm along the tube's centre line, where the waves are undistorted.
constexpr TextureRepeats kRepeats{12, 5};
constexpr double kTileWidth = 2.0 * std::numbers::pi * kRing / 12;
// Per tile 3 waves along the ring and 2 around the tube: crests 8.7 mm apart that wind around the doughnut,
// so every stroke direction crosses them. With a height of 0.5 mm they tilt the normal by at most 10 degrees.
constexpr double kWavesU = 3.0, kWavesV = 2.0;
constexpr double kWaveHeight = 0.0005; // m, trough to crest
constexpr int kMapSize = 256;          // 0.12 mm a texel, 71 texels a wave

double waves(double u, double v) {
    return 0.5 + 0.5 * std::sin(2.0 * std::numbers::pi * (kWavesU * u + kWavesV * v));
}

} // namespace

SceneFile doughnut() {
    GlbWriter glb("doughnut", Packing::Meshopt);
    glb.describe("a glaze: grooves and friction");
    const int normal =
        glb.addTexture("waves, normals", png(normalMap(waves, kMapSize, kTileWidth, kWaveHeight)));
    const int height = glb.addTexture("waves, heights", png(heightMap(waves, kMapSize)));
    const int material = glb.addMaterial(
        {{"name", "glaze"},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.72, 0.28, 0.20, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.38}}},
         {"normalTexture", {{"index", normal}}},
         {"extensions",
          {{"TOUCHSTONE_materials_haptic",
            {{"staticFriction", 0.35},
             {"dynamicFriction", 0.25},
             {"heightTexture", {{"index", height}, {"scale", kWaveHeight}, {"midLevel", 0.5}}}}}}}});
    glb.addNode("doughnut", glb.addMesh("doughnut", torus(kRing, kTube, 180, 180, kRepeats), material));
    return {"doughnut.glb", glb.finish()};
}

} // namespace touchstone::assets
