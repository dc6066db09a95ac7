#pragma once
// Where the texels of a persistent texture lie on an object: the part of the surface that each of them stands
// for, found by place, so that a brush crosses the seams of the texture coordinates.

#include "engine/core/progress.h"
#include "haptics/shape/mesh/haptic_object.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace touchstone {

/// Immutable. Lengths and areas in object units. The texture is read by bilinear interpolation, repeats, and
/// has the value v_t at the centre of texel t, so that its integral over the surface is sum A_t v_t with A_t
/// the integral of t's hat function. That of one texel over one part of the surface is a *sample*; where
/// charts overlap, or meet in one texel, the texel has several.
class TexelMap {
  public:
    /// Samples that one brush reaches, at most.
    static constexpr size_t kMaxReached = 16384;
    struct Reached {
        uint32_t count = 0;
        bool full = false; ///< there are more
        std::array<uint32_t, kMaxReached> texel;
        std::array<float, kMaxReached> weight; ///< (1 - (r / radius)^2)^2
    };

    /// Null where the object has no texture coordinates of set 0, or they repeat the texture so often that it
    /// cannot be followed. Any thread but the servo: takes some 1 s for a million texels. Throws Cancelled.
    [[nodiscard]] static std::shared_ptr<const TexelMap> of(const HapticObject& object, uint32_t width,
                                                            uint32_t height, const Progress& progress = {});

    [[nodiscard]] uint32_t width() const { return width_; }
    [[nodiscard]] uint32_t height() const { return height_; }
    /// A_t of each texel, row by row; 0 where it lies on no surface.
    [[nodiscard]] const std::vector<float>& areas() const { return areas_; }
    /// Of the surface that has a part of the texture.
    [[nodiscard]] double area() const { return area_; }
    /// Of the square that a texel covers, on average.
    [[nodiscard]] double spacing() const { return spacing_; }
    [[nodiscard]] size_t samples() const { return texel_.size(); }
    [[nodiscard]] uint64_t memoryBytes() const;

    /// The samples nearer than `radius` to `point` whose side looks within 120 degrees of `normal`, in an
    /// order that is always the same; at most `most`. On the servo: bounded by the tree's size, no
    /// allocation.
    void reach(const glm::dvec3& point, const glm::dvec3& normal, double radius, uint32_t most,
               Reached& reached) const noexcept;

  private:
    friend class TexelMapBuilder;
    static constexpr size_t kLeaf = 32;
    struct Box {
        glm::vec3 min{0.0f}, max{0.0f};
    };
    TexelMap() = default;

    uint32_t width_ = 0, height_ = 0;
    double area_ = 0.0, spacing_ = 0.0;
    std::vector<float> areas_;
    // Samples in the order of the tree:
    std::vector<float> x_, y_, z_;
    std::vector<std::array<int8_t, 3>> normal_; ///< of 127
    std::vector<uint32_t> texel_;
    std::vector<Box>
        boxes_; ///< a heap: node i has the children 2 i + 1 and 2 i + 2, each half of its samples
};

} // namespace touchstone
