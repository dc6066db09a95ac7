#include "haptics/shape/field/sculpt/tool_values.h"

#include "haptics/shape/field/field_shape.h"
#include "haptics/shape/field/vectors.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>

namespace touchstone {

namespace {

/// Of the values before the dab, between nodes; of the nearest place in the window from outside of it.
double interpolatedBefore(const FieldWindow& window, const glm::dvec3& place) {
    const glm::dvec3 inside = glm::clamp(place, glm::dvec3(0.0), glm::dvec3(window.size - 1));
    const glm::ivec3 cell = glm::min(glm::ivec3(inside), window.size - 2);
    std::array<double, 8> node{};
    for (int k = 0; k < 8; ++k)
        node[static_cast<size_t>(k)] =
            static_cast<double>(window.before[window.index(cell + glm::ivec3(k & 1, k >> 1 & 1, k >> 2))]);
    return FieldCell::between(node).value(inside - glm::dvec3(cell));
}

/// The values in the zone's box after `rounds` passes of the binomial filter 1-2-1 along each axis: each adds
/// half a voxel^2 of variance an axis. Values outside of the box are those before the dab.
class Smoothed {
  public:
    Smoothed(const FieldWindow& window, const SculptZone& zone)
        : low_(zone.low(0.0, 0)), size_(zone.high(window, 0.0, 0) - low_ + 1) {
        constexpr int kRounds = 4;
        for (int z = 0; z < size_.z; ++z)
            for (int y = 0; y < size_.y; ++y)
                for (int x = 0; x < size_.x; ++x)
                    values_.push_back(
                        static_cast<double>(window.before[window.index(low_ + glm::ivec3(x, y, z))]));
        for (int round = 0; round < kRounds; ++round)
            for (int axis = 0; axis < 3; ++axis)
                filter(axis);
    }
    [[nodiscard]] double at(const glm::ivec3& node) const { return values_[indexOf(node - low_)]; }

  private:
    [[nodiscard]] size_t indexOf(const glm::ivec3& at) const {
        return static_cast<size_t>(at.x + size_.x * (at.y + size_.y * at.z));
    }
    /// The ends of each row stay.
    void filter(int axis) {
        glm::ivec3 step(0);
        step[axis] = 1;
        const size_t stride = indexOf(step);
        for (int z = 0; z < size_.z; ++z)
            for (int y = 0; y < size_.y; ++y)
                for (int x = 0; x < size_.x; ++x) {
                    if (const glm::ivec3 at(x, y, z); at[axis] == 0) {
                        double previous = values_[indexOf(at)];
                        for (int i = 1; i + 1 < size_[axis]; ++i) {
                            double& here = values_[indexOf(at) + static_cast<size_t>(i) * stride];
                            const double own = here;
                            here = 0.25 * (previous +
                                           values_[indexOf(at) + static_cast<size_t>(i + 1) * stride]) +
                                   0.5 * own;
                            previous = own;
                        }
                    }
                }
    }

    glm::ivec3 low_, size_;
    std::vector<double> values_;
};

/// The other solid of a tool that joins or takes out one: negative inside, object units.
class ToolSolid {
  public:
    explicit ToolSolid(const Dab& dab) : dab_(dab) {
        if (dab.stamp == nullptr)
            return;
        const glm::dvec3 extent = dab.stamp->high() - dab.stamp->low();
        middle_ = 0.5 * (dab.stamp->low() + dab.stamp->high());
        perUnit_ = 0.5 * std::max({extent.x, extent.y, extent.z}) / dab.radius;
        stamp_.emplace(dab.stamp);
    }
    [[nodiscard]] double distance(const glm::dvec3& away) const {
        return stamp_ ? stamp_->value(middle_ + perUnit_ * away) / perUnit_ : glm::length(away) - dab_.radius;
    }

