#pragma once
// Scales of the false-colour views, for legends.

#include "engine/scene/scene.h"
#include "renderer/view.h"

#include <glm/glm.hpp>

#include <string_view>

namespace touchstone {

/// The ends of the colour scale. Surfaces without a value in the file are grey.
struct FalseColorScale {
    double low = 0.0, high = 1.0;
    std::string_view unit;   ///< "m" (model metres), "N/m", "N·s/m", "1", "°", or empty
    bool meaningful = false; ///< false: no material states this quantity, everything is grey
};

/// Visits every vertex; SceneRenderer::falseColorScale caches the one on display.
[[nodiscard]] FalseColorScale falseColorScale(const Scene& scene, ViewMode mode);

/// Degrees at the upper end of ViewMode::Tilt's scale: the limit of shading and texture.
inline constexpr double kMaxTilt = 30.0;

/// For each vertex the largest angle, in degrees, between the two facets at an edge that ends at its
/// position; 0 where all edges are on a border. Vertices at one position share it.
[[nodiscard]] std::vector<float> dihedralAngles(const Mesh& mesh);

/// sRGB colour (0..1) of the scale at t in 0..1, identical to the shader's.
[[nodiscard]] glm::vec3 falseColor(double t);

} // namespace touchstone
