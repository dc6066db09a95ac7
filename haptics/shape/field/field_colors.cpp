#include "haptics/shape/field/field_colors.h"

#include "engine/core/checksum.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

glm::ivec3 FieldColors::bricksOf(const FieldLayout& layout) {
    return layout.cells / kBrickCells + 1;
}

uint32_t FieldColors::brickNumber(const FieldLayout& layout, const glm::ivec3& node) {
    const glm::ivec3 bricks = bricksOf(layout), brick = node / kBrickCells;
    return static_cast<uint32_t>(brick.x + bricks.x * (brick.y + bricks.y * brick.z));
}

size_t FieldColors::indexOf(const glm::ivec3& node) {
    const glm::ivec3 in = node % kBrickCells;
    return static_cast<size_t>(in.x + kBrickCells * (in.y + kBrickCells * in.z));
}

ColorBrickPtr FieldColors::brickOf(const ColorBrick& nodes) {
    if (std::ranges::all_of(nodes.nodes, [](const glm::vec3& color) { return color == glm::vec3(1.0f); }))
        return nullptr;
    auto brick = std::make_shared<ColorBrick>(nodes);
    Hash64 hash;
    for (const glm::vec3& color : brick->nodes)
        for (int k = 0; k < 3; ++k)
            hash.add(color[k]);
    brick->hash = hash.value();
    return brick;
}

glm::vec3 FieldColors::node(const glm::ivec3& at) const {
    const auto found = bricks_.find(brickNumber(layout_, at));
    return found != bricks_.end() ? found->second->nodes[indexOf(at)] : glm::vec3(1.0f);
}

glm::vec3 FieldColors::at(const glm::dvec3& place) const {
    const glm::dvec3 grid = (place - layout_.origin) / layout_.voxel;
    const glm::ivec3 cell(glm::floor(grid));
    glm::dvec3 color(0.0); // the weights add up to 1 in float
    const glm::dvec3 t = grid - glm::dvec3(cell);
    for (int k = 0; k < 8; ++k) {
        const glm::ivec3 corner(k & 1, k >> 1 & 1, k >> 2), node = cell + corner;
        const glm::dvec3 each = glm::mix(1.0 - t, t, glm::dvec3(corner));
        const bool inside = glm::all(glm::greaterThanEqual(node, glm::ivec3(0))) &&
                            glm::all(glm::lessThanEqual(node, layout_.cells));
        color += each.x * each.y * each.z * glm::dvec3(inside ? this->node(node) : glm::vec3(1.0f));
    }
    return glm::vec3(color);
}

uint64_t FieldColors::hash() const {
    Hash64 hash;
    for (const auto& [number, brick] : bricks_) {
        hash.add(number);
        hash.add(brick->hash);
    }
    return hash.value();
}

} // namespace touchstone
