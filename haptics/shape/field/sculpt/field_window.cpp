#include "haptics/shape/field/sculpt/field_window.h"

#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace touchstone {

namespace {

/// |f| of no node of the brick is larger, voxels.
double largestDistance(const FieldGrid& grid, const glm::ivec3& brick) {
    std::array<float, kNodesInBrick> nodes;
    grid.copyBrick(brick, nodes);
    float largest = 0.0f;
    for (const float value : nodes)
        largest = std::max(largest, std::abs(value));
    return static_cast<double>(largest) / grid.layout().voxel;
}

void activate(FieldWindow& window, const FieldGrid& grid, const SculptZone& zone) {
    constexpr double kAround = 4.0;     // voxels: what the tools and the search of the surface read
    constexpr double kRoom = 1.5;       // voxels: a nearest place is known to a voxel
    constexpr double kAcrossHalf = 8.0; // voxels: half a brick's diagonal is 6.9, and f is a distance
    window.isActive.assign(static_cast<size_t>(window.bricks.x) * static_cast<size_t>(window.bricks.y) *
                               static_cast<size_t>(window.bricks.z),
                           0);
    window.active.clear();
    for (int z = 0; z < window.bricks.z; ++z)
        for (int y = 0; y < window.bricks.y; ++y)
            for (int x = 0; x < window.bricks.x; ++x) {
                const glm::ivec3 brick(x, y, z), inGrid = window.first / kBrickCells + brick;
                const glm::dvec3 low(kBrickCells * brick), high(window.lastNode(brick));
                const glm::dvec3 away = glm::max(glm::max(low - zone.centre, zone.centre - high), 0.0);
                if (std::max({away.x, away.y, away.z}) > zone.radius + kAround) {
                    const double beyond = glm::length(away) - zone.radius - kRoom;
                    const glm::ivec3 middle =
                        glm::min(kBrickCells * inGrid + kBrickCells / 2, grid.layout().cells);
                    if (beyond > std::abs(grid.node(middle)) / window.voxel + kAcrossHalf ||
                        beyond > largestDistance(grid, inGrid))
                        continue;
                }
                window.isActive[window.brickIndex(brick)] = 1;
                window.active.push_back(brick);
            }
}

/// Calls visit(first node, index, count) for each row of the nodes that have values: runs of active bricks
/// along the first axis, with two nodes around.
template <class Visit>
void eachFilledRow(const FieldWindow& window, const Visit& visit) {
    for (size_t i = 0; i < window.active.size();) {
        const glm::ivec3 from = window.active[i];
        glm::ivec3 to = from;
        while (++i < window.active.size() && window.active[i] == to + glm::ivec3(1, 0, 0))
            to = window.active[i];
        const glm::ivec3 low = glm::max(kBrickCells * from - 2, glm::ivec3(0));
        const glm::ivec3 high = glm::min(kBrickCells * (to + 1) + 2, window.size - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                visit(glm::ivec3(low.x, y, z), window.index({low.x, y, z}), high.x - low.x + 1);
    }
}

/// `count` values from a node on.
std::span<float> rowOf(std::vector<float>& values, size_t index, int count) {
    return std::span(values).subspan(index, static_cast<size_t>(count));
}

} // namespace

glm::ivec3 SculptZone::low(double margin, int spare) const noexcept {
    constexpr double kBeyond = 1e9; // beyond every window, and an int
    return glm::ivec3(
        glm::clamp(glm::floor(centre - radius - margin), glm::dvec3(spare), glm::dvec3(kBeyond)));
}

glm::ivec3 SculptZone::high(const FieldWindow& window, double margin, int spare) const noexcept {
    return glm::ivec3(glm::clamp(glm::ceil(centre + radius + margin), glm::dvec3(-1.0),
                                 glm::dvec3(window.size - 1 - spare)));
}

bool ballMisses(const FieldGrid& grid, const glm::dvec3& centre, double radius) noexcept {
    const glm::dvec3 middle = grid.gridFromObject(centre);
    const glm::dvec3 nearest = glm::clamp(middle, glm::dvec3(0.0), glm::dvec3(grid.layout().cells));
    return !(glm::distance(middle, nearest) <= radius / grid.layout().voxel);
}

void placeWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre, double radius,
                 double margin) {
    const glm::dvec3 middle = grid.gridFromObject(centre), last(grid.layout().cells);
    const double reach = radius / grid.layout().voxel + margin;
    window.grid = &grid;
    window.voxel = grid.layout().voxel;
    const glm::ivec3 low(glm::clamp(glm::floor(middle - reach), glm::dvec3(0.0), last));
    const glm::ivec3 high(glm::clamp(glm::ceil(middle + reach), glm::dvec3(0.0), last));
    const glm::ivec3 firstBrick = glm::min(low / kBrickCells, grid.bricks() - 1);
    window.bricks = glm::min(high / kBrickCells, grid.bricks() - 1) - firstBrick + 1;
    window.first = kBrickCells * firstBrick;
    window.size =
        glm::min(kBrickCells * (firstBrick + window.bricks), grid.layout().cells) - window.first + 1;
    if (window.nodes() > kMostWindowNodes)
        throw Error("sculpting", "",
                    "the tool changes up to " + std::to_string(window.nodes()) + " nodes at once, of which " +
                        std::to_string(kMostWindowNodes) + " fit",
                    "choose a smaller radius");
}

SculptZone fillWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre, double radius,
                      double margin) {
    placeWindow(window, grid, centre, radius, margin);
    window.before.resize(window.nodes());
    window.value.resize(window.nodes());
    const SculptZone zone{grid.gridFromObject(centre) - glm::dvec3(window.first),
                          radius / grid.layout().voxel};
    activate(window, grid, zone);
    eachFilledRow(window, [&](const glm::ivec3& first, size_t index, int count) {
        grid.copyNodes(window.first + first, {count, 1, 1}, rowOf(window.before, index, count));
        std::ranges::copy(rowOf(window.before, index, count), &window.value[index]);
    });
    return zone;
}

void fillValues(FieldWindow& window, const FieldGrid& now) {
    eachFilledRow(window, [&](const glm::ivec3& first, size_t index, int count) {
        now.copyNodes(window.first + first, {count, 1, 1}, rowOf(window.value, index, count));
    });
}

std::vector<NodeBox> changedNodes(const FieldWindow& window) {
    std::vector<NodeBox> boxes;
    for (const glm::ivec3& brick : window.active) {
        const glm::ivec3 low = kBrickCells * brick, high = window.lastNode(brick);
        NodeBox box;
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y) {
                const size_t row = window.index({0, y, z});
                for (int x = low.x; x <= high.x; ++x)
                    if (window.value[row + static_cast<size_t>(x)] !=
                        window.before[row + static_cast<size_t>(x)])
                        box.include({x, y, z});
            }
        if (!box.empty())
            boxes.push_back(box);
    }
    return boxes;
}

} // namespace touchstone
