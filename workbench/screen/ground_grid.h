#pragma once

#include "engine/math/similarity.h"
#include "renderer/overlay.h"

#include <string>

namespace touchstone {

/// The grid on the ground beneath a model, in its own metres.
struct GroundGrid {
    double spacing = 0.0; ///< model m, 1, 2 or 5 times a power of ten; 0: the model has no size
    Bounds bounds;        ///< of its lines, scene frame

    /// Of the model's bounds in its scene.
    explicit GroundGrid(const Bounds& scene);
    /// Every tenth line is brighter; the lines through the scene's origin are red along x and blue along z.
    /// `pixelScale`: picture pixels per nominal pixel.
    void draw(const Similarity& workspaceFromScene, float pixelScale, Overlay& overlay) const;
    /// "grid 20 mm"
    [[nodiscard]] std::string label() const;
};

} // namespace touchstone
