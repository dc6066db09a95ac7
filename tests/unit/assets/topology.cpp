#include "tests/unit/assets/topology.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <set>
#include <utility>

namespace touchstone::test {

Topology topologyOf(const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
    std::map<std::array<uint32_t, 3>, uint32_t> places;
    std::vector<uint32_t> place(positions.size());
    for (size_t i = 0; i < positions.size(); ++i) {
        const glm::vec3 p = positions[i] + 0.0f; // -0 and 0 are one place
        std::array<uint32_t, 3> bits;
        std::memcpy(bits.data(), &p, sizeof bits);
        place[i] = places.emplace(bits, static_cast<uint32_t>(places.size())).first->second;
    }
    Topology result;
    std::map<std::pair<uint32_t, uint32_t>, int> directed;
    std::set<std::pair<uint32_t, uint32_t>> edges;
    std::set<uint32_t> used;
    for (size_t t = 0; t + 2 < indices.size(); t += 3) {
        ++result.triangles;
        const std::array<uint32_t, 3> corner{place.at(indices[t]), place.at(indices[t + 1]),
                                             place.at(indices[t + 2])};
        const glm::dvec3 a(positions[indices[t]]), b(positions[indices[t + 1]]), c(positions[indices[t + 2]]);
        result.volume += glm::dot(a, glm::cross(b, c)) / 6.0;
        result.emptyTriangles += corner[0] == corner[1] || corner[1] == corner[2] || corner[2] == corner[0];
        for (size_t i = 0; i < 3; ++i) {
            const uint32_t from = corner[i], to = corner[(i + 1) % 3];
            used.insert(from);
            ++directed[{from, to}];
            edges.insert(std::minmax(from, to));
        }
    }
    for (const auto& [edge, count] : directed) {
        const auto opposite = directed.find({edge.second, edge.first});
        result.unpairedEdges += count != 1 || opposite == directed.end() || opposite->second != 1;
    }
    result.vertices = used.size();
    result.edges = edges.size();
    return result;
}

} // namespace touchstone::test
