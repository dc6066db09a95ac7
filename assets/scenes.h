#pragma once
// The generators of all scenes in assets/scenes/. One file per family.

#include <cstddef>
#include <string>
#include <vector>

namespace touchstone::assets {

struct SceneFile {
    std::string name; ///< "doughnut.glb"
    std::vector<std::byte> bytes;
};

/// The doughnut of [000 Fig. 8a]: 64,800 triangles with waves as normal and height map.
[[nodiscard]] SceneFile doughnut();
/// The four objects of [000 Table I]: 12, 456, 1800 and 64,800 triangles.
[[nodiscard]] std::vector<SceneFile> tableOneObjects();
/// Bare shapes for closed forms and benchmarks: torus_64800, prism_flat, prism_smooth [000 Fig. 6], plane,
/// box.
[[nodiscard]] std::vector<SceneFile> plainShapes();
/// A board of tiles of equal shape and different haptic materials.
[[nodiscard]] SceneFile swatches();
/// A tile for each of shading (under a ridge of flat facets with smooth normals), texture and friction, so
/// that every switch of the window changes what is felt on its tile and nothing on the others.
[[nodiscard]] SceneFile effects();
/// A box that rises over a plate, turns once about the vertical and sinks again, in a loop of 4 s.
[[nodiscard]] SceneFile moving();
/// A stalk that bends by a skin and a ball that breathes by a morph target, over a plate; a second animation
/// twists the stalk.
[[nodiscard]] SceneFile breathing();

/// The doughnut of 64,800 triangles, which gives way under the hand (docs/deforming.md, Local deformation).
[[nodiscard]] SceneFile jellyDoughnut();

/// Soft bodies (docs/deforming.md): a cloth over a ball; a jelly that breathes.
[[nodiscard]] SceneFile cloth();
[[nodiscard]] SceneFile jelly();

/// Spheres, lines and points before a plate: all supported appearances.
[[nodiscard]] SceneFile materials();

/// The virtual bump of [000]: a flat plane that feels curved.
[[nodiscard]] SceneFile virtualBump();

/// A torus that is felt as a distance field [002]: 3,328 triangles, voxels of 1.25 mm.
[[nodiscard]] SceneFile fieldTorus();

/// Haptic programs (docs/programs.md): the beam of [003] Figure 6; the programs of [003]; six more surfaces;
/// heights h(x, y, z) on shapes without texture coordinates.
[[nodiscard]] SceneFile wood();
[[nodiscard]] SceneFile programs();
[[nodiscard]] SceneFile surfaces();
[[nodiscard]] SceneFile heights();
/// The tooth of [003]: plaque on six charts of a persistent texture, which touch wears off.
[[nodiscard]] SceneFile plaque();
/// Two-part mapping: one image on a doughnut [000 Fig. 8a], a rod, a box and a ball without coordinates.
[[nodiscard]] SceneFile mapped();
/// Rigid bodies (docs/bodies.md): blocks, a ball and a ramp; Newton's cradle; a stack of ten; a seesaw; a
/// panel of button, switch, slider and knob [000 Fig. 11]; a screw [001 Fig. 4-1].
[[nodiscard]] std::vector<SceneFile> bodies();

/// All of them.
[[nodiscard]] std::vector<SceneFile> allScenes();

/// A bare mesh of about `triangles` triangles (the nearest possible number), for benchmarks. `shape`: torus,
/// sphere, box, plane or prism. Throws std::invalid_argument for another name, or a count that is impossible
/// for the shape or exceeds 20 million.
[[nodiscard]] SceneFile bareShape(const std::string& shape, size_t triangles);

} // namespace touchstone::assets
