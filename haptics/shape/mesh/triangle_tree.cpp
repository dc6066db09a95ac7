#include "haptics/shape/mesh/triangle_tree.h"

#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "haptics/shape/mesh/embree.h"
#include "haptics/shape/mesh/embree_device.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>

namespace touchstone {

namespace {

constexpr const char* kBoxes = "boxing triangles";
constexpr const char* kSearchTree = "building the search tree";
constexpr const char* kFlat = "packing the search tree";

/// Embree's allocator returns these during the build; they are freed once the tree is complete.
struct TemporaryNode {
    static constexpr size_t kWidth = 8;
    bool isLeaf;
    uint32_t count;
    std::array<TemporaryNode*, kWidth> child;
    std::array<RTCBounds, kWidth> bounds;
};
struct TemporaryLeaf {
    static constexpr size_t kSize = 16;
    bool isLeaf;
    uint32_t count;
    std::array<uint32_t, kSize> triangle;
};
static_assert(offsetof(TemporaryNode, isLeaf) == offsetof(TemporaryLeaf, isLeaf));

/// Data shared by the callbacks of one build.
struct Build {
    std::atomic<size_t> nodes{0}, leaves{0};
    std::atomic<bool> outOfMemory{false};
    EstimatedProgress* progress = nullptr;
};

/// Null, and recorded in the build, where Embree finds no memory: Embree reports that only after the build.
void* allocate(RTCThreadLocalAllocator allocator, size_t bytes, Build& build) {
    void* memory = rtcThreadLocalAlloc(allocator, bytes, 16);
    if (memory == nullptr)
        build.outOfMemory.store(true, std::memory_order_relaxed);
    return memory;
}

void* createNode(RTCThreadLocalAllocator allocator, unsigned count, void* user) {
    Build& build = *static_cast<Build*>(user);
    build.nodes.fetch_add(1, std::memory_order_relaxed);
    void* memory = allocate(allocator, sizeof(TemporaryNode), build);
    if (memory == nullptr)
        return nullptr;
    return new (memory) TemporaryNode{.isLeaf = false, .count = count, .child = {}, .bounds = {}};
}

void setChildren(void* node, void** children, unsigned count, void*) {
    for (unsigned i = 0; node != nullptr && i < count; ++i)
        static_cast<TemporaryNode*>(node)->child[i] = static_cast<TemporaryNode*>(children[i]);
}

void setBounds(void* node, const RTCBounds** bounds, unsigned count, void*) {
    for (unsigned i = 0; node != nullptr && i < count; ++i)
        static_cast<TemporaryNode*>(node)->bounds[i] = *bounds[i];
}

void* createLeaf(RTCThreadLocalAllocator allocator, const RTCBuildPrimitive* primitives, size_t count,
                 void* user) {
    Build& build = *static_cast<Build*>(user);
    build.leaves.fetch_add(1, std::memory_order_relaxed);
    void* memory = allocate(allocator, sizeof(TemporaryLeaf), build);
    if (memory == nullptr)
        return nullptr;
    auto* leaf =
        new (memory) TemporaryLeaf{.isLeaf = true, .count = static_cast<uint32_t>(count), .triangle = {}};
    for (size_t i = 0; i < count; ++i)
        leaf->triangle[i] = primitives[i].primID;
    return leaf;
}

bool goesOn(void* user, double fraction) {
    Build& build = *static_cast<Build*>(user);
    return !build.outOfMemory.load(std::memory_order_relaxed) && build.progress->at(fraction);
}

bool isCollapsed(const uint32_t* corner) {
    return corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
}

struct Boxes {
    std::unique_ptr<RTCBuildPrimitive[]> box; // left uninitialised until the threads fill it
    size_t count = 0;
};

/// The boxes of all triangles but those with two equal corners, in their order.
Boxes boxesOf(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices,
              const Progress& progress) {
    const size_t triangles = indices.size() / 3;
    std::vector<size_t> first(triangles / kProgressWork + 2, 0); // of each block of triangles
    inParallel(triangles, progress.part(0.0, 0.2), kBoxes, [&](size_t begin, size_t end) {
        size_t kept = 0;
        for (size_t t = begin; t < end; ++t)
            kept += isCollapsed(&indices[3 * t]) ? 0 : 1;
        first[begin / kProgressWork + 1] = kept;
    });
    std::partial_sum(first.begin(), first.end(), first.begin());
    Boxes boxes{std::make_unique_for_overwrite<RTCBuildPrimitive[]>(first.back()), first.back()};
    inParallel(triangles, progress.part(0.2, 1.0), kBoxes, [&](size_t begin, size_t end) {
        size_t to = first[begin / kProgressWork];
        for (size_t t = begin; t < end; ++t) {
            const uint32_t* corner = &indices[3 * t];
            if (isCollapsed(corner))
                continue;
            const glm::vec3 &a = vertices[corner[0]], &b = vertices[corner[1]], &c = vertices[corner[2]];
            const glm::vec3 low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
            boxes.box[to++] = {.lower_x = low.x,
                               .lower_y = low.y,
                               .lower_z = low.z,
                               .geomID = 0,
                               .upper_x = high.x,
                               .upper_y = high.y,
                               .upper_z = high.z,
                               .primID = static_cast<unsigned>(t)};
        }
    });
    return boxes;
}

/// Embree's tree, whose nodes live as long as `bvh`. Reorders `boxes`.
const TemporaryNode* buildTemporary(RTCBVHTy* bvh, const Boxes& boxes, Build& build,
                                    const Progress& progress) {
    constexpr double kTimePerTriangle = 3e-7; // s, on two cores
    EstimatedProgress estimate(progress, kSearchTree, kTimePerTriangle * static_cast<double>(boxes.count));
    build.progress = &estimate;
    RTCBuildArguments arguments = rtcDefaultBuildArguments();
    arguments.maxBranchingFactor = TemporaryNode::kWidth;
    arguments.maxDepth = 48;
    arguments.sahBlockSize = TemporaryLeaf::kSize;
    arguments.maxLeafSize = TemporaryLeaf::kSize;
    arguments.bvh = bvh;
    arguments.primitives = boxes.box.get();
    arguments.primitiveCount = arguments.primitiveArrayCapacity = boxes.count;
    arguments.createNode = createNode;
    arguments.setNodeChildren = setChildren;
    arguments.setNodeBounds = setBounds;
    arguments.createLeaf = createLeaf;
    arguments.buildProgress = goesOn;
    arguments.userPtr = &build;
    const auto* root = static_cast<const TemporaryNode*>(rtcBuildBVH(&arguments));
    const RTCError error = rtcGetDeviceError(embreeDevice());
    progress.stopIfCancelled();
    if (error != RTC_ERROR_NONE || root == nullptr || build.outOfMemory.load(std::memory_order_relaxed))
        throw Error("Embree", "", "the search tree could not be built",
                    "the model may need more memory than is free");
    return root;
}

} // namespace

/// Copies Embree's tree into two flat arrays, parents before children. The leaves are numbered first and
/// packed afterwards, by several threads.
struct TriangleTree::Flattener {
    static_assert(TemporaryNode::kWidth == kWidth);
    static_assert(TemporaryLeaf::kSize == kLeafSize);
    std::vector<Node>& nodes;
    std::vector<const TemporaryLeaf*>& leaves;
    const Progress progress;
    const size_t expected;

