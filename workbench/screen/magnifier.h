#pragma once

#include "renderer/camera.h"
#include "renderer/window_target.h"

namespace touchstone {

/// The magnified inset that follows the probe. Pure.
struct Magnifier {
    static constexpr double kField = 12e-3; ///< m of the workspace, its field of view

    /// Looks at `probe` in the direction of `main`.
    [[nodiscard]] static OrbitCamera camera(const OrbitCamera& main, const glm::dvec3& probe);
    /// A square in the upper right corner of a picture, pixels.
    [[nodiscard]] static PixelRect place(const PixelRect& picture);
    /// Its frame with a scale bar, in ImGui's background. Window coordinates.
    static void drawFrame(const glm::vec2& corner, float size, float scale);
};

} // namespace touchstone
