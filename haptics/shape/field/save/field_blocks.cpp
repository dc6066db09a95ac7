#include "haptics/shape/field/save/field_blocks.h"

#include "engine/grid/sparse_grid.h"
#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/save/field_faces.h"

#include <algorithm>
#include <memory>
#include <set>

namespace touchstone {

namespace {

/// The grid's nodes of a block and one more cell on every side; grid coordinates as index space. Null where
/// no surface passes.
std::unique_ptr<SparseGrid> gridOfBlock(const FieldGrid& field, const glm::ivec3& first, int side) {
    const glm::ivec3 low = glm::max(first - 1, glm::ivec3(0));
    const glm::ivec3 high = glm::min(first + side + 1, field.layout().cells);
    const glm::ivec3 size = high - low + 1;
    std::vector<float> values(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) *
                              static_cast<size_t>(size.z));
    field.copyNodes(low, size, values);
    const auto [least, most] = std::ranges::minmax(values);
    if (!(least < 0.0f) || most < 0.0f)
        return nullptr;
    auto grid = gridLibrary().create(static_cast<float>(field.outside()), 1);
    grid->setBox(low, size, values);
    return grid;
}

/// The faces of a block.
FieldBlocks::Block blockOf(const std::shared_ptr<const FieldGrid>& grid, const glm::ivec3& block,
                           const FieldColors* colors) {
    constexpr int kBlock = FieldBlocks::kBlock;
    FieldBlocks::Block made;
    const std::unique_ptr<SparseGrid> nodes = gridOfBlock(*grid, kBlock * block, kBlock);
    if (nodes == nullptr)
        return made;
    GridFaces zero = nodes->zero();
    // A quad belongs to the block that has its edge of the grid.
    std::erase_if(zero.quads, [&](const GridFaces::Quad& quad) {
        const glm::ivec3 owner = cellsOf(zero, quad).high;
        return glm::any(glm::lessThan(owner, kBlock * block)) ||
               glm::any(glm::greaterThanEqual(owner, kBlock * (block + 1)));
    });
    const FieldShape shape(grid);
    const FieldLayout& layout = grid->layout();
    const FieldFaces faces = facesOf(*grid, zero);
    std::vector<uint32_t> renumbered(faces.vertices.size(), UINT32_MAX);
    for (const uint32_t corner : faces.corners) {
        uint32_t& number = renumbered[corner];
        if (number == UINT32_MAX) {
            number = static_cast<uint32_t>(made.positions.size());
            const glm::dvec3 place = layout.origin + layout.voxel * faces.vertices[corner];
            const glm::dvec3 normal = shape.shadingNormal(0, place);
            made.positions.emplace_back(place);
            if (colors != nullptr)
                made.colors.push_back(colors->at(place));
            made.normals.emplace_back(glm::dot(normal, normal) > 0.0 ? normal : glm::dvec3(0.0, 1.0, 0.0));
        }
        made.corners.push_back(number);
    }
    return made;
}

} // namespace

size_t FieldBlocks::update(const std::shared_ptr<const FieldGrid>& grid, std::span<const uint32_t> changed,
                           const FieldColors* colors) {
    constexpr int kBricks = kBlock / kBrickCells;
    count_ = (grid->bricks() + kBricks - 1) / kBricks;
    std::set<uint32_t> dirty;
    const auto numberOf = [&](const glm::ivec3& block) {
        return static_cast<uint32_t>(block.x + count_.x * (block.y + count_.y * block.z));
    };
    if (!meshed_) {
        for (uint32_t k = 0; k < static_cast<uint32_t>(count_.x * count_.y * count_.z); ++k)
            dirty.insert(k);
    } else {
        const glm::ivec3 bricks = grid->bricks();
        for (const uint32_t number : changed) {
            const int n = static_cast<int>(number);
            const glm::ivec3 brick(n % bricks.x, n / bricks.x % bricks.y, n / bricks.x / bricks.y);
            // A block's faces reach a cell into its neighbours: a brick at its border concerns both.
            const glm::ivec3 low = glm::max(brick - 1, glm::ivec3(0)) / kBricks;
            const glm::ivec3 high = glm::min(brick + 1, bricks - 1) / kBricks;
            for (int z = low.z; z <= high.z; ++z)
                for (int y = low.y; y <= high.y; ++y)
                    for (int x = low.x; x <= high.x; ++x)
                        dirty.insert(numberOf({x, y, z}));
        }
    }
    meshed_ = true;
    for (const uint32_t number : dirty) {
        const int n = static_cast<int>(number);
        blocks_.erase(number);
        Block made = blockOf(grid, {n % count_.x, n / count_.x % count_.y, n / count_.x / count_.y}, colors);
        if (!made.corners.empty())
            blocks_.emplace(number, std::move(made));
    }
    return dirty.size();
}

} // namespace touchstone
