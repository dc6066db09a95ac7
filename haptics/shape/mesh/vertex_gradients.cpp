#include "haptics/shape/mesh/vertex_gradients.h"

#include <cmath>

namespace touchstone {

namespace {

constexpr size_t kMaxRoundAVertex = 256;
/// Normals within 0.26 degrees count as one: both sides of a UV seam on a smooth surface.
constexpr double kSameNormal = 0.99999;
/// Gradients in one chart differ by less than this fraction of their length; at a mirror line by twice it.
constexpr double kSameChart = 0.5;

struct FacetGradient {
    glm::dvec3 u{0.0}, v{0.0};
    double area = 0.0;
};

/// Area-weighted sum over some triangles.
struct Mean {
    glm::dvec3 u{0.0}, v{0.0};
    double area = 0.0;

    void add(const FacetGradient& facet) {
        u += facet.area * facet.u;
        v += facet.area * facet.v;
        area += facet.area;
    }
    void finish() {
        u /= area;
        v /= area;
    }
    [[nodiscard]] bool agrees(const FacetGradient& facet) const {
        const auto near = [](const glm::dvec3& mean, const glm::dvec3& one) {
            return glm::length(one - mean) <= kSameChart * glm::length(mean);
        };
        return near(u, facet.u) && near(v, facet.v);
    }
};

/// Corners sorted by their welded vertex.
struct CornersByVertex {
    std::vector<uint32_t> first, corner;

    CornersByVertex(std::span<const uint32_t> indices, size_t vertexCount)
        : first(vertexCount + 1), corner(indices.size()) {
        for (const uint32_t i : indices)
            ++first[i + 1];
        for (size_t v = 0; v < vertexCount; ++v)
            first[v + 1] += first[v];
        std::vector<uint32_t> next(first.begin(), first.end() - 1);
        for (size_t c = 0; c < indices.size(); ++c)
            corner[next[indices[c]]++] = static_cast<uint32_t>(c);
    }
    [[nodiscard]] std::span<const uint32_t> at(size_t v) const {
        return {corner.data() + first[v], first[v + 1] - first[v]};
    }
};

std::vector<FacetGradient> facetGradients(const GradientMesh& mesh, std::span<const glm::vec2> values) {
    std::vector<FacetGradient> facets(mesh.indices.size() / 3);
    for (size_t t = 0; t < facets.size(); ++t) {
        const auto corner = [&](size_t k) { return glm::dvec3(mesh.vertices[mesh.indices[3 * t + k]]); };
        const auto value = [&](size_t k) { return glm::dvec2(values[mesh.sourceIndices[3 * t + k]]); };
        const Triangle triangle(corner(0), corner(1), corner(2));
        const glm::dvec2 f0 = value(0), f1 = value(1), f2 = value(2);
        facets[t].u = gradientOver(triangle, f0.x, f1.x, f2.x);
        facets[t].v = gradientOver(triangle, f0.y, f1.y, f2.y);
        facets[t].area = 0.5 * glm::length(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
    }
    return facets;
}

} // namespace

std::vector<GradientPair> smoothGradients(const GradientMesh& mesh, std::span<const glm::vec2> values,
                                          Charted charted) {
    const std::vector<FacetGradient> facets = facetGradients(mesh, values);
    const CornersByVertex corners(mesh.indices, mesh.vertices.size());
    const glm::vec3 none(NAN);
    std::vector<GradientPair> result(values.size(), GradientPair{none, none});
    const auto mean = [&](uint32_t source, std::span<const uint32_t> around) {
        Mean own;
        for (const uint32_t c : around)
            if (mesh.sourceIndices[c] == source)
                own.add(facets[c / 3]);
        if (!(own.area > 0.0))
            return own;
        own.finish();
        if (charted == Charted::Yes)
            for (const uint32_t c : around)
                if (mesh.sourceIndices[c] == source && facets[c / 3].area > 0.0 && !own.agrees(facets[c / 3]))
                    return Mean{};
        Mean all;
        for (const uint32_t c : around) {
            const bool sameNormal = glm::dot(glm::dvec3(mesh.sourceNormals[mesh.sourceIndices[c]]),
                                             glm::dvec3(mesh.sourceNormals[source])) > kSameNormal;
            if (sameNormal && (charted == Charted::No || own.agrees(facets[c / 3])))
                all.add(facets[c / 3]);
        }
        if (all.area > 0.0)
            all.finish();
        return all;
    };
    for (size_t v = 0; v < mesh.vertices.size(); ++v) {
        const std::span<const uint32_t> around = corners.at(v);
        if (around.size() > kMaxRoundAVertex)
            continue;
        for (const uint32_t c : around) {
            const uint32_t source = mesh.sourceIndices[c];
            // Every source vertex is at one place only; its first corner does the work.
            if (std::isfinite(result[source][0].x))
                continue;
            if (const Mean at = mean(source, around); at.area > 0.0)
                result[source] = {glm::vec3(at.u), glm::vec3(at.v)};
        }
    }
    return result;
}

} // namespace touchstone
