#include "haptics/shape/field/sculpt/closest_points.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

bool ClosestPoints::border(const glm::ivec3& node) const {
    return glm::any(glm::lessThan(node, glm::ivec3(1))) || glm::any(glm::greaterThan(node, window_.size - 2));
}

bool ClosestPoints::near(const glm::ivec3& node) const {
    if (border(node))
        return false;
    const float* const here = window_.value.data() + window_.index(node);
    const ptrdiff_t sy = window_.step(1), sz = window_.step(2);
    const bool inside = *here < 0.0f;
    for (ptrdiff_t z = -sz; z <= sz; z += sz)
        for (ptrdiff_t y = -sy; y <= sy; y += sy)
            for (ptrdiff_t x = -1; x <= 1; ++x)
                if ((here[x + y + z] < 0.0f) != inside)
                    return true;
    return false;
}

glm::dvec3 ClosestPoints::gradientBefore(const glm::ivec3& node) const {
    if (border(node))
        return glm::dvec3(0.0);
    const float* const here = window_.before.data() + window_.index(node);
    const auto slope = [&](ptrdiff_t step) {
        return (static_cast<double>(here[step]) - static_cast<double>(here[-step])) / (2.0 * window_.voxel);
    };
    return {slope(1), slope(window_.step(1)), slope(window_.step(2))};
}

void ClosestPoints::find(const glm::dvec3& place, Cell& cell) const {
    const glm::ivec3 at = glm::clamp(glm::ivec3(glm::floor(place)), glm::ivec3(0), window_.size - 2);
    if (at == cell.at)
        return;
    cell.at = at;
    std::array<float, 8> value;
    if (window_.cellIsActive(at)) {
        const float* const low = window_.value.data() + window_.index(at);
        const ptrdiff_t sy = window_.step(1), sz = window_.step(2);
        value = {low[0], low[1], low[sy], low[sy + 1], low[sz], low[sz + 1], low[sz + sy], low[sz + sy + 1]};
    } else if (at.x % kBrickCells + 1 < kBrickCells) { // both nodes of each row belong to one brick
        window_.grid->copyNodes(window_.first + at, glm::ivec3(2), value);
    } else {
        for (int k = 0; k < 8; ++k)
            value[static_cast<size_t>(k)] = static_cast<float>(
                window_.grid->node(window_.first + at + glm::ivec3(k & 1, k >> 1 & 1, k >> 2)));
    }
    std::array<double, 8> node;
    int negative = 0;
    for (size_t k = 0; k < 8; ++k) {
        negative += value[k] < 0.0f ? 1 : 0;
        node[k] = static_cast<double>(value[k]) / window_.voxel;
    }
    cell.crossed = negative != 0 && negative != 8;
    cell.values = FieldCell::between(node);
}

double ClosestPoints::valueAt(const glm::dvec3& place, Cell& cell) const {
    find(place, cell);
    return cell.values.value(place - glm::dvec3(cell.at));
}

/// How far the first change of sign along a unit direction is; INFINITY where there is none before `most`.
double ClosestPoints::along(const glm::ivec3& node, const glm::dvec3& direction, double most) const {
    constexpr double kStep = 0.5;
    constexpr int kHalvings = 20;
    const glm::dvec3 place(node);
    const bool inside = window_.value[window_.index(node)] < 0.0f;
    Cell cell;
    for (double begin = 0.0; begin < most; begin += kStep) {
        double end = std::min(begin + kStep, most);
        if ((valueAt(place + end * direction, cell) < 0.0) == inside)
            continue;
        double from = begin;
        for (int i = 0; i < kHalvings; ++i) {
            const double middle = 0.5 * (from + end);
            ((valueAt(place + middle * direction, cell) < 0.0) == inside ? from : end) = middle;
        }
        return 0.5 * (from + end);
    }
    return INFINITY;
}

glm::dvec3 ClosestPoints::fromNear(const glm::ivec3& node) const {
    const float* const here = window_.value.data() + window_.index(node);
    const ptrdiff_t sy = window_.step(1), sz = window_.step(2);
    const auto value = static_cast<double>(*here);
    const bool inside = value < 0.0;
    double nearest = INFINITY;
    glm::dvec3 point(node);
    for (int z = -1; z <= 1; ++z)
        for (int y = -1; y <= 1; ++y)
            for (int x = -1; x <= 1; ++x) {
                const auto other = static_cast<double>(here[x + y * sy + z * sz]);
                if ((other < 0.0) == inside)
                    continue;
                const glm::dvec3 way = value / (value - other) * glm::dvec3(x, y, z);
                if (const double distance = glm::length(way); distance < nearest) {
                    nearest = distance;
                    point = glm::dvec3(node) + way;
                }
            }
    const auto slope = [&](ptrdiff_t step) {
        return static_cast<double>(here[step]) - static_cast<double>(here[-step]);
    };
    const glm::dvec3 gradient(slope(1), slope(sy), slope(sz));
    if (const double steep = glm::length(gradient); steep > 0.0 && nearest > 0.0 && nearest < INFINITY) {
        const glm::dvec3 direction = gradient * ((inside ? 1.0 : -1.0) / steep);
        if (const double distance = along(node, direction, nearest); distance < nearest)
            point = glm::dvec3(node) + distance * direction;
    }
    return slid(glm::dvec3(node), slid(glm::dvec3(node), point));
}

std::optional<glm::dvec3> ClosestPoints::onSurface(const glm::dvec3& point) const {
    constexpr double kOff = 0.01, kFar = 1.0; // voxels
    constexpr int kSteps = 4;
    glm::dvec3 place = point;
    Cell cell;
    for (int i = 0; i < kSteps; ++i) {
        find(place, cell);
        const glm::dvec3 u = place - glm::dvec3(cell.at), slope = cell.values.gradient(u);
        const double value = cell.values.value(u), squared = glm::dot(slope, slope);
        if (std::abs(value) <= kOff)
            return place;
        if (!(squared > 0.01))
            break;
        place -= value * slope / squared;
        if (!(glm::distance(place, point) <= kFar))
            break;
    }
    return std::nullopt;
}

glm::dvec3 ClosestPoints::slid(const glm::dvec3& from, const glm::dvec3& point) const {
    constexpr double kOff = 0.01; // voxels: counts as on the surface
    Cell cell;
    find(point, cell);
    const glm::dvec3 slope = cell.values.gradient(point - glm::dvec3(cell.at));
    const double steep = glm::length(slope);
    if (!cell.crossed || !(steep > 0.1))
        return point;
    const glm::dvec3 normal = slope / steep, away = from - point;
    glm::dvec3 tangent = away - glm::dot(away, normal) * normal;
    const double length = glm::length(tangent);
    if (length > 1.0)
        tangent /= length;
    glm::dvec3 next = point + tangent;
    for (int i = 0; i < 2; ++i) {
        find(next, cell);
        const glm::dvec3 u = next - glm::dvec3(cell.at), g = cell.values.gradient(u);
        if (!cell.crossed || !(glm::dot(g, g) > 0.01))
            return point;
        next -= cell.values.value(u) * g / glm::dot(g, g);
    }
    if (std::abs(valueAt(next, cell)) > kOff || glm::distance(from, next) >= glm::distance(from, point))
        return point;
    return next;
}

} // namespace touchstone
