#include "haptics/shape/field/nearest_triangles.h"

#include "haptics/shape/field/vectors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>
#include <numeric>

namespace touchstone {

namespace {

// Four places to a vector, twice, for what is told; all eight for the boxes, which only exclude.
constexpr size_t kHalves = 2;

Four within01(Four t) {
    const Four zero{}, one = zero + 1.0;
    return smaller(larger(t, zero), one);
}
/// Half of a float's last place, relative.
constexpr double kRounding = 0x1p-24;
glm::vec3 below(const glm::dvec3& p) {
    const auto down = [](double v) { return std::nextafter(static_cast<float>(v), -INFINITY); };
    return {down(p.x), down(p.y), down(p.z)};
}
glm::vec3 above(const glm::dvec3& p) {
    return -below(-p);
}

double perSquareOf(const glm::dvec3& edge) {
    const double squared = glm::dot(edge, edge);
    return squared > 0.0 ? 1.0 / squared : 0.0;
}

} // namespace

NearestTriangles::NearestTriangles(std::span<const glm::dvec3> vertices, std::span<const uint32_t> indices) {
    const size_t count = indices.size() / 3;
    std::vector<glm::dvec3> centres;
    centres.reserve(count);
    triangles_.reserve(count);
    for (size_t i = 0; i < 3 * count; i += 3) {
        const glm::dvec3 a = vertices[indices[i]], ab = vertices[indices[i + 1]] - a,
                         ac = vertices[indices[i + 2]] - a;
        const double bb = glm::dot(ab, ab), bc = glm::dot(ab, ac), cc = glm::dot(ac, ac),
                     determinant = bb * cc - bc * bc;
        const double scale = determinant > 0.0 ? 1.0 / determinant : 0.0;
        triangles_.push_back({a,
                              ab,
                              ac,
                              {perSquareOf(ab), perSquareOf(ac), perSquareOf(ac - ab)},
                              scale * glm::dvec3(cc, -bc, bb)});
        centres.push_back(a + (ab + ac) / 3.0);
    }
    std::vector<uint32_t> items(count);
    std::iota(items.begin(), items.end(), 0u);
    nodes_.reserve(2 * count);
    if (count > 0)
        build(items, centres);
}

/// Halves the items at the median along the longest side of their centres' box: the depth is the logarithm of
/// their number.
void NearestTriangles::build(std::span<uint32_t> items, std::span<const glm::dvec3> centres) {
    const size_t own = nodes_.size();
    nodes_.emplace_back();
    if (items.size() == 1) {
        const Triangle& t = triangles_[items[0]];
        const glm::dvec3 b = t.corner + t.ab, c = t.corner + t.ac;
        nodes_[own] = {below(glm::min(glm::min(t.corner, b), c)), above(glm::max(glm::max(t.corner, b), c)),
                       0, items[0]};
        return;
    }
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (const uint32_t item : items) {
        low = glm::min(low, centres[item]);
        high = glm::max(high, centres[item]);
    }
    const glm::dvec3 size = high - low;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<ptrdiff_t>(half), items.end(),
                     [&](uint32_t a, uint32_t b) {
                         return centres[a][axis] < centres[b][axis] ||
                                (centres[a][axis] == centres[b][axis] && a < b);
                     });
    const auto middle = static_cast<float>(centres[items[half]][axis]);
    build(items.first(half), centres);
    const auto right = static_cast<uint32_t>(nodes_.size());
    build(items.subspan(half), centres);
    const Node &left = nodes_[own + 1], &other = nodes_[right];
    nodes_[own] = {glm::min(left.low, other.low), glm::max(left.high, other.high), right,
                   static_cast<uint32_t>(axis), middle};
}

