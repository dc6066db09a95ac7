#include "assets/glb_writer.h"
#include "assets/program_material.h"
#include "assets/scenes.h"

#include <array>
#include <span>

namespace touchstone::assets {

namespace {

constexpr glm::dvec3 kSlab{0.090, 0.050, 0.010}; // m
constexpr double kGap = 0.006;                   // m

using Slab = ProgramMaterial;

/// Boards side by side from the upper left, row by row, facing +z. Each is a mesh about its own origin, so
/// that its program has coordinates of its own.
void addSlabs(GlbWriter& glb, std::span<const Slab> slabs, size_t columns) {
    const size_t rows = (slabs.size() + columns - 1) / columns;
    for (size_t i = 0; i < slabs.size(); ++i) {
        const int mesh = glb.addMesh(slabs[i].program, box(kSlab), addMaterial(glb, slabs[i]));
        const glm::dvec2 middle{0.5 * static_cast<double>(columns - 1), 0.5 * static_cast<double>(rows - 1)};
        const glm::dvec2 cell{static_cast<double>(i % columns), static_cast<double>(i / columns)};
        glb.addNode(slabs[i].program, mesh,
                    {(cell.x - middle.x) * (kSlab.x + kGap), (middle.y - cell.y) * (kSlab.y + kGap), 0.0});
    }
}

Json friction(double staticFriction, double dynamicFriction) {
    return {{"staticFriction", staticFriction}, {"dynamicFriction", dynamicFriction}};
}

} // namespace

SceneFile wood() {
    GlbWriter glb("wood");
    glb.describe("a beam whose rings are felt as friction: one program, no texture");
    // The heart of the trunk is the x axis of the mesh.
    const Shape beam = box({0.140, 0.050, 0.030}, 8);
    const Slab slab{.program = "wood.glsl", .colour = {0.3, 0.12, 0.03}, .haptic = friction(0.3, 0.2)};
    glb.addNode("beam", glb.addMesh("beam", beam, addMaterial(glb, slab)));
    return {"wood.glb", glb.finish()};
}

SceneFile programs() {
    GlbWriter glb("programs");
    glb.describe("four haptic programs: wood, noise, anisotropic, circles");
    const std::array<Slab, 4> slabs{
        {{.program = "wood.glsl", .colour = {0.3, 0.12, 0.03}, .haptic = friction(0.3, 0.2)},
         {.program = "simple_noise.glsl", .colour = {0.35, 0.35, 0.38}, .haptic = friction(0.3, 0.2)},
         {.program = "anisotropic.glsl",
          .colour = {0.60, 0.62, 0.65},
          .metallic = 1.0,
          .roughness = 0.35,
          .haptic = friction(0.3, 0.2)},
         {.program = "circles.glsl",
          .colour = {0.20, 0.28, 0.45},
          .haptic = friction(0.25, 0.2),
          .parameters = {{"outerRadius", 0.013}, {"innerRadius", 0.006}}}}};
    addSlabs(glb, slabs, 2);
    return {"programs.glb", glb.finish()};
}

SceneFile surfaces() {
    GlbWriter glb("surfaces");
    glb.describe("six surfaces by programs: sandpaper, knurl, brushed metal, fabric, wet ice, a button");
    const std::array<Slab, 6> slabs{
        {{.program = "sandpaper.glsl", .colour = {0.35, 0.20, 0.10}, .roughness = 0.95},
         {.program = "knurl.glsl", .colour = {0.50, 0.50, 0.52}, .metallic = 1.0, .roughness = 0.4},
         {.program = "brushed_metal.glsl", .colour = {0.62, 0.60, 0.56}, .metallic = 1.0, .roughness = 0.3},
         {.program = "fabric.glsl", .colour = {0.10, 0.16, 0.40}, .roughness = 1.0},
         {.program = "wet_ice.glsl", .colour = {0.70, 0.85, 0.92}, .roughness = 0.08},
         {.program = "button.glsl", .colour = {0.55, 0.08, 0.06}, .haptic = friction(0.3, 0.2)}}};
    addSlabs(glb, slabs, 3);
    return {"surfaces.glb", glb.finish()};
}

SceneFile heights() {
    GlbWriter glb("heights");
    glb.describe("heights in space on models without texture coordinates");
    const auto add = [&](const char* name, const Shape& shape, const glm::dvec3& colour, int kind,
                         double waves, const glm::dvec3& place) {
        const Slab slab{.program = "heights.glsl",
                        .colour = colour,
                        .haptic = friction(0.2, 0.15),
                        .parameters = {{"kind", kind}, {"waves", waves}}};
        glb.addNode(name, glb.addMesh(name, shape, addMaterial(glb, slab)), place);
    };
    add("waves", torus(0.030, 0.014, 64, 32), {0.45, 0.22, 0.08}, 0, 90.0, {-0.060, 0.0, 0.0});
    add("cells", sphere(0.028, 31, 64), {0.12, 0.35, 0.18}, 1, 120.0, {0.020, 0.0, 0.0});
    add("noise", sphere(0.022, 31, 64), {0.18, 0.22, 0.45}, 2, 160.0, {0.078, 0.0, 0.0});
    return {"heights.glb", glb.finish()};
}

} // namespace touchstone::assets
