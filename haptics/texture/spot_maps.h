#pragma once
// Placement of the maps over the surface at the contact. For stage 5 only.

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

/// Interpolated between the corners where the surface is smooth and the corners have gradients, else the
/// facet's own, computed by `facet()`.
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

/// Data that maps share at one spot, each computed on first use: gradients of the texture coordinates, mip
/// level and texels. Maps of one material mostly have the same layout.
class SpotMaps {
  public:
    /// `stroke`: distance in workspace m that the hand moves along the surface in this tick; chooses mip
    /// levels.
    SpotMaps(const SurfaceSpot& spot, TextureFilter filter, TextureGradient gradient, double stroke)
        : spot_(spot), filter_(filter), gradient_(gradient), stroke_(stroke) {}

    [[nodiscard]] const SurfaceGradients& gradients(int set) noexcept;
    // The following functions are for maps whose coordinates the mesh has (SurfaceSpot::hasUv).
    /// Gradients of the map's own coordinates, by the chain rule over KHR_texture_transform.
    [[nodiscard]] const SurfaceGradients& gradients(const HapticMap& map) noexcept {
        settle(map);
        return over_;
    }
    /// With textureFilter=mip: the level whose texel is at least two strokes long: at that spacing the servo
    /// samples every feature twice (Nyquist).
    [[nodiscard]] double level(const HapticMap& map) noexcept {
        settle(map);
        return level_;
    }
    /// The spot's coordinates in the map, after its transform.
    [[nodiscard]] const glm::dvec2& place(const HapticMap& map) noexcept {
        settle(map);
        return place_;
    }
    [[nodiscard]] double scalar(const HapticMap& map) noexcept {
        return filter_ == TextureFilter::Mip ? map.scalar(footprint(map)) : map.scalar(patch(map));
    }
    [[nodiscard]] glm::dvec3 vector(const HapticMap& map) noexcept {
        return filter_ == TextureFilter::Mip ? map.vector(footprint(map)) : map.vector(patch(map));
    }
    /// `kept`: HapticScene::slopes of the map, if available.
    [[nodiscard]] HapticMap::Slope slope(const HapticMap& map, const HapticMap::Slopes* kept) noexcept {
        if (filter_ == TextureFilter::Mip && gradient_ == TextureGradient::Central)
            return map.slope(place(map), level(map));
        return map.slopeBy(filter_, gradient_, place(map), level(map), kept);
    }

  private:
    void settle(const HapticMap& map) noexcept;
    [[nodiscard]] const HapticMap::Footprint& footprint(const HapticMap& map) noexcept;
    [[nodiscard]] const HapticMap::Patch& patch(const HapticMap& map) noexcept;

    const SurfaceSpot& spot_;
    TextureFilter filter_;
    TextureGradient gradient_;
    double stroke_;
    std::array<SurfaceGradients, 2> gradients_;
    std::array<bool, 2> known_{};
    // Of the layout used last:
    const HapticMap::Layout* settled_ = nullptr;
    SurfaceGradients over_;
    double level_ = 0.0;
    glm::dvec2 place_{0.0};
    bool printed_ = false;
    HapticMap::Footprint footprint_; // of Mip
    HapticMap::Patch patch_;         // of the others
};

} // namespace touchstone
