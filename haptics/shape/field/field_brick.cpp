#include "haptics/shape/field/field_brick.h"

#include "engine/core/checksum.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {

/// Within a cell each component of the gradient lies between the differences along the four parallel edges.
BrickMeasure measureBrick(const glm::ivec3& first, const glm::ivec3& cells,
                          std::span<const float, kNodesInBrick> nodes) {
    constexpr size_t kStep[] = {1, kBrickSide, size_t{kBrickSide} * kBrickSide};
    constexpr size_t kRow = kStep[1], kLayer = kStep[2];
    BrickMeasure measure;
    bool any = false;
    for (int z = 0; z < cells.z; ++z)
        for (int y = 0; y < cells.y; ++y)
            for (int x = 0; x < cells.x; ++x) {
                const float* const at = nodes.data() + brickNode({x, y, z});
                float sum = 0.0f;
                for (size_t axis = 0; axis < 3; ++axis) {
                    const size_t d = kStep[axis], b = kStep[(axis + 1) % 3], c = kStep[(axis + 2) % 3];
                    const float edge =
                        std::max(std::max(std::abs(at[d] - at[0]), std::abs(at[d + b] - at[b])),
                                 std::max(std::abs(at[d + c] - at[c]), std::abs(at[d + b + c] - at[b + c])));
                    sum += edge * edge;
                }
                measure.steepest = std::max(measure.steepest, sum);
                const float lowest =
                    std::min(std::min(std::min(at[0], at[1]), std::min(at[kRow], at[kRow + 1])),
                             std::min(std::min(at[kLayer], at[kLayer + 1]),
                                      std::min(at[kLayer + kRow], at[kLayer + kRow + 1])));
                if (lowest > 0.0f)
                    continue;
                const glm::ivec3 cell = first + glm::ivec3(x, y, z);
                measure.low = any ? glm::min(measure.low, cell) : cell;
                measure.high = any ? glm::max(measure.high, cell + 1) : cell + 1;
                any = true;
            }
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
