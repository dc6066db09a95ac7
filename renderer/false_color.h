#pragma once
// Scales of the false-colour views, for legends.

#include "engine/scene/scene.h"
#include "renderer/view.h"

#include <glm/glm.hpp>

#include <array>
#include <string_view>
#include <vector>

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

/// Degrees between facets from which a cylinder was told from a smooth one, ascending: [004 Tables 1 and 2]'s
/// C3, C1, C2, C4 and P1.
inline constexpr std::array<double, 5> kFeltAngles{0.2, 0.5, 3.4, 3.5, 14.8};

/// For each vertex how many of kFeltAngles the largest angle between facets exceeds, over the edges at its
/// position that two triangles share and that are no creases: on a crease the vertex normals of both sides
/// differ by more than a degree. -1 where there is no such edge. Vertices at one position share it.
[[nodiscard]] std::vector<float> feltSteps(const Mesh& mesh);

/// sRGB colour (0..1) of the scale at t in 0..1, identical to the shader's.
[[nodiscard]] glm::vec3 falseColor(double t);

} // namespace touchstone
