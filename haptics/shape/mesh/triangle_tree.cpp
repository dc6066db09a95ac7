#include "haptics/shape/mesh/triangle_tree.h"

#include <immintrin.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <utility>

namespace touchstone {

void TriangleTree::pack(Leaf& leaf, std::span<const glm::vec3> a, std::span<const glm::vec3> b,
                        std::span<const uint32_t> indices) noexcept {
    const bool moves = a.data() != b.data();
    // Outwards by more than float rounding, in packing and in unpacking: of magnitude one, or of as far as a
    // deformation takes the leaf.
    constexpr double kOutwards = 4e-7;
    std::array<std::array<double, kLeafSize>, 3> low, high;
    for (size_t i = 0; i < leaf.count; ++i) {
        const uint32_t* corner = &indices[size_t{3} * leaf.triangle[i]];
        for (size_t axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<glm::length_t>(axis);
            auto [least, most] = std::minmax({a[corner[0]][k], a[corner[1]][k], a[corner[2]][k]});
            if (moves) {
                const auto [low2, high2] = std::minmax({b[corner[0]][k], b[corner[1]][k], b[corner[2]][k]});
                least = std::min(least, low2);
                most = std::max(most, high2);
            }
            low[axis][i] = static_cast<double>(least);
            high[axis][i] = static_cast<double>(most);
        }
    }
    // What is no number, where a deformation leaves the floats, becomes 0.
    const auto byte = [](double value) {
        return static_cast<uint8_t>(value > 0.0 ? std::min(value, 255.0) : 0.0);
    };
    for (size_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<glm::length_t>(axis);
        const double least = *std::min_element(low[axis].begin(), low[axis].begin() + leaf.count);
        const double most = *std::max_element(high[axis].begin(), high[axis].begin() + leaf.count);
        const double outwards = kOutwards * std::max({1.0, std::abs(least), std::abs(most)});
        leaf.origin[k] = static_cast<float>(least - 2.0 * outwards);
        leaf.step[k] = static_cast<float>((most - least + 5.0 * outwards) / 255.0 * (1.0 + 1e-6));
        const auto origin = static_cast<double>(leaf.origin[k]), step = static_cast<double>(leaf.step[k]);
        for (size_t i = 0; i < leaf.count; ++i) {
            leaf.low[axis][i] = byte(std::floor((low[axis][i] - outwards - origin) / step));
            leaf.high[axis][i] = byte(std::ceil((high[axis][i] + outwards - origin) / step));
        }
    }
}

void TriangleTree::refit(std::span<const glm::vec3> a, std::span<const glm::vec3> b,
                         std::span<const uint32_t> indices) noexcept {
    assert(patches_.empty());
    for (Leaf& leaf : leaves_)
        pack(leaf, a, b, indices);
    // Parents come before children. A leaf's own boxes are those that its bytes unpack to.
    for (size_t n = nodes_.size(); n-- > 0;) {
        Node& node = nodes_[n];
        for (size_t i = 0; i < kWidth; ++i) {
            if (node.low[0][i] > node.high[0][i])
                continue; // unused
            const bool isLeaf = (node.child[i] & kLeafBit) != 0;
            for (size_t axis = 0; axis < 3; ++axis) {
                if (isLeaf) {
                    const auto k = static_cast<glm::length_t>(axis);
                    const Leaf& leaf = leaves_[node.child[i] & ~kLeafBit];
                    node.low[axis][i] = leaf.origin[k];
                    node.high[axis][i] = leaf.origin[k] + 256.0f * leaf.step[k];
                } else {
                    const Node& child = nodes_[node.child[i]];
                    node.low[axis][i] = *std::min_element(child.low[axis].begin(), child.low[axis].end());
                    node.high[axis][i] = *std::max_element(child.high[axis].begin(), child.high[axis].end());
                }
            }
        }
    }
}

namespace {

// Eight boxes at once by the compilers' vector extension: written as loops they were not vectorised, and took
// three times as long. Bytes become floats by intrinsics: of __builtin_convertvector GCC 12 makes 96 scalar
// conversions a leaf.
using Float8 [[gnu::vector_size(32)]] = float;

template <class Vector, class Element>
Vector load(const Element* from) {
    Vector result;
    std::memcpy(&result, from, sizeof result);
    return result;
}
Float8 greater(Float8 a, Float8 b) {
    return a > b ? a : b;
}

Float8 floatsOf(const uint8_t* bytes) {
    return _mm256_cvtepi32_ps(_mm256_cvtepu8_epi32(_mm_loadl_epi64(reinterpret_cast<const __m128i*>(bytes))));
}

/// Signed distance along one axis from the interval to the place; 0 inside.
Float8 awayFrom(Float8 low, Float8 high, float place) {
    const Float8 zero{};
    return greater(place - high, zero) - greater(low - place, zero);
}

/// Bit i: squared[i] is at most radiusSquared. About half are, in no predictable order.
uint32_t nearOf(Float8 squared, float radiusSquared) {
    return static_cast<uint32_t>(_mm256_movemask_ps(reinterpret_cast<Float8>(squared <= radiusSquared)));
}

using Sides = std::array<std::array<float, 8>, 3>;
/// Bit i: the ball meets box i.
uint32_t metBy(const glm::vec3& centre, float radiusSquared, const Sides& low, const Sides& high) {
    Float8 squared{};
    for (size_t axis = 0; axis < 3; ++axis) {
        const Float8 away = awayFrom(load<Float8>(low[axis].data()), load<Float8>(high[axis].data()),
                                     centre[static_cast<glm::length_t>(axis)]);
        squared += away * away;
    }
    return nearOf(squared, radiusSquared);
}

} // namespace

size_t TriangleTree::collectLeaf(const Leaf& leaf, const glm::vec3& centre, float radiusSquared,
                                 std::span<Near> out) const noexcept {
    alignas(32) std::array<std::array<float, kLeafSize>, 3> away;
    alignas(32) std::array<float, kLeafSize> squared, distance;
    for (size_t half = 0; half < kLeafSize; half += 8) {
        Float8 sum{};
        for (size_t axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<glm::length_t>(axis);
            const Float8 low = floatsOf(&leaf.low[axis][half]), high = floatsOf(&leaf.high[axis][half]);
            const Float8 a = awayFrom(leaf.origin[k] + leaf.step[k] * low,
                                      leaf.origin[k] + leaf.step[k] * high, centre[k]);
            std::memcpy(&away[axis][half], &a, sizeof a);
            sum += a * a;
        }
        std::memcpy(&squared[half], &sum, sizeof sum);
    }
    for (size_t i = 0; i < kLeafSize; ++i)
        distance[i] = std::sqrt(squared[i]);
    size_t count = 0;
    uint32_t near = nearOf(load<Float8>(&squared[0]), radiusSquared) |
                    nearOf(load<Float8>(&squared[8]), radiusSquared) << 8;
    for (near &= (1u << leaf.count) - 1u; near != 0; near &= near - 1) {
        const auto i = static_cast<size_t>(std::countr_zero(near));
        out[count++] = {.triangle = leaf.triangle[i],
                        .place = (leaf.patch << kSlotBits) + static_cast<uint32_t>(i),
                        .distance = distance[i],
                        .away = {away[0][i], away[1][i], away[2][i]}};
    }
    return count;
}

constexpr size_t kLine = 64; ///< of memory, bytes

/// Asks for the lines of a leaf's patch; their number. In line, as all that calls it: a function that only
/// asks for memory has no effect for GCC, which leaves out its calls.
[[gnu::always_inline]] inline uint32_t TriangleTree::fetchPatch(const Leaf& leaf) const noexcept {
    if (leaf.patch == kNoPatch)
        return 0;
    const auto* const at = reinterpret_cast<const char*>(&patches_[leaf.patch]);
    const size_t bytes = leaf.pieces * sizeof(Piece);
    uint32_t lines = 1;
    for (size_t byte = 0; byte < bytes; byte += kLine, ++lines)
        __builtin_prefetch(at + byte);
    __builtin_prefetch(at + bytes - 1);
    return lines;
}

/// Asks for the memory of a child that a walk will come to: the lines of all that wait come at once, where
/// one by one each is waited for. Their number.
[[gnu::always_inline]] inline uint32_t TriangleTree::fetch(uint32_t child) const noexcept {
    static_assert(sizeof(Leaf) == 3 * kLine && sizeof(Node) <= 4 * kLine);
    const bool isLeaf = (child & kLeafBit) != 0;
    const char* at = isLeaf ? reinterpret_cast<const char*>(&leaves_[child & ~kLeafBit])
                            : reinterpret_cast<const char*>(&nodes_[child]);
    for (size_t line = 0; line < 3; ++line)
        __builtin_prefetch(at + line * kLine);
    if (!isLeaf)
        __builtin_prefetch(at + sizeof(Node) - 1);
    return isLeaf ? 3 : 4;
}

/// Calls beyond(node, met) for each node that the walk reads, with the children that the ball meets.
template <class Beyond>
[[gnu::always_inline]] inline size_t TriangleTree::collectBeyond(const glm::vec3& centre, float radius,
                                                                 std::span<Near> out,
                                                                 const Beyond& beyond) const noexcept {
    if (nodes_.empty())
        return 0;
    const float wide = radius + kDoubt, radiusSquared = wide * wide;
    std::array<uint32_t, kMaxDepth * kWidth> stack;
    size_t waiting = 0, count = 0;
    stack[waiting++] = 0;
    while (waiting > 0) {
        const uint32_t next = stack[--waiting];
        if ((next & kLeafBit) != 0) {
            if (count + kLeafSize >= out.size())
                return out.size();
            const Leaf& leaf = leaves_[next & ~kLeafBit];
            const size_t found = collectLeaf(leaf, centre, radiusSquared, out.subspan(count));
            if (found > 0)
                fetchPatch(leaf);
            count += found;
            continue;
        }
        const Node& node = nodes_[next];
        const uint32_t met = metBy(centre, radiusSquared, node.low, node.high);
        for (uint32_t near = met; near != 0; near &= near - 1) {
            const uint32_t child = node.child[static_cast<size_t>(std::countr_zero(near))];
            fetch(child);
            stack[waiting++] = child;
        }
        beyond(node, met);
    }
    return count;
}

[[gnu::always_inline]] inline void TriangleTree::fetchBeyond(const Node& node, uint32_t known,
                                                             Ahead& ahead) const noexcept {
    const uint32_t met = metBy(ahead.centre, ahead.radius * ahead.radius, node.low, node.high);
    for (uint32_t far = met & ~known; far != 0 && ahead.left > 0; far &= far - 1) {
        const uint32_t child = node.child[static_cast<size_t>(std::countr_zero(far))];
        ahead.left -= std::min(fetch(child), ahead.left);
        if (ahead.count < ahead.waiting.size())
            ahead.waiting[ahead.count++] = child;
    }
}

size_t TriangleTree::collect(const glm::vec3& centre, float radius, std::span<Near> out) const noexcept {
    return collectBeyond(centre, radius, out, [](const Node&, uint32_t) {});
}

size_t TriangleTree::collect(const glm::vec3& centre, float radius, std::span<Near> out,
                             Ahead& ahead) const noexcept {
    ahead.count = 0;
    ahead.left = kMostLines;
    return collectBeyond(centre, radius, out,
                         [&](const Node& node, uint32_t met) { fetchBeyond(node, met, ahead); });
}

void TriangleTree::fetchOn(Ahead& ahead) const noexcept {
    const auto come = ahead.waiting;
    for (const uint32_t part : std::span(come).first(std::exchange(ahead.count, 0)))
        if ((part & kLeafBit) == 0)
            fetchBeyond(nodes_[part], 0, ahead);
        else if (ahead.left > 0)
            ahead.left -= std::min(fetchPatch(leaves_[part & ~kLeafBit]), ahead.left);
}

} // namespace touchstone
