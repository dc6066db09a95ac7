#pragma once

#include "engine/core/checksum.h"
#include "engine/scene/image.h"
#include "engine/scene/material.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace touchstone {

/// A texture as the hand reads it: float texels with mip levels, wrap modes and UV transform. Immutable;
/// sampling is safe on the servo thread.
class HapticMap {
  public:
    HapticMap() = default;
    /// Takes the first `channels` channels of the pixels (1 for height and factors, 3 for normals).
    HapticMap(const PixelData& pixels, const TextureRef& reference, int channels);

    [[nodiscard]] bool empty() const { return levels_.empty(); }
    [[nodiscard]] int texCoord() const { return texCoord_; }
    [[nodiscard]] glm::dvec2 size() const {
        return empty() ? glm::dvec2(1.0) : glm::dvec2(levels_[0].width, levels_[0].height);
    }
    [[nodiscard]] float least() const { return least_; } ///< of channel 0 over the finest level
    [[nodiscard]] float greatest() const { return greatest_; }
    [[nodiscard]] uint64_t memoryBytes() const;
    /// All that sampling depends on.
    void addTo(Hash64& hash) const;

    /// The texture coordinate after KHR_texture_transform.
    [[nodiscard]] glm::dvec2 transform(const glm::dvec2& uv) const;
    /// d(transformed)/d(uv), column-major.
    [[nodiscard]] const glm::dmat2& transformJacobian() const { return jacobian_; }

    /// Bilinear in the level, linear between levels. `uv` is transformed already; `level` >= 0.
    [[nodiscard]] double scalar(const glm::dvec2& uv, double level) const;
    [[nodiscard]] glm::dvec3 vector(const glm::dvec2& uv, double level) const;
    struct Slope {
        double value = 0.0;
        glm::dvec2 gradient{0.0}; ///< over transformed uv
    };
    /// Channel 0 as `scalar` reads it and its gradient by central differences of half a texel, the derivative
    /// of the bilinear surface averaged over one texel; linear between levels.
    [[nodiscard]] Slope slope(const glm::dvec2& uv, double level) const;

  private:
    struct Level {
        int width = 0, height = 0;
        std::vector<float> texels; ///< channels interleaved, rows from the top
    };
    [[nodiscard]] Level halved(const Level& fine) const;
    template <class Value>
    [[nodiscard]] Value texel(const Level& level, int x, int y) const;
    template <class Value>
    [[nodiscard]] Value bilinear(const Level& level, const glm::dvec2& uv) const;
    [[nodiscard]] glm::dvec3 valueAndSlope(const Level& level, const glm::dvec2& uv) const;
    template <class Read>
    [[nodiscard]] auto between(double level, const Read& read) const;

    std::vector<Level> levels_;
    int channels_ = 1, texCoord_ = 0;
    Wrap wrapS_ = Wrap::Repeat, wrapT_ = Wrap::Repeat;
    glm::dvec2 offset_{0.0};
    glm::dmat2 jacobian_{1.0};
    float least_ = 0.0f, greatest_ = 0.0f;
};

} // namespace touchstone
