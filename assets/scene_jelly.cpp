#include "assets/glb_writer.h"
#include "assets/scenes.h"

namespace touchstone::assets {

SceneFile jellyDoughnut() {
    GlbWriter glb("jelly doughnut", Packing::Meshopt);
    glb.describe("64,800 triangles that give way under the hand (local deformation)");
    const int material = glb.addMaterial(
        {{"name", "jelly"},
         {"pbrMetallicRoughness",
          {{"baseColorFactor", {0.78, 0.16, 0.24, 1.0}}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.16}}},
         {"extensions",
          {{"TOUCHSTONE_materials_haptic",
            {{"stiffness", 600.0},
             {"staticFriction", 0.3},
             {"dynamicFriction", 0.2},
             {"deformationRadius", 0.022},
             {"deformationStiffness", 300.0},
             {"relaxationTime", 0.15}}}}}});
    Shape ring = torus(0.060, 0.025, 180, 180);
    ring.uv.clear();
    ring.tangents.clear();
    glb.addNode("doughnut", glb.addMesh("doughnut", ring, material));
    return {"jelly_doughnut.glb", glb.finish()};
}

} // namespace touchstone::assets
