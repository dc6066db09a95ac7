#pragma once
// Overlays drawn over the scene: HIP, proxy, force, planes. Plain data in workspace metres, as generic
// shapes.

#include <glm/glm.hpp>

#include <vector>

namespace touchstone {

/// Colours are linear RGB with straight alpha, 0..1. Every item but the grid is drawn with the depth test and
/// once more, faintly, where the scene hides it, so that a HIP inside an object is visible.
struct Overlay {
    struct Sphere {
        glm::dvec3 centre{0.0};
        double radius = 0.0; ///< m
        glm::vec4 color{1.0f};
    };
    /// A shaft and a conical head that ends at `to`. If shorter than its head, the head shrinks.
    struct Arrow {
        glm::dvec3 from{0.0}, to{0.0};
        double radius = 0.0; ///< m, of the shaft
        glm::vec4 color{1.0f};
    };
    struct Line {
        glm::dvec3 from{0.0}, to{0.0};
        glm::vec4 color{1.0f};
        float width = 1.5f; ///< pixels of the scene image
    };
    /// A flat disc, seen from both sides; for constraint planes.
    struct Disc {
        glm::dvec3 centre{0.0};
        glm::dvec3 normal{0.0, 1.0, 0.0}; ///< need not be unit; zero draws nothing
        double radius = 0.0;              ///< m
        glm::vec4 color{1.0f};
    };

    std::vector<Sphere> spheres;
    std::vector<Arrow> arrows;
    std::vector<Line> lines;
    std::vector<Disc> discs;
    std::vector<Line> grid; ///< lines that are not drawn where the scene hides them
    /// Alpha factor of the pass for hidden items; 0 disables it.
    float hiddenAlpha = 0.45f;

    void clear() {
        spheres.clear();
        arrows.clear();
        lines.clear();
        discs.clear();
        grid.clear();
    }
    [[nodiscard]] bool empty() const {
        return spheres.empty() && arrows.empty() && lines.empty() && discs.empty() && grid.empty();
    }
};

} // namespace touchstone
