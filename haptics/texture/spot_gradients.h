#pragma once
// How texture coordinates change over the surface at the contact. For stage 5 only.

#include "haptics/texture/surface_spot.h"

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace touchstone {

/// Gradients of two scalars over the surface, per object unit.
struct SurfaceGradients {
    glm::dvec3 first{0.0}, second{0.0};
};

/// Interpolated between the corners where the surface is felt smooth and the corners know them, else the
/// facet's own, which `facet()` gives.
template <class Facet>
[[nodiscard]] SurfaceGradients smoothed(const SurfaceSpot& spot, const std::vector<GradientPair>& vertices,
                                        const Facet& facet) noexcept {
    if (!spot.smooth || vertices.empty())
        return facet();
    SurfaceGradients sum;
    for (size_t k = 0; k < 3; ++k) {
        const GradientPair& at = vertices[spot.source(k)];
        const double weight = spot.weight[static_cast<int>(k)];
        const bool known = std::isfinite(at[0].x);
        const SurfaceGradients g = known ? SurfaceGradients{glm::dvec3(at[0]), glm::dvec3(at[1])} : facet();
        sum.first += weight * g.first;
        sum.second += weight * g.second;
    }
    return sum;
}

/// Those of the coordinate sets at one spot, each found when it is first asked for.
class SpotGradients {
  public:
    explicit SpotGradients(const SurfaceSpot& spot) : spot_(spot) {}

    [[nodiscard]] const SurfaceGradients& uv(int set) noexcept;
    /// Of the map's own coordinates, by the chain rule over KHR_texture_transform.
    [[nodiscard]] SurfaceGradients map(const HapticMap& map) noexcept;
    /// Mip level whose texel is at least two strokes long: at that spacing the servo still samples every
    /// feature twice (Nyquist). `stroke`: m in the workspace that the hand goes in a tick. 0 without
    /// coordinates.
    [[nodiscard]] double strokeLevel(const HapticMap& map, double stroke) noexcept;

  private:
    /// What a level was found for: maps of one size that lie the same way share it.
    struct Laid {
        int set = -1;
        glm::dvec2 size{0.0};
        glm::dmat2 jacobian{0.0};
        double stroke = 0.0;
        bool operator==(const Laid&) const = default;
    };

    const SurfaceSpot& spot_;
    std::array<SurfaceGradients, 2> uv_;
    std::array<bool, 2> known_{};
    Laid laid_; ///< the last map asked for
    double level_ = 0.0;
};

} // namespace touchstone