  private:
    const Dab& dab_;
    glm::dvec3 middle_{0.0};
    double perUnit_ = 1.0;
    std::optional<FieldShape> stamp_;
};

/// Signed distance of a node from a box half a voxel inside of the grid, as far as it matters: object units.
double borderDistance(const FieldGrid& grid, const glm::ivec3& node) {
    const glm::ivec3 within = glm::min(node, grid.layout().cells - node);
    return (0.5 - std::min({within.x, within.y, within.z})) * grid.layout().voxel;
}

/// wholeBall in at most eight nodes of a row.
void wholeBallRow(float* values, const glm::ivec3& first, int count, const SculptZone& zone, bool carves,
                  float voxel, float radius) {
    std::array<float, kBrickCells> nodes{};
    copyRow(values, count, nodes.data());
    const Eight value = eightAt(nodes.data());
    const uint32_t negative = lanes(value < 0.0f),
                   own = (carves ? negative : ~negative) & ((1u << count) - 1u);
    if (own == 0)
        return;
    const glm::vec3 centre(zone.centre), at(first);
    const Eight x = at.x + kLane - centre.x;
    const float y = at.y - centre.y, z = at.z - centre.z;
    const Eight ball = voxel * root(x * x + y * y + z * z) - radius;
    const Eight next = carves ? larger(value, -ball) : smaller(value, ball);
    for (uint32_t changed = own & lanes(next != value); changed != 0; changed &= changed - 1) {
        const int i = std::countr_zero(changed);
        if (!zone.contains(first + glm::ivec3(i, 0, 0)))
            values[i] = next[i];
    }
}

/// The side where a whole ball's distance is exact, and its values outside of the zone.
ExactSide wholeBall(FieldWindow& window, const Dab& dab, const SculptZone& zone) {
    if (!isWholeBall(dab))
        return ExactSide::None;
    const bool carves = dab.tool == SculptTool::Carve;
    const auto voxel = static_cast<float>(window.voxel), radius = static_cast<float>(dab.radius);
    window.eachActiveRow([&](const glm::ivec3& first, size_t index, int count) {
        for (int i = 0; i < count; i += kBrickCells)
            wholeBallRow(&window.value[index + static_cast<size_t>(i)], first + glm::ivec3(i, 0, 0),
                         std::min(count - i, kBrickCells), zone, carves, voxel, radius);
    });
    return carves ? ExactSide::Inside : ExactSide::Outside;
}

} // namespace

bool isWholeBall(const Dab& dab) {
    return (dab.tool == SculptTool::Carve || dab.tool == SculptTool::Add) && dab.strength == 1.0 &&
           dab.falloff == 0.0;
}

double changedRadius(const FieldGrid& grid, const Dab& dab) {
    const double room = 2.0 * grid.layout().voxel;
    if (dab.tool != SculptTool::Stamp && dab.tool != SculptTool::Imprint)
        return dab.radius + room;
    const glm::dvec3 extent = dab.stamp->high() - dab.stamp->low();
    return dab.radius * glm::length(extent) / std::max({extent.x, extent.y, extent.z}) + room;
}

ExactSide applyTool(FieldWindow& window, const FieldGrid& grid, const Dab& dab, const SculptZone& zone) {
    const glm::ivec3 low = zone.low(0.0, 0), high = zone.high(window, 0.0, 0);
    if (glm::any(glm::greaterThan(low, high)))
        return ExactSide::None;
    const ToolSolid solid(dab);
    std::optional<Smoothed> smoothed;
    if (dab.tool == SculptTool::Smooth)
        smoothed.emplace(window, zone);
    const auto changed = [&](const glm::ivec3& node, const glm::dvec3& away, double f) {
        const double share = dab.strength * dabWeight(dab, glm::length(away) / dab.radius);
        switch (dab.tool) {
        case SculptTool::Carve:
        case SculptTool::Imprint:
            return f + share * (std::max(f, -solid.distance(away)) - f);
        case SculptTool::Add:
        case SculptTool::Stamp:
            return f + share * (std::min(f, solid.distance(away)) - f);
        case SculptTool::Smooth:
            return f + share * (smoothed->at(node) - f);
        case SculptTool::Paint: // values stay
            return f;
        case SculptTool::Drag:
            break;
        }
        return interpolatedBefore(window, glm::dvec3(node) - share * dab.motion / window.voxel);
    };
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                const glm::ivec3 node(x, y, z);
                if (!zone.contains(node))
                    continue;
                const size_t index = window.index(node);
                const auto f = static_cast<double>(window.before[index]);
                double g = changed(node, window.voxel * (glm::dvec3(node) - zone.centre), f);
                if (g < f)
                    g = std::min(f, std::max(g, borderDistance(grid, window.first + node)));
                window.value[index] = static_cast<float>(g);
            }
    return wholeBall(window, dab, zone);
}

} // namespace touchstone