    uint32_t add(const TemporaryNode* node, size_t depth) {
        if (depth >= kMaxDepth)
            throw Error("Embree", "", "the search tree is deeper than it can be walked", "report this model");
        if (node->isLeaf) {
            if (leaves.size() % kProgressWork == 0)
                progress.step(share(leaves.size(), expected), kFlat);
            leaves.push_back(reinterpret_cast<const TemporaryLeaf*>(node));
            return static_cast<uint32_t>(leaves.size() - 1) | kLeafBit;
        }
        const size_t index = nodes.size();
        Node& made = nodes.emplace_back();
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
            nodes[index].child[i] = child; // `made` may have been reallocated
        }
        return static_cast<uint32_t>(index);
    }
};

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

TriangleTree::TriangleTree(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices,
                           const Progress& progress) {
    Boxes boxes = boxesOf(vertices, indices, progress.part(0.0, 0.08));
    if (boxes.count == 0)
        return;
    const std::shared_ptr<RTCBVHTy> bvh(rtcNewBVH(embreeDevice()), rtcReleaseBVH);
    Build build;
    const TemporaryNode* root = buildTemporary(bvh.get(), boxes, build, progress.part(0.08, 0.85));
    boxes = {};
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
    nodes_.reserve(build.nodes + 1);
    std::vector<const TemporaryLeaf*> unpacked;
    unpacked.reserve(build.leaves);
    Flattener{nodes_, unpacked, progress.part(0.85, 0.92), build.leaves}.add(root, 0);
    nodes_.shrink_to_fit();
    leaves_.resize(unpacked.size());
    inParallel(unpacked.size(), progress.part(0.92, 1.0), kFlat, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            leaves_[i].count = unpacked[i]->count;
            std::copy_n(unpacked[i]->triangle.begin(), unpacked[i]->count, leaves_[i].triangle.begin());
            pack(leaves_[i], vertices, vertices, indices);
        }
    });
}

void TriangleTree::refit(std::span<const glm::vec3> a, std::span<const glm::vec3> b,
                         std::span<const uint32_t> indices) noexcept {
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

/// Signed distance along one axis from the interval to the place; 0 inside.
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
    // About half of them are near, in no predictable order: each is written and only the near ones are
    // counted.
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
