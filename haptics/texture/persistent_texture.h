#pragma once
// The persistent texture of one object [003]: floats over its texture coordinates, which touch changes.

#include "engine/program/surface_program.h"
#include "haptics/texture/texel_map.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace touchstone {

/// What one contact changes in one tick: the integral of the texture over the surface, by `change`, spread
/// over a disc. Object frame and units.
struct BrushStroke {
    uint64_t tick = 0;
    uint32_t object = 0; ///< HapticScene::objects
    glm::dvec3 point{0.0}, normal{0.0, 0.0, 1.0};
    double radius = 0.0;
    double change = 0.0;                   ///< object units^2, in this tick
    uint32_t most = TexelMap::kMaxReached; ///< texels that it may change: the strokes of a tick share them
    bool operator==(const BrushStroke&) const = default;
};

/// Construct off the servo (it allocates). What is noexcept neither allocates nor locks nor throws.
///
/// A stroke adds c w_t to each texel t of the brush, with the weight w_t = (1 - (r/R)^2)^2 of the texel's
/// distance r and c = change / sum A_t w_t over the discrete texels. So the integral changes by `change` to
/// rounding, whatever the texture's resolution and the tick's length, while no texel is at an end of its
/// range.
class PersistentTexture {
  public:
    static constexpr uint32_t kTile = 32; ///< texels along the side of a tile

    /// `start`: the values that it begins with, as many as it has texels; null: the initial one.
    PersistentTexture(std::shared_ptr<const TexelMap> map, const PersistentTextureSize& size,
                      std::shared_ptr<const std::vector<float>> start = nullptr);

    [[nodiscard]] const std::shared_ptr<const TexelMap>& map() const { return map_; }
    [[nodiscard]] const PersistentTextureSize& size() const { return size_; }
    [[nodiscard]] const std::shared_ptr<const std::vector<float>>& start() const { return start_; }
    /// Row by row.
    [[nodiscard]] std::span<const float> values() const noexcept { return values_; }
    /// Bilinear, repeating. `gradient` (may be null): by u and v.
    [[nodiscard]] double at(const glm::dvec2& uv, glm::dvec2* gradient = nullptr) const noexcept;
    /// Over the surface, by area; 0 to 1 for a cover that begins at 1.
    [[nodiscard]] double mean() const noexcept { return mean_; }

    /// Bounded: a brush with more texels than `most` becomes smaller; one smaller than the
    /// texels becomes larger.
    void apply(const BrushStroke& stroke) noexcept;

    // Tiles, for copies of the texture:
    [[nodiscard]] uint32_t tilesAcross() const { return (size_.width + kTile - 1) / kTile; }
    [[nodiscard]] uint32_t tiles() const { return tilesAcross() * ((size_.height + kTile - 1) / kTile); }
    /// The texture's revision at which the tile changed last; 0: never.
    [[nodiscard]] uint64_t tileRevision(uint32_t tile) const { return tileRevisions_[tile]; }
    [[nodiscard]] uint64_t revision() const { return revision_; }
    struct Place {
        uint32_t x = 0, y = 0, width = 0, height = 0; ///< texels
    };
    [[nodiscard]] Place placeOf(uint32_t tile) const;
    /// Row by row, as many as its place has; off the servo.
    [[nodiscard]] std::vector<float> tileValues(uint32_t tile) const;
    /// False where there are not as many, or one is not finite.
    [[nodiscard]] bool setTile(uint32_t tile, std::span<const float> values);
    /// Every texel has the initial value, whatever it began with; every tile counts as changed.
    void reset();
    /// After setTile and reset: the mean anew.
    void settle();

  private:
    [[nodiscard]] bool gather(const BrushStroke& stroke) noexcept;

    std::shared_ptr<const TexelMap> map_;
    PersistentTextureSize size_;
    std::shared_ptr<const std::vector<float>> start_;
    std::vector<float> values_;
    std::vector<uint64_t> tileRevisions_;
    uint64_t revision_ = 0;
    double mean_ = 0.0;
    std::unique_ptr<TexelMap::Reached> reached_;
};

} // namespace touchstone
