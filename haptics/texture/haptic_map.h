#pragma once

#include "engine/core/checksum.h"
#include "engine/scene/image.h"
#include "engine/scene/material.h"
#include "haptics/settings/haptic_settings.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace touchstone {

/// A texture for haptic sampling: float texels with mip levels, wrap modes and UV transform. Immutable;
/// sampling is safe on the servo thread.
class HapticMap {
  public:
    HapticMap() = default;
    /// Takes the first `channels` channels of the pixels (1 for height and factors, 3 for normals).
    HapticMap(const PixelData& pixels, const TextureRef& reference, int channels);

    /// The placement of the texels over the texture coordinates.
    struct Layout {
        int texCoord = 0;
        int width = 1, height = 1; ///< of the finest level
        Wrap wrapS = Wrap::Repeat, wrapT = Wrap::Repeat;
        glm::dvec2 offset{0.0};   ///< KHR_texture_transform
        glm::dmat2 jacobian{1.0}; ///< d(transformed)/d(uv), column-major
        bool operator==(const Layout&) const = default;
    };

    /// Adopts the other's layout where they are equal, so that both have one address.
    void shareLayout(const HapticMap& other);

    [[nodiscard]] bool empty() const { return levels_.empty(); }
    [[nodiscard]] const Layout& layout() const { return *layout_; }
    [[nodiscard]] float least() const { return least_; } ///< of channel 0 over the finest level
    [[nodiscard]] float greatest() const { return greatest_; }
    [[nodiscard]] uint64_t memoryBytes() const;
    /// Hashes everything that sampling depends on.
    void addTo(Hash64& hash) const;

    /// The texture coordinate after KHR_texture_transform.
    [[nodiscard]] glm::dvec2 transform(const glm::dvec2& uv) const;

    /// The texels around a place in two levels, with their weights: bilinear in the level, linear between
    /// levels.
    struct Footprint {
        struct Cell {
            std::array<int32_t, 4> texel; ///< left and right of the upper row, then of the lower
            double right, down;
        };
        size_t level = 0;   ///< the finer one
        double share = 0.0; ///< of the next
        Cell fine, coarse;
    };
    /// `uv` is already transformed; `level` >= 0. Valid for every map of the same layout.
    void footprint(const glm::dvec2& uv, double level, Footprint& at) const;
    [[nodiscard]] double scalar(const Footprint& at) const;
    [[nodiscard]] glm::dvec3 vector(const Footprint& at) const;
    [[nodiscard]] double scalar(const glm::dvec2& uv, double level) const {
        Footprint at;
        footprint(uv, level, at);
        return scalar(at);
    }
    [[nodiscard]] glm::dvec3 vector(const glm::dvec2& uv, double level) const {
        Footprint at;
        footprint(uv, level, at);
        return vector(at);
    }
    struct Slope {
        double value = 0.0;
        glm::dvec2 gradient{0.0}; ///< over transformed uv
    };
    /// Channel 0 as `scalar` reads it and its gradient by central differences of half a texel, the derivative
    /// of the bilinear surface averaged over one texel; linear between levels.
    [[nodiscard]] Slope slope(const glm::dvec2& uv, double level) const;

    // The other filters and gradients: in texture/map_filters.cpp, so that they cost the default nothing.

    /// The texels around a place in the finest level with their weights, for the filters without levels.
    struct Patch {
        int count = 0;                   ///< columns, and rows
        std::array<int32_t, 4> column{}; ///< texels
        std::array<int32_t, 4> row{};    ///< times the width
        std::array<double, 4> across{}, down{};
    };
    /// `filter` is not Mip. Valid for every map of the same layout.
    void patch(const glm::dvec2& uv, TextureFilter filter, Patch& at) const;
    [[nodiscard]] double scalar(const Patch& at) const;
    [[nodiscard]] glm::dvec3 vector(const Patch& at) const;

    /// Precomputed slopes for every texel of every level, per texel: central differences over two texels.
    using Slopes = std::vector<std::vector<std::array<float, 2>>>;
    [[nodiscard]] Slopes texelSlopes() const;
    /// As `slope`, for any filter and gradient. `level` is Mip's. `kept`: the result of texelSlopes, or null;
    /// without it Precomputed computes the same numbers from the texels.
    [[nodiscard]] Slope slopeBy(TextureFilter filter, TextureGradient gradient, const glm::dvec2& uv,
                                double level, const Slopes* kept) const;

  private:
    static inline const std::shared_ptr<const Layout> kNoLayout = std::make_shared<const Layout>();

    struct Level {
        int width = 0, height = 0;
        std::vector<float> texels; ///< channels interleaved, rows from the top
    };
    [[nodiscard]] Level halved(const Level& fine) const;
    void findCell(const Level& level, const glm::dvec2& uv, Footprint::Cell& cell) const;
    template <class Value>
    [[nodiscard]] Value bilinear(const Level& level, const Footprint::Cell& cell) const;
    template <class Value>
    [[nodiscard]] Value read(const Footprint& at) const;
    [[nodiscard]] glm::dvec3 valueAndSlope(const Level& level, const glm::dvec2& uv) const;
    [[nodiscard]] std::array<float, 2> texelSlope(const Level& level, int column, int row) const;
    template <class Rule>
    [[nodiscard]] glm::dvec3 derived(const Level& level, const glm::dvec2& uv) const;
    template <class Rule>
    [[nodiscard]] glm::dvec3 precomputed(size_t level, const glm::dvec2& uv, const Slopes* kept) const;
    [[nodiscard]] glm::dvec3 slopeAt(size_t level, TextureFilter filter, TextureGradient gradient,
                                     const glm::dvec2& uv, const Slopes* kept) const;

    /// Shared by copies: a map may hold a hundred megabytes.
    class Levels {
      public:
        Levels() = default;
        explicit Levels(std::vector<Level> levels)
            : levels_(std::make_shared<const std::vector<Level>>(std::move(levels))) {}
        [[nodiscard]] bool empty() const { return levels_ == nullptr; }
        [[nodiscard]] size_t size() const { return levels_ != nullptr ? levels_->size() : 0; }
        const Level& operator[](size_t i) const { return (*levels_)[i]; }

      private:
        std::shared_ptr<const std::vector<Level>> levels_;
    };
    Levels levels_;
    std::shared_ptr<const Layout> layout_ = kNoLayout;
    int channels_ = 1;
    float least_ = 0.0f, greatest_ = 0.0f;
};

} // namespace touchstone
