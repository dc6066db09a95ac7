#pragma once
// Which triangles are near a point: the search that dominates a tick.

#include "engine/core/progress.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace touchstone {

/// A bounding volume hierarchy for one query, built by Embree (rtcBuildBVH) and walked here. Eight children a
/// node; sixteen triangles a leaf with their own boxes in a byte a side, so that a gather reads about ten
/// nodes and ten leaves and no vertex. (rtcPointQuery on Embree's own tree calls back for every triangle of
/// four times as many leaves and took three times as long: docs/architecture.md.) Immutable.
class TriangleTree {
  public:
    /// A triangle near the point, by its box.
    struct Near {
        uint32_t triangle;
        uint32_t place; ///< of its corners, for `corners`
        float distance; ///< lower bound, up to kDoubt
        glm::vec3 away; ///< from the nearest point of the box to the point; length `distance`
    };
    /// Upper bound of the rounding error, for points and triangles of magnitude one.
    static constexpr float kDoubt = 1e-6f;

    TriangleTree() = default;
    /// Three indices a triangle; triangles with two equal corners are left out. Coordinates of magnitude one.
    /// Throws Error when Embree fails, and Cancelled.
    TriangleTree(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices,
                 const Progress& progress = {});

    /// Fits the boxes to other vertices: each holds its triangles in `a`, in `b` and on every straight way
    /// between. Neither allocates nor throws; O(n). Coordinates of magnitude one. Only without copied
    /// corners.
    void refit(std::span<const glm::vec3> a, std::span<const glm::vec3> b,
               std::span<const uint32_t> indices) noexcept;

    /// Copies the corners of all triangles, leaf by leaf, so that those of near ones lie together: a
    /// triangle's indices and vertices are four lines of memory far apart. For vertices that do not move.
    /// O(n). Copies nothing where the copies would take 4 GiB. Throws Cancelled.
    void copyCorners(std::span<const glm::vec3> vertices, std::span<const uint32_t> indices,
                     const Progress& progress = {});
    /// True for the place of a triangle whose corners are copied.
    static constexpr bool isCopied(uint32_t place) noexcept { return place < (kNoPatch << kSlotBits); }
    /// The corners of the triangle at a place that isCopied, as they were given.
    [[nodiscard]] std::array<glm::vec3, 3> corners(uint32_t place) const noexcept {
        const auto* patch = reinterpret_cast<const unsigned char*>(&patches_[place >> kSlotBits]);
        const unsigned char* corner = patch + 3 * (place & (kLeafSize - 1));
        std::array<glm::vec3, 3> at;
        for (size_t k = 0; k < 3; ++k)
            std::memcpy(&at[k], patch + sizeof(float) * corner[k], sizeof(glm::vec3));
        return at;
    }

    /// Writes all triangles whose boxes meet the ball; at most a few that do not. Returns their number, or
    /// `out.size()` when more may meet it than fit. Deterministic; safe on the servo thread.
    [[nodiscard]] size_t collect(const glm::vec3& centre, float radius, std::span<Near> out) const noexcept;

    /// Another ball, which a later walk is expected to collect. A walk asks for the memory that is read for
    /// it, without waiting; nodes and leaves whose own memory has yet to come wait here.
    struct Ahead {
        glm::vec3 centre{0.0f};
        float radius = 0.0f;
        uint32_t left = 0;                  ///< lines of memory that may still be asked for
        uint32_t count = 0;                 ///< of `waiting`
        std::array<uint32_t, 64> waiting{}; ///< what does not fit is not read
    };
    /// Lines of 64 bytes that are asked for from one `collect` to the next, at most: three quarters of a
    /// first cache of 32 kB.
    static constexpr uint32_t kMostLines = 384;
    /// `collect`, which begins to ask for what `ahead` meets beyond the ball. The result is the same.
    [[nodiscard]] size_t collect(const glm::vec3& centre, float radius, std::span<Near> out,
                                 Ahead& ahead) const noexcept;
    /// Reads what waits, one level of the tree, and asks for what it leads to.
    void fetchOn(Ahead& ahead) const noexcept;

    /// Calls visit(triangle) for all triangles whose boxes the ray start + t * direction meets at 0 <= t <=
    /// end, and for some more, until it returns false; `visit` may shorten `end`. `start` of magnitude one.
    /// Defined in triangle_tree_ray.h. Safe on the servo thread.
    template <class Visit>
    void walkRay(const glm::dvec3& start, const glm::dvec3& direction, const double& end,
                 const Visit& visit) const noexcept;

    [[nodiscard]] uint64_t memoryBytes() const noexcept {
        return nodes_.size() * sizeof(Node) + leaves_.size() * sizeof(Leaf) + patches_.size() * sizeof(Piece);
    }

  private:
    struct Flattener;

    static constexpr size_t kWidth = 8;
    static constexpr size_t kLeafSize = 16;
    static constexpr uint32_t kLeafBit = 1u << 31;
    static constexpr size_t kMaxDepth = 64;
    static constexpr uint32_t kSlotBits = 4;
    static_assert(size_t{1} << kSlotBits == kLeafSize);
    static constexpr uint32_t kNoPatch = UINT32_MAX >> kSlotBits;

    struct alignas(32) Node {
        std::array<std::array<float, kWidth>, 3> low, high; ///< an unused child is farther than any real box
        std::array<uint32_t, kWidth> child;                 ///< node, or leaf with kLeafBit
    };
    /// Boxes are origin + step * byte, rounded outwards.
    struct alignas(64) Leaf {
        std::array<uint32_t, kLeafSize> triangle;
        std::array<std::array<uint8_t, kLeafSize>, 3> low, high;
        glm::vec3 origin, step;
        uint8_t count;
        uint16_t pieces; ///< of its patch
        uint32_t patch;  ///< the first of them, in `patches_`
    };
    /// The vertices of a leaf, each once, follow three bytes a triangle: where each corner is, in floats from
    /// the beginning of the patch.
    struct alignas(16) Piece : std::array<unsigned char, 16> {};
    static void pack(Leaf& leaf, std::span<const glm::vec3> a, std::span<const glm::vec3> b,
                     std::span<const uint32_t> indices) noexcept;
    uint32_t fetch(uint32_t child) const noexcept;
    uint32_t fetchPatch(const Leaf& leaf) const noexcept;
    template <class Beyond>
    size_t collectBeyond(const glm::vec3& centre, float radius, std::span<Near> out,
                         const Beyond& beyond) const noexcept;
    void fetchBeyond(const Node& node, uint32_t known, Ahead& ahead) const noexcept;
    size_t collectLeaf(const Leaf& leaf, const glm::vec3& centre, float radiusSquared,
                       std::span<Near> out) const noexcept;

    std::vector<Node> nodes_; ///< root first
    std::vector<Leaf> leaves_;
    std::vector<Piece> patches_; ///< empty: none
};

} // namespace touchstone
