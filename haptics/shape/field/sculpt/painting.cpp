// Colours on the journal of sculpting: the haptic painting that [002] section 6 announces.

#include "haptics/shape/field/sculpt/sculptor.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

/// Voxels from the surface up to which nodes are painted: the corners of a cell that the surface cuts are at
/// most its diagonal, 1.74, away. What lies deeper shows no colour when it is carved free.
constexpr double kPaintedBand = 2.0;

} // namespace

std::shared_ptr<const FieldColors> Sculptor::colors() {
    if (colors_ == nullptr && !painted_.empty())
        colors_ = std::make_shared<const FieldColors>(base_->layout(), painted_);
    return colors_;
}

void Sculptor::recolor(uint32_t number, const ColorBrickPtr& brick) {
    const glm::ivec3 bricks = FieldColors::bricksOf(base_->layout());
    const int n = static_cast<int>(number);
    const glm::ivec3 at(n % bricks.x, n / bricks.x % bricks.y, n / bricks.x / bricks.y);
    changed_.insert(base_->brickNumber(glm::min(at, base_->bricks() - 1)));
    if (brick == nullptr)
        painted_.erase(number);
    else
        painted_[number] = brick;
    colors_ = nullptr;
}

/// c + s w (p - c) at the nodes near the surface: s the strength, w the falloff, p the colour.
bool Sculptor::paintBrick(const glm::ivec3& brick, const Dab& dab) {
    const FieldLayout& layout = base_->layout();
    const glm::ivec3 first = kBrickCells * brick;
    const glm::ivec3 end = glm::min(first + kBrickCells, layout.cells + 1), size = end - first;
    std::array<float, size_t{kBrickCells} * kBrickCells * kBrickCells> values{};
    const std::span<float> read = std::span(values).first(
        static_cast<size_t>(size.x) * static_cast<size_t>(size.y) * static_cast<size_t>(size.z));
    grid()->copyNodes(first, size, read);
    const auto band = static_cast<float>(kPaintedBand * layout.voxel);
    if (std::ranges::none_of(read, [&](float value) { return std::abs(value) < band; }))
        return false;
    const uint32_t number = FieldColors::brickNumber(layout, first);
    const auto found = painted_.find(number);
    const ColorBrickPtr before = found != painted_.end() ? found->second : nullptr;
    ColorBrick nodes;
    nodes.nodes.fill(glm::vec3(1.0f));
    if (before != nullptr)
        nodes.nodes = before->nodes;
    bool changed = false;
    size_t i = 0;
    for (int z = first.z; z < end.z; ++z)
        for (int y = first.y; y < end.y; ++y)
            for (int x = first.x; x < end.x; ++x) {
                const float value = read[i++];
                const double rho =
                    glm::distance(layout.origin + layout.voxel * glm::dvec3(x, y, z), dab.centre) /
                    dab.radius;
                if (!(std::abs(value) < band) || rho > 1.0)
                    continue;
                glm::vec3& color = nodes.nodes[FieldColors::indexOf({x, y, z})];
                const glm::vec3 was = color;
                color = glm::mix(color, dab.color, static_cast<float>(dab.strength * dabWeight(dab, rho)));
                changed = changed || color != was;
            }
    if (!changed)
        return false;
    const ColorBrickPtr made = FieldColors::brickOf(nodes);
    const auto [place, isNew] = steps_.back().colors.try_emplace(number, Recolored{before, made});
    if (!isNew)
        place->second.after = made;
    recolor(number, made);
    return true;
}

DabReport Sculptor::paint(const Dab& dab) {
    DabReport report;
    if (ballMisses(*base_, dab.centre, dab.radius))
        return report;
    const FieldLayout& layout = base_->layout();
    const glm::dvec3 middle = base_->gridFromObject(dab.centre), last(layout.cells);
    const double reach = dab.radius / layout.voxel;
    const glm::ivec3 low = glm::ivec3(glm::clamp(middle - reach, glm::dvec3(0.0), last)) / kBrickCells;
    const glm::ivec3 high = glm::ivec3(glm::clamp(middle + reach, glm::dvec3(0.0), last)) / kBrickCells;
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x)
                report.bricks += paintBrick({x, y, z}, dab) ? 1 : 0;
    return report;
}

} // namespace touchstone
