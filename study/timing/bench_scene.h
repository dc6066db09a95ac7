#pragma once
// The benchmark scenes: procedural closed-form shapes, each with a stroke.

#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace touchstone::assets {
struct Shape;
}

namespace touchstone {

/// Position of the hand after `metres` of its stroke, `lift` m above the depth of the stroke. Workspace.
using BenchStroke = std::function<glm::dvec3(double metres, double lift)>;

/// A scene with a stroke 1 mm below its surface. Shapes are in metres and not rescaled.
struct BenchScene {
    std::string name;
    std::shared_ptr<const HapticScene> haptic;
    BenchStroke stroke;
    ScenePtr animated; ///< with the animation of its objects; null: static
    /// Of the mesh by its indices, before welding; 0: as after it.
    size_t madeVertices = 0, madeLines = 0;

    [[nodiscard]] size_t triangles() const;
    [[nodiscard]] size_t vertices() const; ///< as made
    [[nodiscard]] size_t lines() const;    ///< as made; else 0 where the neighbourhoods are not built
};

/// Objects 1, 2 and 3 of [000 Table I], as in assets/scenes: a box of 12 triangles, a torus of 456 that is
/// cut open, a sphere of 1800, and object 4, a sphere of 64,800. `number` 1..4.
[[nodiscard]] BenchScene tableOneScene(int number);

/// The torus of the issues, 60 mm and 25 mm, of about `triangles` triangles.
[[nodiscard]] BenchScene torusScene(size_t triangles);

/// Any shape, unscaled, with a given stroke.
[[nodiscard]] BenchScene shapeScene(std::string name, assets::Shape shape, BenchStroke stroke);

/// A shape that is no mesh, alone, with a default material.
[[nodiscard]] BenchScene fieldScene(std::string name, std::shared_ptr<const Shape> shape,
                                    const Similarity& workspaceFromObject, BenchStroke stroke);

/// A height over texture coordinates in 0..1, 0..1, as a fraction of `scale`.
using BenchHeight = std::function<double(double u, double v)>;

/// The same with a height map of `side` x `side` float texels, white `scale` m above black.
[[nodiscard]] BenchScene reliefScene(std::string name, assets::Shape shape, BenchStroke stroke, int side,
                                     double scale, const BenchHeight& height);

/// The same torus with every effect of a material: smooth normals, a normal map, a height map, friction and
/// viscous friction with a friction map, damping with a map and a stiffness map.
[[nodiscard]] BenchScene torusWithAllEffects(size_t triangles);

/// `count` spheres of 1800 triangles on a grid, with gaps of 0.2 mm; the stroke is on the central one.
[[nodiscard]] BenchScene sphereGridScene(size_t count);

/// The same with motion: every sphere rotates about its own axis, once in 2 s, while its centre moves on a
/// circle of 50 µm, so that all of them move in every tick.
[[nodiscard]] BenchScene movingGridScene(size_t count);

/// Two objects of about `triangles` triangles each, 6 mm apart, close on the hand between them at 20 mm/s
/// until they overlap by 4 mm, and part again, in a loop of 1 s. Boxes leave no way out, balls a wedge.
enum class Jaws { Boxes, Balls };
[[nodiscard]] BenchScene jawsScene(Jaws jaws, size_t triangles);

} // namespace touchstone