namespace {

/// The squared distance of four places, relative to the triangle's corner, from one triangle: from the
/// nearest place on its three edges, and from the foot of the perpendicular where that lies in it. Each of
/// them is a place on the triangle, so that rounding in a sliver makes no distance too small.
template <class Triangle>
Four squaredDistance(const Triangle& t, Four x, Four y, Four z) {
    const auto squaredFrom = [](Four dx, Four dy, Four dz) { return dx * dx + dy * dy + dz * dz; };
    const glm::dvec3 &ab = t.ab, &ac = t.ac;
    const Four b = x * ab.x + y * ab.y + z * ab.z, c = x * ac.x + y * ac.y + z * ac.z;
    const Four onB = within01(b * t.perSquare.x), onC = within01(c * t.perSquare.y);
    Four nearest = smaller(squaredFrom(x - onB * ab.x, y - onB * ab.y, z - onB * ab.z),
                           squaredFrom(x - onC * ac.x, y - onC * ac.y, z - onC * ac.z));
    const glm::dvec3 bc = ac - ab;
    const Four fx = x - ab.x, fy = y - ab.y, fz = z - ab.z;
    const Four across = within01((fx * bc.x + fy * bc.y + fz * bc.z) * t.perSquare.z);
    nearest = smaller(nearest, squaredFrom(fx - across * bc.x, fy - across * bc.y, fz - across * bc.z));
    const Four v = t.inverse.x * b + t.inverse.y * c, w = t.inverse.y * b + t.inverse.z * c;
    const Four foot = squaredFrom(x - v * ab.x - w * ac.x, y - v * ab.y - w * ac.y, z - v * ab.z - w * ac.z);
    const Four zero{};
    const auto inside = (v >= zero) & (w >= zero) & (v + w <= zero + 1.0);
    return inside ? smaller(nearest, foot) : nearest;
}

} // namespace

void NearestTriangles::lower(std::span<const glm::dvec3, kPlaces> places, std::span<double, kPlaces> squared,
                             uint32_t& known) const noexcept {
    if (triangles_.empty())
        return;
    std::array<Four, kHalves> x, y, z, bound;
    std::memcpy(bound.data(), squared.data(), sizeof bound);
    Eight nearX, nearY, nearZ, nearBound;
    double farthest = 0.0; // coordinate
    for (size_t i = 0; i < kPlaces; ++i) {
        x[i / 4][i % 4] = places[i].x;
        y[i / 4][i % 4] = places[i].y;
        z[i / 4][i % 4] = places[i].z;
        nearX[i] = static_cast<float>(places[i].x);
        nearY[i] = static_cast<float>(places[i].y);
        nearZ[i] = static_cast<float>(places[i].z);
        for (int axis = 0; axis < 3; ++axis)
            farthest = std::max(farthest, std::abs(places[i][axis]));
    }
    // A box is no nearer than its distance in floats less s: each of three coordinates is off by a rounding
    // of the place's. (d + s)² <= d² + s (d² + 1) + s². What floats add to the square is less than eight
    // roundings.
    const double s = std::numbers::sqrt3 * kRounding * farthest;
    const double wider = (1.0 + 16.0 * kRounding) * (1.0 + s), more = 2.0 * s * (1.0 + s);
    const auto boundBoxes = [&] {
        using Half [[gnu::vector_size(16)]] = float;
        for (size_t h = 0; h < kHalves; ++h) {
            const Half half = __builtin_convertvector(wider * bound[h] + more, Half);
            std::memcpy(reinterpret_cast<float*>(&nearBound) + 4 * h, &half, sizeof half);
        }
    };
    boundBoxes();
    const auto measure = [&](uint32_t item) {
        const Triangle& t = triangles_[item];
        bool nearer = false;
        for (size_t h = 0; h < kHalves; ++h) {
            const Four found = squaredDistance(t, x[h] - t.corner.x, y[h] - t.corner.y, z[h] - t.corner.z);
            if (anyLess(found, bound[h])) {
                bound[h] = smaller(bound[h], found);
                known = item;
                nearer = true;
            }
        }
        if (nearer)
            boundBoxes();
    };
    const auto reaches = [&](const Node& node) {
        const Eight zero{};
        const Eight dx = larger(larger(node.low.x - nearX, nearX - node.high.x), zero),
                    dy = larger(larger(node.low.y - nearY, nearY - node.high.y), zero),
                    dz = larger(larger(node.low.z - nearZ, nearZ - node.high.z), zero);
        return anyLess(dx * dx + dy * dy + dz * dz, nearBound);
    };
    const uint32_t first = std::min(known, static_cast<uint32_t>(triangles_.size() - 1));
    measure(first);
    std::array<uint32_t, 64> stack; // the tree is at most 33 deep
    size_t waiting = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
        const uint32_t at = stack[--waiting];
        const Node& node = nodes_[at];
        if (!reaches(node))
            continue;
        if (node.right == 0) {
            measure(node.item);
            continue;
        }
        const bool leftFirst = places[0][static_cast<int>(node.item)] < static_cast<double>(node.middle);
        stack[waiting++] = leftFirst ? node.right : at + 1;
        stack[waiting++] = leftFirst ? at + 1 : node.right;
    }
    std::memcpy(squared.data(), bound.data(), sizeof bound);
}

} // namespace touchstone
