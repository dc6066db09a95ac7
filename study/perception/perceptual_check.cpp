#include "study/perception/perceptual_check.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <utility>

namespace touchstone::study {

namespace {

constexpr std::array<FacetLimit, 5> kLimits{{
    {"C1", "force without shading", 0.5, false},
    {"C2", "force shading", 3.4, true},
    {"C3", "force without shading, contact location", 0.2, false},
    {"C4", "force without shading, tactile shading", 3.5, true},
    {"P1", "force and tactile shading", 14.8, true},
}};
constexpr double kShare = 0.9;               // of the edges that are to be within a limit
constexpr double kLevel = 0.70710678;        // of the triangles, from one level to the next
constexpr size_t kFewest = 8;                // triangles of a level
constexpr double kSameNormal = 0.9998476952; // cosine of 1 degree

/// Both sides of an edge: the corner at its lower vertex, the other one, the triangle.
struct HalfEdge {
    uint64_t key = 0; // lower and upper vertex
    uint32_t triangle = 0;
    uint8_t corner = 0; // of the triangle, where the edge starts

    bool operator<(const HalfEdge& other) const {
        return key != other.key ? key < other.key : triangle < other.triangle;
    }
};

std::vector<HalfEdge> halfEdgesOf(const std::vector<uint32_t>& indices) {
    std::vector<HalfEdge> edges;
    edges.reserve(indices.size());
    for (size_t t = 0; 3 * t < indices.size(); ++t)
        for (uint8_t k = 0; k < 3; ++k) {
            const uint64_t from = indices[3 * t + k], to = indices[3 * t + (k + 1) % 3];
            if (from != to)
                edges.push_back({std::min(from, to) << 32 | std::max(from, to), static_cast<uint32_t>(t), k});
        }
    std::sort(edges.begin(), edges.end());
    return edges;
}

glm::dvec3 areaOf(const std::vector<glm::vec3>& vertices, const std::vector<uint32_t>& indices,
                  uint32_t triangle) {
    const glm::dvec3 a(vertices[indices[3 * triangle]]), b(vertices[indices[3 * triangle + 1]]),
        c(vertices[indices[3 * triangle + 2]]);
    return glm::cross(b - a, c - a);
}

/// Degrees between two facets; atan2 keeps small angles exact.
double angleOf(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 57.29577951308232;
}

/// Source vertices of an edge's ends, lower vertex first.
std::array<uint32_t, 2> sourcesOf(const HapticObject& object, const HalfEdge& edge) {
    const size_t first = 3 * static_cast<size_t>(edge.triangle);
    const uint32_t from = object.sourceIndices[first + edge.corner],
                   to = object.sourceIndices[first + (edge.corner + 1u) % 3u];
    return object.indices[first + edge.corner] == static_cast<uint32_t>(edge.key >> 32)
               ? std::array{from, to}
               : std::array{to, from};
}

bool isCrease(const HapticObject& object, const HalfEdge& a, const HalfEdge& b) {
    if (object.normals.empty())
        return false;
    const auto first = sourcesOf(object, a), second = sourcesOf(object, b);
    for (const size_t end : {0u, 1u})
        if (first[end] != second[end] &&
            glm::dot(normalOf(object, first[end]), normalOf(object, second[end])) < kSameNormal)
            return true;
    return false;
}

/// Calls with each pair of triangles that share an edge alone.
template <class Visit>
void eachInnerEdge(const std::vector<HalfEdge>& edges, const Visit& visit) {
    for (size_t i = 0; i + 1 < edges.size();) {
        size_t end = i + 1;
        while (end < edges.size() && edges[end].key == edges[i].key)
            ++end;
        if (end == i + 2)
            visit(edges[i], edges[i + 1]);
        i = end;
    }
}

/// One mesh, and what becomes of it level by level.
class Reduced {
  public:
    Reduced(const HapticObject& object, PerceptualCheck& check, std::vector<double>& angles)
        : object_(object), indices_(object.indices), onCrease_(object.vertices.size(), 0) {
        check.triangles += object.triangleCount();
        check.anySmooth |= object.anySmooth;
        eachInnerEdge(halfEdgesOf(indices_), [&](const HalfEdge& a, const HalfEdge& b) {
            ++check.edges;
            if (isCrease(object_, a, b)) {
                ++check.creases;
                onCrease_[a.key >> 32] = onCrease_[a.key & 0xffffffffu] = 1;
                return;
            }
            add(a, b, angles);
            if (!angles.empty() && angles.back() > check.largest) {
                check.largest = angles.back();
                const glm::dvec3 ends = vertexOf(object_, static_cast<uint32_t>(a.key >> 32)) +
                                        vertexOf(object_, static_cast<uint32_t>(a.key & 0xffffffffu));
                check.largestAt = object_.workspaceFromObject.point(0.5 * ends);
            }
        });
    }

