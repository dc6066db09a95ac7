#pragma once
// Random shapes on which a planned stroke is likely to fail: grooves, walls, thin and flat parts, edge-on
// sheets, scattered triangles, any size and orientation.

#include "assets/shapes.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <string>

namespace touchstone::test {

struct StrokeShape {
    std::string name; ///< of its family
    Scene scene;      ///< one or more instances, model units
};

/// A scene of one shape, with flat normals and the default material.
[[nodiscard]] Scene strokeScene(const assets::Shape& shape,
                                const glm::dmat4& sceneFromMesh = glm::dmat4(1.0));

/// The same seed gives the same shape. Every shape has at least one triangle of positive area.
[[nodiscard]] StrokeShape strokeShape(uint32_t seed);

} // namespace touchstone::test
