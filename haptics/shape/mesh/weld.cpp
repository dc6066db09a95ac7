#include "haptics/shape/mesh/weld.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace touchstone {

namespace {

uint64_t cellKey(int64_t x, int64_t y, int64_t z) {
    const auto mix = [](uint64_t h, int64_t v) {
        h ^= static_cast<uint64_t>(v) + 0x9e3779b97f4a7c15ULL + (h << 12) + (h >> 4);
        h *= 0xff51afd7ed558ccdULL;
        return h ^ (h >> 33);
    };
    return mix(mix(mix(0x243f6a8885a308d3ULL, x), y), z);
}

/// Clusters by the cell of their vertex: open addressing with linear probing, at most half full. A million
/// vertices touch a cache line each here instead of the three of a chained table.
class CellTable {
  public:
    explicit CellTable(size_t most) : slots_(std::bit_ceil(std::max<size_t>(2 * most, 16))) {}

    void prefetch(uint64_t key) const { __builtin_prefetch(&slots_[home(key)]); }
    void insert(uint64_t key, uint32_t cluster) {
        size_t at = home(key);
        while (slots_[at].cluster != kEmpty)
            at = (at + 1) & (slots_.size() - 1);
        slots_[at] = {tag(key), cluster};
    }
    /// Calls visit(cluster) for all clusters of the key, and for those of a few other keys.
    template <class Visit>
    void visit(uint64_t key, const Visit& visit) const {
        for (size_t at = home(key); slots_[at].cluster != kEmpty; at = (at + 1) & (slots_.size() - 1))
            if (slots_[at].tag == tag(key))
                visit(slots_[at].cluster);
    }

  private:
    static constexpr uint32_t kEmpty = UINT32_MAX;
    struct Slot {
        uint32_t tag = 0, cluster = kEmpty;
    };
    [[nodiscard]] size_t home(uint64_t key) const { return key & (slots_.size() - 1); }
    static uint32_t tag(uint64_t key) { return static_cast<uint32_t>(key >> 32); }

    std::vector<Slot> slots_;
};

/// The cells that a ball of the tolerance about a vertex reaches: one or two along each axis.
struct Reach {
    std::array<uint64_t, 8> key;
    uint32_t count = 0;
    uint64_t own = 0;
};

/// Finds clusters for the vertices, in their order.
class Welder {
  public:
    Welder(std::span<const glm::vec3> positions, double tolerance)
        : positions_(positions), tolerance_(tolerance), cell_(std::max(4.0 * tolerance, 1e-30)),
          table_(positions.size()) {}

    /// The cells to search for the vertices of a block, so that their cache lines are fetched together.
    [[nodiscard]] Reach reachOf(size_t v) const {
        Reach reach;
        const glm::dvec3 p(positions_[v]);
        std::array<std::array<int64_t, 2>, 3> range;
        std::array<int64_t, 3> own;
        for (glm::length_t axis = 0; axis < 3; ++axis) {
            const auto k = static_cast<size_t>(axis);
            range[k] = {cellOf(p[axis] - tolerance_), cellOf(p[axis] + tolerance_)};
            own[k] = cellOf(p[axis]);
        }
        for (int64_t x = range[0][0]; x <= range[0][1]; ++x)
            for (int64_t y = range[1][0]; y <= range[1][1]; ++y)
                for (int64_t z = range[2][0]; z <= range[2][1] && reach.count < reach.key.size(); ++z) {
                    reach.key[reach.count] = cellKey(x, y, z);
                    table_.prefetch(reach.key[reach.count++]);
                }
        reach.own = cellKey(own[0], own[1], own[2]);
        return reach;
    }

