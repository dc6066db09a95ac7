#pragma once
// Distances from a mesh at the nodes of a field, before they become its bricks. Not for the servo thread.

#include "engine/core/progress.h"
#include "haptics/shape/field/field_grid.h"
#include "haptics/shape/field/nearest_triangles.h"
#include "haptics/shape/mesh/haptic_object.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace touchstone {

inline constexpr const char* kBuildingField = "building the distance field";

/// Blocks of 8^3 nodes: those of a brick without the ones that the next bricks have, too. OpenVDB tells
/// inside from outside, next to all of its time on one thread; beside it the blocks that lie so near to the
/// mesh that they are measured whichever side they are on are measured. Then the others are, and all get
/// their signs.
class NodeDistances {
  public:
    /// Object units: as far as distances are told behind the surface and before it.
    struct Reach {
        double inside = 0.0, outside = 0.0;
    };

    /// `closed`: negative inside; else less half of the thickness of a shell. Two threads, and those of
    /// OpenVDB. Throws Cancelled.
    NodeDistances(const HapticObject& mesh, const FieldLayout& layout, const Reach& reach, bool closed,
                  const Progress& progress);

    /// The nodes of a brick, x fastest. Those beyond the grid may be anything.
    void copyBrick(const glm::ivec3& first, std::span<float> nodes) const noexcept;

  private:
    static constexpr int kSide = FieldGrid::kBrick;
    using Nodes = std::array<float, size_t{kSide} * kSide * kSide>;
    static constexpr int kPair = 2; ///< blocks a side whose middles are measured at once
    static_assert(kPair * kPair * kPair == NearestTriangles::kPlaces);
    struct Block {
        double middle = 0.0;          ///< voxels: its distance, as far as distances are told
        std::unique_ptr<Nodes> nodes; ///< null: all are `flat`
        float flat = 0.0f;
    };
    class Sides;

    [[nodiscard]] size_t numberOf(const glm::ivec3& block) const noexcept {
        const auto nx = static_cast<size_t>(count_.x), ny = static_cast<size_t>(count_.y);
        return static_cast<size_t>(block.x) +
               nx * (static_cast<size_t>(block.y) + ny * static_cast<size_t>(block.z));
    }
    [[nodiscard]] glm::ivec3 pairs() const noexcept { return (count_ + (kPair - 1)) / kPair; }
    template <class Visit>
    void eachPairOf(size_t row, const Visit& visit) const;
    template <class Visit>
    void eachBlockOf(const glm::ivec3& pair, const Visit& visit) const;
    void measureMiddles(const glm::ivec3& pair, uint32_t& known);
    template <class ReachAt>
    void measureNodes(const glm::ivec3& block, uint32_t& known, const ReachAt& reachAt);
    void measureNear(size_t row);
    void measureRest(size_t row, const Sides& sides);
    void sign(const glm::ivec3& block, const Sides& sides);

    /// Voxels: as far as distances are told.
    [[nodiscard]] double reach(float side) const noexcept { return side < 0.0f ? farInside_ : farOutside_; }
    /// Object units: without a sign.
    [[nodiscard]] float bare(double voxels) const noexcept {
        return static_cast<float>(voxel_ * voxels - shell_);
    }
    [[nodiscard]] float valueOf(float bare, float side) const noexcept;

    double voxel_, shell_;          ///< object units
    double farInside_, farOutside_; ///< voxels
    glm::ivec3 count_;              ///< of blocks
    NearestTriangles triangles_;
    std::vector<Block> blocks_;
};

} // namespace touchstone
