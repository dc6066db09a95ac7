#include "haptics/contact/triangle_tree.h"

#include "engine/core/error.h"
#include "haptics/contact/embree_device.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <tuple>

namespace touchstone {

namespace {

/// Embree's allocator hands these out while it builds; they are gone when the tree stands.
struct TemporaryNode {
    bool isLeaf;
    uint32_t count;
    std::array<TemporaryNode*, 8> child;
    std::array<RTCBounds, 8> bounds;
};
struct TemporaryLeaf {
    bool isLeaf;
    uint32_t count;
    std::array<uint32_t, 16> triangle;
};
static_assert(offsetof(TemporaryNode, isLeaf) == offsetof(TemporaryLeaf, isLeaf));

void* createNode(RTCThreadLocalAllocator allocator, unsigned count, void*) {
    void* memory = rtcThreadLocalAlloc(allocator, sizeof(TemporaryNode), 16);
    return new (memory) TemporaryNode{.isLeaf = false, .count = count, .child = {}, .bounds = {}};
}

void setChildren(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<TemporaryNode*>(node)->child[i] = static_cast<TemporaryNode*>(children[i]);
}

void setBounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; i < count; ++i)
        static_cast<TemporaryNode*>(node)->bounds[i] = *bounds[i];
}

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                 void*) {
    void* memory = rtcThreadLocalAlloc(allocator, sizeof(TemporaryLeaf), 16);
    auto* leaf =
        new (memory) TemporaryLeaf{.isLeaf = true, .count = static_cast<uint32_t>(count), .triangle = {}};
    for (size_t i = 0; i < count; ++i)
        leaf->triangle[i] = primitives[i].primID;
    return leaf;
}

} // namespace

/// Puts Embree's tree into two flat arrays, parents before children.
struct TriangleTree::Builder {
    static_assert(std::tuple_size_v<decltype(TemporaryNode::child)> == kWidth);
    static_assert(std::tuple_size_v<decltype(TemporaryLeaf::triangle)> == kLeafSize);
    TriangleTree& tree;
    std::span<const glm::vec3> vertices;
    std::span<const uint32_t> indices;

    uint32_t add(const TemporaryNode* node, size_t depth) {
        if (depth >= kMaxDepth)
            throw Error("Embree", "", "the search tree is deeper than it can be walked", "report this model");
        if (node->isLeaf) {
            const auto* from = reinterpret_cast<const TemporaryLeaf*>(node);
            Leaf leaf{};
            leaf.count = from->count;
            std::copy_n(from->triangle.begin(), from->count, leaf.triangle.begin());
            pack(leaf, vertices, indices);
            tree.leaves_.push_back(leaf);
            return static_cast<uint32_t>(tree.leaves_.size() - 1) | kLeafBit;
        }
        const size_t index = tree.nodes_.size();
        Node& made = tree.nodes_.emplace_back();
        made.child.fill(0);
        for (size_t axis = 0; axis < 3; ++axis) {
            made.low[axis].fill(std::numeric_limits<float>::infinity());
            made.high[axis].fill(-std::numeric_limits<float>::infinity());
        }
        for (size_t i = 0; i < node->count; ++i) {
            const RTCBounds& b = node->bounds[i];
            made.low[0][i] = b.lower_x;
            made.low[1][i] = b.lower_y;
            made.low[2][i] = b.lower_z;
            made.high[0][i] = b.upper_x;
            made.high[1][i] = b.upper_y;
            made.high[2][i] = b.upper_z;
        }
        for (size_t i = 0; i < node->count; ++i) {
            const uint32_t child = add(node->child[i], depth + 1);
            tree.nodes_[index].child[i] = child; // `made` has moved
        }
        return static_cast<uint32_t>(index);
    }
};

void TriangleTree::pack(Leaf& leaf, std::span<const glm::vec3> vertices, std::span<const uint32_t> indices) {
    // Outwards by more than a float of magnitude one rounds, for the packing and for the unpacking.
    constexpr double kOutwards = 4e-7;
    std::array<std::array<double, kLeafSize>, 3> low, high;
    for (size_t i = 0; i < leaf.count; ++i) {
        const uint32_t* corner = &indices[size_t{3} * leaf.triangle[i]];
        for (size_t axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<glm::length_t>(axis);
            const auto [least, most] =
                std::minmax({vertices[corner[0]][k], vertices[corner[1]][k], vertices[corner[2]][k]});
            low[axis][i] = static_cast<double>(least) - kOutwards;
            high[axis][i] = static_cast<double>(most) + kOutwards;
        }
    }
    for (size_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<glm::length_t>(axis);
        const double least = *std::min_element(low[axis].begin(), low[axis].begin() + leaf.count);
        const double most = *std::max_element(high[axis].begin(), high[axis].begin() + leaf.count);
        leaf.origin[k] = static_cast<float>(least - kOutwards);
        leaf.step[k] = static_cast<float>((most - least + 3.0 * kOutwards) / 255.0 * (1.0 + 1e-6));
        const auto origin = static_cast<double>(leaf.origin[k]), step = static_cast<double>(leaf.step[k]);
        for (size_t i = 0; i < leaf.count; ++i) {
            leaf.low[axis][i] = static_cast<uint8_t>(std::floor((low[axis][i] - origin) / step));
            leaf.high[axis][i] = static_cast<uint8_t>(std::ceil((high[axis][i] - origin) / step));
        }
    }
}

