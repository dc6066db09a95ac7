#include "assets/glb_writer.h"
#include "assets/scenes.h"
#include "assets/shapes.h"

namespace touchstone::assets {

SceneFile fieldTorus() {
    constexpr double kRing = 0.060, kTube = 0.025; // m
    constexpr double kVoxel = 0.00125;             // m: 136 on the longest side, a fifth of a facet
    constexpr uint32_t kAround = 52, kAcross = 32; // 3,328 triangles, as many as [002 Fig. 7a]
    GlbWriter glb("field_torus", Packing::Meshopt);
    glb.describe("felt as a distance field, seen as a mesh");
    const int material = glb.addMaterial(
        {{"name", "clay"},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.55, 0.38, 0.26, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.7}}},
         {"extensions",
          {{"TOUCHSTONE_materials_haptic",
            {{"representation", "implicit"},
             {"voxelSize", kVoxel},
             {"stiffness", 600.0},
             {"staticFriction", 0.3},
             {"dynamicFriction", 0.25}}}}}});
    glb.addNode("torus", glb.addMesh("torus", torus(kRing, kTube, kAround, kAcross), material));
    return {"field_torus.glb", glb.finish()};
}

} // namespace touchstone::assets
