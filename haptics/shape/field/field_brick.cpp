#include "haptics/shape/field/field_brick.h"

#include "engine/core/checksum.h"
#include "haptics/shape/field/vectors.h"

#include <algorithm>
#include <bit>
#include <limits>

namespace touchstone {

namespace {

static_assert(kBrickCells == 8); // the cells of a row along x are one Eight

/// The nodes at both ends of eight edges along x.
struct Row {
    Eight from, to;
    explicit Row(const float* nodes) noexcept : from(eightAt(nodes)), to(eightAt(nodes + 1)) {}
};
Eight difference(Eight a, Eight b) {
    return larger(a - b, b - a);
}
Eight along(const Row& a, const Row& b) {
    return larger(difference(a.from, b.from), difference(a.to, b.to));
}
Eight lowest(const Row& row) {
    return smaller(row.from, row.to);
}

} // namespace

/// Within a cell each component of the gradient lies between the differences along the four parallel edges.
BrickMeasure measureBrick(const glm::ivec3& first, const glm::ivec3& cells,
                          std::span<const float, kNodesInBrick> nodes) {
    constexpr size_t kRow = kBrickSide, kLayer = kRow * kBrickSide;
    BrickMeasure measure;
    Eight steepest{};
    bool any = false;
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y) {
            const float* const at = nodes.data() + brickNode({0, y, z});
            const Row a(at), b(at + kRow), c(at + kLayer), d(at + kLayer + kRow);
            const Eight dx = larger(larger(difference(a.from, a.to), difference(b.from, b.to)),
                                    larger(difference(c.from, c.to), difference(d.from, d.to))),
                        dy = larger(along(a, b), along(c, d)), dz = larger(along(a, c), along(b, d));
            const Eight steepness = dx * dx + dy * dy + dz * dz;
            const Eight least = smaller(smaller(lowest(a), lowest(b)), smaller(lowest(c), lowest(d)));
            if (cells.x == kBrickCells)
                steepest = larger(steepest, steepness);
            else
                for (int x = 0; x < cells.x; ++x)
                    measure.steepest = std::max(measure.steepest, steepness[x]);
            const uint32_t reached = lanes(least <= 0.0f) & ((1u << cells.x) - 1u);
            if (reached == 0)
                continue;
            const glm::ivec3 low = first + glm::ivec3(std::countr_zero(reached), y, z);
            const glm::ivec3 high = first + glm::ivec3(std::bit_width(reached), y + 1, z + 1);
            measure.low = any ? glm::min(measure.low, low) : low;
            measure.high = any ? glm::max(measure.high, high) : high;
            any = true;
        }
    for (int x = 0; x < kBrickCells; ++x)
        measure.steepest = std::max(measure.steepest, steepest[x]);
    return measure;
}

std::shared_ptr<const EditedBrick> editedBrick(const glm::ivec3& first, const glm::ivec3& cells,
                                               std::span<const float, kNodesInBrick> nodes) {
    auto brick = std::make_shared<EditedBrick>();
    std::ranges::copy(nodes, brick->nodes.begin());
    const bool isFlat = std::ranges::all_of(nodes, [&](float value) { return value == nodes[0]; });
    brick->flat = isFlat ? nodes[0] : std::numeric_limits<float>::quiet_NaN();
    brick->measure = measureBrick(first, cells, nodes);
    Hash64 hash;
    hash.addBytes(std::as_bytes(std::span<const float>(nodes)));
    brick->hash = hash.value();
    return brick;
}

} // namespace touchstone