    /// To a share of its triangles. The error in the workspace.
    double reduceTo(size_t triangles) {
        std::vector<uint32_t> fewer(indices_.size());
        float error = 0.0f;
        const float* positions = &object_.vertices[0].x;
        const size_t count = object_.vertices.size() - 1; // the last one is spare
        fewer.resize(meshopt_simplify(
            fewer.data(), indices_.data(), indices_.size(), positions, count, sizeof(glm::vec3),
            3 * std::min(std::max(triangles, kFewest), indices_.size() / 3), 1.0f, 0, &error));
        indices_ = std::move(fewer);
        const double scale = static_cast<double>(meshopt_simplifyScale(positions, count, sizeof(glm::vec3)));
        error_ += static_cast<double>(error) * scale * object_.workspaceFromObject.scale;
        return error_;
    }
    [[nodiscard]] size_t triangles() const { return indices_.size() / 3; }

    /// Of edges that are no creases: on those both ends were on one.
    void anglesInto(std::vector<double>& angles) const {
        eachInnerEdge(halfEdgesOf(indices_), [&](const HalfEdge& a, const HalfEdge& b) {
            if (onCrease_[a.key >> 32] == 0 || onCrease_[a.key & 0xffffffffu] == 0)
                add(a, b, angles);
        });
    }

  private:
    void add(const HalfEdge& a, const HalfEdge& b, std::vector<double>& angles) const {
        const glm::dvec3 first = areaOf(object_.vertices, indices_, a.triangle),
                         second = areaOf(object_.vertices, indices_, b.triangle);
        if (glm::dot(first, first) > 0.0 && glm::dot(second, second) > 0.0)
            angles.push_back(angleOf(first, second));
    }

    const HapticObject& object_;
    std::vector<uint32_t> indices_;
    std::vector<uint8_t> onCrease_;
    double error_ = 0.0; // of all levels: an upper bound of their sum
};

double quantile(std::vector<double>& values, double share) {
    if (values.empty())
        return 0.0;
    const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), values.begin() + at, values.end());
    return values[static_cast<size_t>(at)];
}

/// Fewer and fewer triangles, all meshes alike, until no limit holds.
void findEnough(std::vector<Reduced>& meshes, PerceptualCheck& check) {
    check.simplified = true;
    size_t before = check.triangles;
    double worst = 0.0;
    for (;;) {
        size_t now = 0;
        std::vector<double> angles;
        for (Reduced& mesh : meshes) {
            worst = std::max(
                worst, mesh.reduceTo(static_cast<size_t>(kLevel * static_cast<double>(mesh.triangles()))));
            now += mesh.triangles();
            mesh.anglesInto(angles);
        }
        if (now >= before || angles.empty())
            return;
        before = now;
        const double angle = quantile(angles, kShare);
        bool any = false;
        for (FacetCheck& row : check.limits)
            if (row.enough && angle <= row.limit.degrees) {
                row.enough = now;
                row.error = worst;
                any = true;
            }
        if (!any)
            return;
    }
}

} // namespace

std::span<const FacetLimit> facetLimits() {
    return kLimits;
}

PerceptualCheck checkPerception(const HapticScene& scene, Search search) {
    PerceptualCheck check;
    std::vector<Reduced> meshes;
    std::vector<double> angles;
    for (const auto& object : scene.objects)
        if (object->shape == nullptr && !object->indices.empty())
            meshes.emplace_back(*object, check, angles);
    if (!angles.empty()) {
        check.median = quantile(angles, 0.5);
        check.most90 = quantile(angles, kShare);
        check.most99 = quantile(angles, 0.99);
    }
    bool anyWithin = false;
    for (const FacetLimit& limit : kLimits) {
        FacetCheck row{.limit = limit};
        row.beyond = static_cast<size_t>(
            std::count_if(angles.begin(), angles.end(), [&](double angle) { return angle > limit.degrees; }));
        if (!angles.empty() && check.most90 <= limit.degrees) {
            row.enough = check.triangles;
            anyWithin = true;
        } else if (!angles.empty()) {
            const double finer = check.most90 / limit.degrees;
            row.needed = static_cast<size_t>(std::ceil(static_cast<double>(check.triangles) * finer * finer));
        }
        check.limits.push_back(row);
    }
    check.angles = std::move(angles);
    if (search == Search::Enough && anyWithin && check.triangles <= kMostToSimplify)
        findEnough(meshes, check);
    return check;
}

} // namespace touchstone::study
