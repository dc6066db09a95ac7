#include "haptics/shape/field/sculpt/field_window.h"

#include "engine/core/error.h"
#include "haptics/shape/field/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <string>

namespace touchstone {

namespace {

/// |f| of no node of the brick is larger, voxels.
double largestDistance(const FieldGrid& grid, const glm::ivec3& brick) {
    std::array<float, kNodesInBrick> nodes;
    grid.copyBrick(brick, nodes);
    static_assert(kNodesInBrick % 8 == 1);
    Eight largest = Eight{} + std::abs(nodes.back());
    for (size_t i = 0; i + 8 < nodes.size(); i += 8) {
        const Eight some = eightAt(&nodes[i]);
        largest = larger(largest, larger(some, -some));
    }
    float most = 0.0f;
    for (int i = 0; i < 8; ++i)
        most = std::max(most, largest[i]);
    return static_cast<double>(most) / grid.layout().voxel;
}

/// Within `margin` voxels of the zone.
void activate(FieldWindow& window, const FieldGrid& grid, const SculptZone& zone, double margin) {
    constexpr double kAround = 4.0;     // voxels: what the tools and the search of the surface read
    constexpr double kRoom = 1.5;       // voxels: a nearest place is known to a voxel
    constexpr double kAcrossHalf = 8.0; // voxels: half a brick's diagonal is 6.9, and f is a distance
    window.isActive.assign(static_cast<size_t>(window.bricks.x) * static_cast<size_t>(window.bricks.y) *
                               static_cast<size_t>(window.bricks.z),
                           0);
    window.active.clear();
    const glm::ivec3 from = zone.low(margin, 0) / kBrickCells;
    const glm::ivec3 to = glm::min(zone.high(window, margin, 0) / kBrickCells, window.bricks - 1);
    for (int z = from.z; z <= to.z; ++z)
        for (int y = from.y; y <= to.y; ++y)
            for (int x = from.x; x <= to.x; ++x) {
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

void findAround(FieldWindow& window) {
    constexpr int kAround = 2; // nodes
    window.around.clear();
    std::vector<uint32_t> found(window.isActive.size()); // 1 + index in window.around
    for (const glm::ivec3& brick : window.active) {
        const glm::ivec3 first = kBrickCells * brick - kAround, last = window.lastNode(brick) + kAround;
        const glm::ivec3 low = glm::max(brick - 1, glm::ivec3(0));
        const glm::ivec3 high = glm::min(brick + 1, window.bricks - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x) {
                    const glm::ivec3 other(x, y, z);
                    const size_t i = window.brickIndex(other);
                    if (window.isActive[i] != 0)
                        continue;
                    if (found[i] == 0) {
                        window.around.emplace_back();
                        found[i] = static_cast<uint32_t>(window.around.size());
                    }
                    NodeBox& box = window.around[found[i] - 1];
                    box.include(glm::max(kBrickCells * other, first));
                    box.include(glm::min(window.lastNode(other), last));
                }
    }
}

/// Whole rows of a box in a brick with, where the grid keeps them there, the first nodes of the next brick.
void fillRows(const FieldWindow& window, const FieldGrid& grid, const NodeBox& box,
              std::vector<float>& values) {
    const glm::ivec3 brick = glm::min(box.low / kBrickCells, window.bricks - 1), first = kBrickCells * brick;
    const auto row = static_cast<size_t>(window.step(1)), layer = static_cast<size_t>(window.step(2));
    const glm::ivec3 low(first.x, box.low.y, box.low.z), from = low - first, end = box.high - first + 1;
    float* const to = &values[window.index(low)];
    if (glm::all(glm::lessThan(brick + 1, window.bricks)))
        grid.copyRows(window.first / kBrickCells + brick, {from.y, from.z}, {end.y, end.z}, to, row, layer);
    else
        grid.copyNodes(window.first + low,
                       {std::min(kBrickSide, window.size.x - low.x), end.y - from.y, end.z - from.z}, to, row,
                       layer);
}

/// fillWindow but for the nodes.
SculptZone activeWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre, double radius,
                        double margin, double activeMargin) {
    placeWindow(window, grid, centre, radius, margin);
    window.before.resize(window.nodes());
    window.value.resize(window.nodes());
    const SculptZone zone{grid.gridFromObject(centre) - glm::dvec3(window.first),
                          radius / grid.layout().voxel};
    activate(window, grid, zone, activeMargin);
    return zone;
}

/// The nodes of active bricks and those around.
void fill(FieldWindow& window, const FieldGrid& before, const FieldGrid& now) {
    std::vector<NodeBox> filled = window.around;
    for (const glm::ivec3& brick : window.active)
        filled.push_back({kBrickCells * brick, window.lastNode(brick)});
    // Where two bricks keep a node the former one's value counts, as in FieldGrid::copyNodes.
    std::ranges::sort(filled, std::greater(), [](const NodeBox& box) { return box.low.x / kBrickCells; });
    for (const NodeBox& box : filled)
        fillRows(window, before, box, window.before);
    for (const NodeBox& box : filled)
        if (&now != &before)
            fillRows(window, now, box, window.value);
        else
            window.eachRow(box, [&](const glm::ivec3&, size_t index, int count) {
                copyRow(&window.before[index], count, &window.value[index]);
            });
}

/// Of the same bytes; false also for rows that are not 8 nodes long.
bool sameRow(const float* a, const float* b, int count) {
    return count == kBrickCells && std::memcmp(a, b, kBrickCells * sizeof(float)) == 0;
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

SculptZone fillWindow(FieldWindow& window, const FieldGrid& before, const FieldGrid& now,
                      const glm::dvec3& centre, double radius, double margin) {
    const SculptZone zone = activeWindow(window, before, centre, radius, margin, margin);
    findAround(window);
    fill(window, before, now);
    return zone;
}

SculptZone fillShapeWindow(FieldWindow& window, const FieldGrid& grid, const glm::dvec3& centre,
                           double radius, double margin, double activeMargin) {
    const SculptZone zone = activeWindow(window, grid, centre, radius, margin, activeMargin);
    window.around.clear();
    fill(window, grid, grid);
    return zone;
}

std::vector<NodeBox> changedNodes(const FieldWindow& window) {
    std::vector<NodeBox> boxes;
    for (const glm::ivec3& brick : window.active) {
        const glm::ivec3 low = kBrickCells * brick, high = window.lastNode(brick);
        NodeBox box;
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y) {
                const size_t row = window.index({low.x, y, z});
                const float *const value = &window.value[row], *const before = &window.before[row];
                const int count = high.x - low.x + 1;
                if (sameRow(value, before, count))
                    continue;
                for (int i = 0; i < count; ++i)
                    if (value[i] != before[i])
                        box.include({low.x + i, y, z});
            }
        if (!box.empty())
            boxes.push_back(box);
    }
    return boxes;
}

} // namespace touchstone
