#pragma once
// How texture coordinates change over the surface at the contact. For stage 5 only.

#include "haptics/texture/surface_spot.h"

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// Gradients of two scalars over the surface, per object unit.
struct SurfaceGradients {
    glm::dvec3 first{0.0}, second{0.0};
};

/// Interpolated between the corners where the surface is felt smooth and the corners know them, else the
/// facet's own.
[[nodiscard]] SurfaceGradients smoothed(const SurfaceSpot& spot, const std::vector<GradientPair>& vertices,
                                        const SurfaceGradients& facet) noexcept;

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
    const SurfaceSpot& spot_;
    std::array<SurfaceGradients, 2> uv_;
    std::array<bool, 2> known_{};
};

} // namespace touchstone
