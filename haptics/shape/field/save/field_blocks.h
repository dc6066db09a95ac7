#pragma once
// The surface of a field as it changes, block by block: for the eye. Not for the servo thread.

#include "haptics/shape/field/field_colors.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

namespace touchstone {

/// Meshes blocks of kBlock^3 cells by dual contouring (facesOf), each with a margin of a cell,
/// and keeps the faces whose edge of the grid belongs to the block: the blocks meet without a gap. One
/// thread.
class FieldBlocks {
  public:
    static constexpr int kBlock = 32; ///< cells a side

    /// Meshes anew what differs: the blocks that hold one of the bricks (FieldGrid::brickNumber), all of them
    /// at the first call. Returns their number.
    /// `colors`: of the surface; null where it is not painted.
    size_t update(const std::shared_ptr<const FieldGrid>& grid, std::span<const uint32_t> changed,
                  const FieldColors* colors = nullptr);

    struct Block {
        std::vector<glm::vec3> positions, normals; ///< object frame; unit, outwards
        std::vector<glm::vec3> colors;             ///< linear; empty without paint
        std::vector<uint32_t> corners;             ///< 3 a triangle, counter-clockwise from outside
    };
    /// Of those with triangles.
    [[nodiscard]] const std::map<uint32_t, Block>& blocks() const { return blocks_; }

  private:
    std::map<uint32_t, Block> blocks_;
    glm::ivec3 count_{0}; ///< blocks on each axis
    bool meshed_ = false;
};

} // namespace touchstone