TriangleTree::TriangleTree(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices) {
    std::vector<RTCBuildPrimitive> primitives;
    primitives.reserve(indices.size() / 3);
    for (size_t t = 0; t < indices.size() / 3; ++t) {
        const uint32_t* corner = &indices[3 * t];
        if (corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0])
            continue;
        const glm::vec3 &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
        const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        primitives.push_back({.lower_x = low.x,
                              .lower_y = low.y,
                              .lower_z = low.z,
                              .geomID = 0,
                              .upper_x = high.x,
                              .upper_y = high.y,
                              .upper_z = high.z,
                              .primID = static_cast<unsigned>(t)});
    }
    if (primitives.empty())
        return;
    RTCDevice device = embreeDevice();
    const std::shared_ptr<RTCBVHTy> bvh(rtcNewBVH(device), rtcReleaseBVH);
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxBranchingFactor = kWidth;
    arguments.maxDepth = 48;
    arguments.sahBlockSize = kLeafSize;
    arguments.maxLeafSize = kLeafSize;
    arguments.bvh = bvh.get();
    arguments.primitives = primitives.data();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = primitives.size();
    arguments.createNode = createNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = setBounds;
    arguments.createLeaf = createLeaf;
    const auto* root = static_cast<const TemporaryNode*>(rtcBuildBVH(&arguments));
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE || root == nullptr)
        throw Error("Embree", "", "the search tree could not be built",
                    "the model may need more memory than is free");
    TemporaryNode above{.isLeaf = false, .count = 1, .child = {}, .bounds = {}};
    if (root->isLeaf) { // a handful of triangles: one node over one leaf
        constexpr float kAll = 1e30f;
        above.child[0] = const_cast<TemporaryNode*>(root);
        above.bounds[0] = {.lower_x = -kAll,
                           .lower_y = -kAll,
                           .lower_z = -kAll,
                           .align0 = 0.0f,
                           .upper_x = kAll,
                           .upper_y = kAll,
                           .upper_z = kAll,
                           .align1 = 0.0f};
        root = &above;
    }
    Builder{*this, vertices, indices}.add(root, 0);
    nodes_.shrink_to_fit();
    leaves_.shrink_to_fit();
}

namespace {

// Eight boxes at once by the compilers' vector extension: written as loops they were not vectorised, and took
// three times as long.
using Float8 [[gnu::vector_size(32)]] = float;
using Byte8 [[gnu::vector_size(8)]] = uint8_t;

template <class Vector, class Element>
Vector load(const Element* from) {
    Vector result;
    std::memcpy(&result, from, sizeof result);
    return result;
}
Float8 greater(Float8 a, Float8 b) {
    return a > b ? a : b;
}

/// Signed way along one axis from the interval to the place; 0 inside.
Float8 awayFrom(Float8 low, Float8 high, float place) {
    const Float8 zero{};
    return greater(place - high, zero) - greater(low - place, zero);
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
            const auto low = __builtin_convertvector(load<Byte8>(&leaf.low[axis][half]), Float8);
            const auto high = __builtin_convertvector(load<Byte8>(&leaf.high[axis][half]), Float8);
            const Float8 a = awayFrom(leaf.origin[k] + leaf.step[k] * low,
                                      leaf.origin[k] + leaf.step[k] * high, centre[k]);
            std::memcpy(&away[axis][half], &a, sizeof a);
            sum += a * a;
        }
        std::memcpy(&squared[half], &sum, sizeof sum);
    }
    for (size_t i = 0; i < kLeafSize; ++i)
        distance[i] = std::sqrt(squared[i]);
    // About half of them are near, in no order that could be predicted: each is written down and only the
    // near ones are counted.
    size_t count = 0;
    for (size_t i = 0; i < leaf.count; ++i) {
        out[count] = {.triangle = leaf.triangle[i],
                      .distance = distance[i],
                      .away = {away[0][i], away[1][i], away[2][i]}};
        count += squared[i] <= radiusSquared ? 1 : 0;
    }
    return count;
}

size_t TriangleTree::collect(const glm::vec3& centre, float radius, std::span<Near> out) const noexcept {
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
            count += collectLeaf(leaves_[next & ~kLeafBit], centre, radiusSquared, out.subspan(count));
            continue;
        }
        const Node& node = nodes_[next];
        Float8 squared{};
        for (size_t axis = 0; axis < 3; ++axis) {
            const Float8 away =
                awayFrom(load<Float8>(node.low[axis].data()), load<Float8>(node.high[axis].data()),
                         centre[static_cast<glm::length_t>(axis)]);
            squared += away * away;
        }
        for (size_t i = 0; i < kWidth; ++i)
            if (squared[i] <= radiusSquared)
                stack[waiting++] = node.child[i];
    }
    return count;
}

} // namespace touchstone
