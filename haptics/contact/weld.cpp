#include "haptics/contact/weld.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

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

} // namespace

WeldResult weldVertices(std::span<const glm::vec3> positions, double tolerance) {
    WeldResult result;
    result.remap.resize(positions.size());
    // Cells of four tolerances: a vertex looks into a neighbour cell only when it stands near that wall, so
    // most vertices look into one cell.
    const double cell = std::max(4.0 * tolerance, 1e-30);
    std::unordered_multimap<uint64_t, uint32_t> grid;
    grid.reserve(positions.size());
    const auto cellOf = [cell](double x) { return static_cast<int64_t>(std::floor(x / cell)); };
    for (size_t v = 0; v < positions.size(); ++v) {
        const glm::dvec3 p(positions[v]);
        uint32_t found = UINT32_MAX;
        for (int64_t x = cellOf(p.x - tolerance); x <= cellOf(p.x + tolerance); ++x)
            for (int64_t y = cellOf(p.y - tolerance); y <= cellOf(p.y + tolerance); ++y)
                for (int64_t z = cellOf(p.z - tolerance); z <= cellOf(p.z + tolerance); ++z) {
                    const auto [begin, end] = grid.equal_range(cellKey(x, y, z));
                    for (auto it = begin; it != end; ++it)
                        if (it->second < found &&
                            glm::distance(glm::dvec3(result.vertices[it->second]), p) <= tolerance)
                            found = it->second;
                }
        if (found == UINT32_MAX) {
            found = static_cast<uint32_t>(result.vertices.size());
            result.vertices.push_back(positions[v]);
            grid.emplace(cellKey(cellOf(p.x), cellOf(p.y), cellOf(p.z)), found);
        } else if (result.vertices[found] != positions[v]) {
            ++result.merged;
        }
        result.remap[v] = found;
    }
    return result;
}

bool isClosed(std::span<const uint32_t> indices) {
    std::vector<uint64_t> edges;
    edges.reserve(indices.size());
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
        const uint32_t i[3] = {indices[t], indices[t + 1], indices[t + 2]};
        if (i[0] == i[1] || i[1] == i[2] || i[2] == i[0])
            continue;
        for (int k = 0; k < 3; ++k) {
            const uint64_t a = i[k], b = i[(k + 1) % 3];
            edges.push_back(std::min(a, b) << 32 | std::max(a, b));
        }
    }
    std::sort(edges.begin(), edges.end());
    for (size_t start = 0; start < edges.size();) {
        size_t end = start;
        while (end < edges.size() && edges[end] == edges[start])
            ++end;
        if ((end - start) % 2 != 0)
            return false;
        start = end;
    }
    return !edges.empty();
}

} // namespace touchstone
