// Building the search tree by Embree.

#include "engine/core/error.h"
#include "engine/core/huge_pages.h"
#include "engine/core/parallel.h"
#include "haptics/shape/mesh/embree.h"
#include "haptics/shape/mesh/embree_device.h"
#include "haptics/shape/mesh/triangle_tree.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <limits>
#include <memory>
#include <numeric>
#include <utility>

namespace touchstone {

namespace {

constexpr const char* kBoxes = "boxing triangles";
constexpr const char* kSearchTree = "building the search tree";
constexpr const char* kFlat = "packing the search tree";
constexpr const char* kCorners = "copying corners";

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
    reserveInHugePages(nodes_, build.nodes + 1);
    std::vector<const TemporaryLeaf*> unpacked;
    unpacked.reserve(build.leaves);
    Flattener{nodes_, unpacked, progress.part(0.85, 0.92), build.leaves}.add(root, 0);
    reserveInHugePages(leaves_, unpacked.size());
    leaves_.resize(unpacked.size());
    inParallel(unpacked.size(), progress.part(0.92, 1.0), kFlat, [&](size_t begin, size_t end) {
        for (size_t i = begin; i < end; ++i) {
            leaves_[i].count = static_cast<uint8_t>(unpacked[i]->count);
            leaves_[i].patch = kNoPatch;
            std::copy_n(unpacked[i]->triangle.begin(), unpacked[i]->count, leaves_[i].triangle.begin());
            pack(leaves_[i], vertices, vertices, indices);
        }
    });
}

void TriangleTree::copyCorners(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices,
                               const Progress& progress) {
    struct Patch {
        std::array<uint32_t, 3 * kLeafSize> vertex;
        std::array<uint8_t, 3 * kLeafSize> corner;
        static_assert(3 * kLeafSize / sizeof(float) + 3 * (3 * kLeafSize - 1) <= UINT8_MAX);
        size_t vertices = 0;
        size_t first = 0; ///< vertex, in floats from the beginning
        [[nodiscard]] size_t pieces() const {
            return (first * sizeof(float) + vertices * sizeof(glm::vec3) + sizeof(Piece) - 1) / sizeof(Piece);
        }
    };
    const auto patchOf = [&](const Leaf& leaf) {
        Patch patch;
        patch.first = (3 * size_t{leaf.count} + sizeof(float) - 1) / sizeof(float);
        for (size_t i = 0; i < 3 * size_t{leaf.count}; ++i) {
            const auto end = patch.vertex.begin() + static_cast<std::ptrdiff_t>(patch.vertices);
            const uint32_t vertex = indices[3 * size_t{leaf.triangle[i / 3]} + i % 3];
            const auto known = std::find(patch.vertex.begin(), end, vertex);
            patch.corner[i] =
                static_cast<uint8_t>(patch.first + 3 * static_cast<size_t>(known - patch.vertex.begin()));
            if (known == end)
                patch.vertex[patch.vertices++] = vertex;
        }
        return patch;
    };
    inParallel(leaves_.size(), progress.part(0.0, 0.4), kCorners, [&](size_t begin, size_t end) {
        for (Leaf& leaf : std::span(leaves_).subspan(begin, end - begin))
            leaf.pieces = static_cast<uint16_t>(patchOf(leaf).pieces());
    });
    size_t pieces = 0;
    for (const Leaf& leaf : leaves_)
        pieces += leaf.pieces;
    if (pieces >= kNoPatch)
        return; // 4 GiB
    pieces = 0;
    for (Leaf& leaf : leaves_)
        leaf.patch = static_cast<uint32_t>(std::exchange(pieces, pieces + leaf.pieces));
    reserveInHugePages(patches_, pieces);
    patches_.resize(pieces);
    inParallel(leaves_.size(), progress.part(0.4, 1.0), kCorners, [&](size_t begin, size_t end) {
        for (const Leaf& leaf : std::span(leaves_).subspan(begin, end - begin)) {
            const Patch patch = patchOf(leaf);
            auto* const to = reinterpret_cast<unsigned char*>(&patches_[leaf.patch]);
            std::copy_n(patch.corner.begin(), 3 * size_t{leaf.count}, to);
            for (size_t v = 0; v < patch.vertices; ++v)
                std::memcpy(to + sizeof(float) * (patch.first + 3 * v), &vertices[patch.vertex[v]],
                            sizeof(glm::vec3));
        }
    });
}

} // namespace touchstone
