#include "devices/surface/near_triangles.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>

namespace touchstone {

namespace {

/// The space within `reach` of a set of points, as cells of a 64^3 grid with one bit each.
class Corridor {
  public:
    Corridor(std::span<const glm::dvec3> points, double reach) {
        Bounds bounds;
        for (const glm::dvec3& p : points)
            bounds.include(p);
        low_ = bounds.low - reach;
        high_ = bounds.high + reach;
        perMetre_ = static_cast<double>(kSide) / glm::max(high_ - low_, glm::dvec3(1e-300));
        rows_.assign(kSide * kSide, 0);
        for (const glm::dvec3& p : points) {
            const Range range = rangeOf(p - reach, p + reach);
            for (uint32_t z = range.first.z; z <= range.last.z; ++z)
                for (uint32_t y = range.first.y; y <= range.last.y; ++y)
                    rows_[z * kSide + y] |= range.mask;
        }
    }
    [[nodiscard]] bool meets(const glm::dvec3& low, const glm::dvec3& high) const {
        if (low.x > high_.x || low.y > high_.y || low.z > high_.z || high.x < low_.x || high.y < low_.y ||
            high.z < low_.z)
            return false;
        const Range range = rangeOf(low, high);
        for (uint32_t z = range.first.z; z <= range.last.z; ++z)
            for (uint32_t y = range.first.y; y <= range.last.y; ++y)
                if ((rows_[z * kSide + y] & range.mask) != 0)
                    return true;
        return false;
    }

  private:
    static constexpr uint32_t kSide = 64;
    struct Range {
        glm::uvec3 first, last;
        uint64_t mask; // of the cells along x
    };
    [[nodiscard]] glm::uvec3 cell(const glm::dvec3& p) const {
        return glm::uvec3(glm::clamp((p - low_) * perMetre_, glm::dvec3(0.0), glm::dvec3(kSide - 1)));
    }
    [[nodiscard]] Range rangeOf(const glm::dvec3& low, const glm::dvec3& high) const {
        const glm::uvec3 first = cell(low), last = cell(high);
        return {first, last, (~uint64_t{0} >> (63u - last.x)) & (~uint64_t{0} << first.x)};
    }

    glm::dvec3 low_, high_, perMetre_;
    std::vector<uint64_t> rows_;
};

} // namespace

NearTriangles::NearTriangles(const TriangleSource& triangles, std::span<const glm::dvec3> points,
                             double reach)
    : slack_(1e-3 * reach) {
    if (points.empty())
        return;
    const Corridor corridor(points, reach);
    triangles([&](const SurfaceTriangle& t) {
        if (corridor.meets(glm::min(t.a, glm::min(t.b, t.c)), glm::max(t.a, glm::max(t.b, t.c))))
            triangles_.push_back(t);
    });
    if (triangles_.empty())
        return;
    std::vector<Item> items;
    items.reserve(triangles_.size());
    for (uint32_t i = 0; i < triangles_.size(); ++i) // three times the centroid: only compared
        items.push_back({glm::vec3(triangles_[i].a + triangles_[i].b + triangles_[i].c), i});
    build(items);
    std::vector<SurfaceTriangle> ordered;
    ordered.reserve(items.size());
    for (const Item& item : items)
        ordered.push_back(triangles_[item.triangle]);
    triangles_ = std::move(ordered);
}

void NearTriangles::build(std::span<Item> items) {
    constexpr size_t kLeaf = 8;
    const size_t at = nodes_.size();
    nodes_.emplace_back();
    if (items.size() <= kLeaf) {
        Bounds bounds;
        for (const Item& item : items)
            for (const glm::dvec3& p :
                 {triangles_[item.triangle].a, triangles_[item.triangle].b, triangles_[item.triangle].c})
                bounds.include(p);
        const auto last = static_cast<uint32_t>(built_ += items.size());
        nodes_[at] = {bounds.low, bounds.high, last - static_cast<uint32_t>(items.size()), last, 0};
    } else {
        glm::vec3 low(items[0].middle), high(items[0].middle);
        for (const Item& item : items) {
            low = glm::min(low, item.middle);
            high = glm::max(high, item.middle);
        }
        const glm::vec3 extent = high - low;
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
        const size_t half = items.size() / 2;
        std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                         [axis](const Item& a, const Item& b) { return a.middle[axis] < b.middle[axis]; });
        build(items.first(half));
        const size_t second = nodes_.size();
        build(items.subspan(half));
        nodes_[at].low = glm::min(nodes_[at + 1].low, nodes_[second].low);
        nodes_[at].high = glm::max(nodes_[at + 1].high, nodes_[second].high);
    }
    nodes_[at].next = static_cast<uint32_t>(nodes_.size());
}

} // namespace touchstone