    void add(size_t v, const Reach& reach, WeldResult& result) {
        const glm::dvec3 p(positions_[v]);
        uint32_t found = UINT32_MAX;
        for (uint32_t i = 0; i < reach.count; ++i)
            table_.visit(reach.key[i], [&](uint32_t cluster) {
                if (cluster < found && glm::distance(glm::dvec3(result.vertices[cluster]), p) <= tolerance_)
                    found = cluster;
            });
        if (found == UINT32_MAX) {
            found = static_cast<uint32_t>(result.vertices.size());
            result.vertices.push_back(positions_[v]);
            table_.insert(reach.own, found);
        } else if (result.vertices[found] != positions_[v]) {
            ++result.merged;
        }
        result.remap[v] = found;
    }

  private:
    [[nodiscard]] int64_t cellOf(double x) const { return static_cast<int64_t>(std::floor(x / cell_)); }

    std::span<const glm::vec3> positions_;
    double tolerance_;
    // Cells of four tolerances hold at most some hundred clusters, however dense a part of a model is.
    double cell_;
    CellTable table_;
};

/// True if every value occurs an even number of times.
bool allInPairs(std::span<uint32_t> values) {
    std::sort(values.begin(), values.end());
    for (size_t start = 0; start < values.size();) {
        size_t end = start;
        while (end < values.size() && values[end] == values[start])
            ++end;
        if ((end - start) % 2 != 0)
            return false;
        start = end;
    }
    return true;
}

} // namespace

WeldResult weldVertices(std::span<const glm::vec3> positions, double tolerance, const Progress& progress) {
    constexpr size_t kBlock = 32;
    WeldResult result;
    result.remap.resize(positions.size());
    result.vertices.reserve(positions.size() + 1);
    Welder welder(positions, tolerance);
    std::array<Reach, kBlock> reach;
    for (size_t begin = 0; begin < positions.size(); begin += kBlock) {
        if (begin % kProgressWork == 0)
            progress.step(share(begin, positions.size()), "welding vertices");
        const size_t count = std::min(kBlock, positions.size() - begin);
        for (size_t i = 0; i < count; ++i)
            reach[i] = welder.reachOf(begin + i);
        for (size_t i = 0; i < count; ++i)
            welder.add(begin + i, reach[i], result);
    }
    return result;
}

bool isClosed(std::span<const uint32_t> indices, size_t vertexCount, const Progress& progress) {
    constexpr const char* kWhat = "looking for borders";
    // The upper end of each edge, sorted into the lists of the lower ends by counting: linear time.
    std::vector<uint32_t> first(vertexCount + 1, 0);
    const auto forEachEdge = [&](double from, double to, const auto& visit) {
        for (size_t t = 0; t + 2 < indices.size(); t += 3) {
            if (t % (3 * kProgressWork) == 0)
                progress.step(from + (to - from) * share(t, indices.size()), kWhat);
            const uint32_t i[3] = {indices[t], indices[t + 1], indices[t + 2]};
            if (i[0] == i[1] || i[1] == i[2] || i[2] == i[0])
                continue;
            for (int k = 0; k < 3; ++k)
                visit(std::min(i[k], i[(k + 1) % 3]), std::max(i[k], i[(k + 1) % 3]));
        }
    };
    forEachEdge(0.0, 0.3, [&](uint32_t low, uint32_t) { ++first[low + 1]; });
    for (size_t v = 0; v < vertexCount; ++v) {
        if (first[v + 1] % 2 != 0)
            return false; // an odd number of edges leaves one without a partner
        first[v + 1] += first[v];
    }
    if (first[vertexCount] == 0)
        return false;
    std::vector<uint32_t> upper(first[vertexCount]);
    // `first` becomes the end of each list, and thus the beginning of the next.
    forEachEdge(0.3, 0.7, [&](uint32_t low, uint32_t high) { upper[first[low]++] = high; });
    for (size_t v = 0, begin = 0; v < vertexCount; begin = first[v++]) {
        if (v % kProgressWork == 0)
            progress.step(0.7 + 0.3 * share(v, vertexCount), kWhat);
        if (!allInPairs({upper.data() + begin, first[v] - begin}))
            return false;
    }
    return true;
}

} // namespace touchstone
