#pragma once

#include "renderer/camera.h"
#include "renderer/window_target.h"

namespace touchstone {

/// The small view that follows the probe. Pure.
struct Magnifier {
    static constexpr double kField = 12e-3; ///< m of the workspace that it shows from edge to edge

    /// Looks along `main` at `probe`.
    [[nodiscard]] static OrbitCamera camera(const OrbitCamera& main, const glm::dvec3& probe);
    /// A square in the upper right corner of a picture, pixels.
    [[nodiscard]] static PixelRect place(const PixelRect& picture);
    /// The frame around it with a bar for its scale, in ImGui's background. Window coordinates.
    static void drawFrame(const glm::vec2& corner, float size, float scale);
};

} // namespace touchstone
