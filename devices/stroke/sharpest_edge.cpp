// The sharpest edge of a triangle soup (declared in stroke_place.h).

#include "devices/stroke/stroke_place.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace touchstone {

namespace {

constexpr double kWeld = 1e-6; ///< of the diagonal: corners this near are welded
constexpr double kFlat = 0.2 * std::numbers::pi / 180.0;
constexpr double kFolded = 175.0 * std::numbers::pi / 180.0; ///< a sheet with two sides, not an edge
constexpr double kAsSharp = 1.0 * std::numbers::pi / 180.0;  ///< edges that differ by less are equally sharp
constexpr double kEdgesApart = 0.005;                        ///< m
constexpr double kShortest = 0.01;                           ///< of the diagonal: shorter edges are ignored

/// One side of a triangle.
struct Side {
    uint64_t ends = 0; // of both welded corners, in either order
    uint32_t triangle = 0;
    uint8_t corner = 0; // the edge goes from this one to the next
};

struct Triangle {
    glm::dvec3 a{0.0}, b{0.0}, c{0.0};
    [[nodiscard]] const glm::dvec3& corner(size_t i) const { return i % 3 == 0 ? a : i % 3 == 1 ? b : c; }
    [[nodiscard]] glm::dvec3 normal() const { return glm::normalize(glm::cross(b - a, c - a)); }
};

uint64_t mixed(uint64_t x) {
    x ^= x >> 31;
    x *= 0x9e3779b97f4a7c15u;
    return x ^ (x >> 29);
}

/// Hash of a corner that welded corners share (except across grid boundaries).
uint64_t cornerHash(const glm::dvec3& p, const Bounds& bounds, double grid) {
    const glm::dvec3 cell = glm::round((p - bounds.low) / grid);
    uint64_t hash = 0x243f6a8885a308d3u;
    for (const double c : {cell.x, cell.y, cell.z})
        hash = mixed(hash ^ static_cast<uint64_t>(static_cast<int64_t>(c)));
    return hash;
}

struct Edge {
    double angle = 0.0;            // between the normals, rad
    glm::dvec3 from{0.0}, to{0.0}; // m
    std::array<glm::dvec3, 2> normal{}, inward{};
    [[nodiscard]] double length() const { return glm::distance(from, to); }
    [[nodiscard]] double facing(const glm::dvec3& front) const {
        return glm::dot(normal[0] + normal[1], front);
    }
};

/// The component of `v` perpendicular to the unit vector `along`, normalised.
glm::dvec3 across(const glm::dvec3& v, const glm::dvec3& along) {
    return glm::normalize(v - glm::dot(v, along) * along);
}

/// The edge shared by two triangles as `side` and `other`, if it is convex and long enough.
std::optional<Edge> convexEdge(const Triangle& first, const Side& side, const Triangle& second,
                               const Side& other) {
    Edge edge{.from = first.corner(side.corner), .to = first.corner(side.corner + 1u)};
    const glm::dvec3 along = glm::normalize(edge.to - edge.from);
    edge.normal = {first.normal(), second.normal()};
    // The corners that are not on the edge.
    edge.inward = {across(first.corner(side.corner + 2u) - edge.from, along),
                   across(second.corner(other.corner + 2u) - edge.from, along)};
    // Neighbours of the same winding traverse their edge in opposite directions.
    const glm::dvec3& start = second.corner(other.corner);
    if (glm::distance(start, edge.from) < glm::distance(start, edge.to))
        edge.normal[1] = -edge.normal[1];
    edge.angle = std::acos(glm::clamp(glm::dot(edge.normal[0], edge.normal[1]), -1.0, 1.0));
    const bool convex = glm::dot(edge.inward[1], edge.normal[0]) < 0.0;
    return convex && edge.angle > kFlat && edge.angle < kFolded ? std::optional(edge) : std::nullopt;
}

} // namespace

std::vector<EdgeSite> sharpestEdges(const TriangleSource& source, const Bounds& bounds,
                                    const glm::dvec3& front) {
    std::vector<Triangle> triangles;
    std::vector<Side> sides;
    const double grid = kWeld * bounds.diagonal();
    source([&](const SurfaceTriangle& triangle) {
        const glm::dvec3 &a = triangle.a, &b = triangle.b, &c = triangle.c;
        if (!(glm::length(glm::cross(b - a, c - a)) > 0.0))
            return;
        const uint64_t hashes[3] = {cornerHash(a, bounds, grid), cornerHash(b, bounds, grid),
                                    cornerHash(c, bounds, grid)};
        for (uint8_t i = 0; i < 3; ++i)
            sides.push_back({hashes[i] + hashes[(i + 1) % 3], static_cast<uint32_t>(triangles.size()), i});
        triangles.push_back({a, b, c});
    });
    std::ranges::sort(sides, [](const Side& a, const Side& b) {
        return a.ends != b.ends ? a.ends < b.ends : a.triangle < b.triangle;
    });

    std::vector<Edge> edges;
    for (size_t i = 0; i + 1 < sides.size();) {
        size_t end = i + 1;
        while (end < sides.size() && sides[end].ends == sides[i].ends)
            ++end;
        if (end == i + 2) // else a border, or more than two triangles meet
            if (const auto edge = convexEdge(triangles[sides[i].triangle], sides[i],
                                             triangles[sides[i + 1].triangle], sides[i + 1]))
                if (edge->length() > kShortest * bounds.diagonal())
                    edges.push_back(*edge);
        i = end;
    }
    std::ranges::stable_sort(edges, [&](const Edge& a, const Edge& b) {
        const double degreesA = std::floor(a.angle / kAsSharp), degreesB = std::floor(b.angle / kAsSharp);
        return degreesA != degreesB ? degreesA > degreesB : a.facing(front) > b.facing(front);
    });
    std::vector<EdgeSite> sites;
    for (const Edge& edge : edges) {
        const glm::dvec3 middle = 0.5 * (edge.from + edge.to);
        const auto isNear = [&](const EdgeSite& site) {
            return glm::distance(site.point, middle) < kEdgesApart;
        };
        if (sites.size() < kMaxEdges && std::ranges::none_of(sites, isNear))
            sites.push_back({middle, edge.normal, edge.inward});
    }
    return sites;
}

} // namespace touchstone
