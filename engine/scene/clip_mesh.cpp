#include "engine/scene/clip_mesh.h"

#include "engine/scene/mesh_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <tuple>
#include <unordered_map>
#include <utility>

namespace touchstone {

namespace {

constexpr uint32_t kUntaken = UINT32_MAX;

bool comesBefore(const glm::vec3& a, const glm::vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
}

/// Builds the mesh: vertices are taken over at their first use.
class Clipping {
  public:
    Clipping(const Mesh& mesh, const glm::dvec4& plane, double tolerance)
        : mesh_(mesh), distances_(mesh.positions.size()), taken_(mesh.positions.size(), kUntaken) {
        for (size_t v = 0; v < distances_.size(); ++v) {
            const double d = glm::dot(plane, glm::dvec4(glm::dvec3(mesh.positions[v]), 1.0));
            distances_[v] = std::abs(d) <= tolerance ? 0.0 : d;
        }
        made_.name = mesh.name;
        made_.material = mesh.material;
        made_.normalsFromFile = mesh.normalsFromFile;
        made_.tangentsFromFile = mesh.tangentsFromFile;
    }

    void add(const uint32_t* corner) {
        // Corners in their order, and where an edge passes through the plane.
        std::array<uint32_t, 4> polygon{};
        size_t count = 0;
        bool kept = false, cut = false;
        for (size_t k = 0; k < 3; ++k) {
            kept = kept || distances_[corner[k]] < 0.0;
            cut = cut || distances_[corner[k]] > 0.0;
        }
        cuts_ = cuts_ || cut;
        if (cut && !kept)
            return;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t a = corner[k], b = corner[(k + 1) % 3];
            if (distances_[a] <= 0.0)
                polygon[count++] = take(a);
            if (distances_[a] * distances_[b] < 0.0)
                polygon[count++] = crossing(a, b);
        }
        if (count == 4 && length(polygon[1], polygon[3]) < length(polygon[0], polygon[2]))
            std::rotate(polygon.begin(), polygon.begin() + 1, polygon.end());
        for (size_t k = 1; k + 1 < count; ++k)
            for (const uint32_t v : {polygon[0], polygon[k], polygon[k + 1]})
                made_.indices.push_back(v);
    }
    [[nodiscard]] std::optional<Mesh> take() {
        return cuts_ ? std::optional(std::move(made_)) : std::nullopt;
    }

  private:
    [[nodiscard]] double length(uint32_t a, uint32_t b) const {
        return glm::distance(glm::dvec3(made_.positions[a]), glm::dvec3(made_.positions[b]));
    }

    template <class T>
    static T between(const T& a, const T& b, double t) {
        return static_cast<T>(a + static_cast<float>(t) * (b - a));
    }

    /// Appends to every array that the mesh has: `make(from)` returns the new entry of one.
    template <class Make>
    uint32_t append(const Make& make) {
        const auto vertex = static_cast<uint32_t>(made_.positions.size());
        forEachVertexArray(mesh_, made_, [&](const auto& from, auto& to) {
            if (!from.empty())
                to.push_back(make(from));
        });
        return vertex;
    }

    uint32_t take(uint32_t vertex) {
        uint32_t& taken = taken_[vertex];
        if (taken == kUntaken)
            taken = append([&](const auto& from) { return from[vertex]; });
        return taken;
    }

    /// The vertex where the edge meets the plane. Its place is worked out from the end that comes first in
    /// space, so that it is the same for both triangles of the edge, whatever vertices they have there.
    uint32_t crossing(uint32_t a, uint32_t b) {
        if (comesBefore(mesh_.positions[b], mesh_.positions[a]))
            std::swap(a, b);
        const uint64_t edge = uint64_t{a} << 32 | b;
        if (const auto found = crossings_.find(edge); found != crossings_.end())
            return found->second;
        const double t = distances_[a] / (distances_[a] - distances_[b]);
        const uint32_t vertex = append([&](const auto& from) { return between(from[a], from[b], t); });
        const glm::dvec3 start(mesh_.positions[a]), end(mesh_.positions[b]);
        made_.positions[vertex] = glm::vec3(start + t * (end - start));
        if (!made_.normals.empty())
            made_.normals[vertex] = unit(made_.normals[vertex], mesh_.normals[a]);
        if (!made_.tangents.empty())
            made_.tangents[vertex] = glm::vec4(
                unit(glm::vec3(made_.tangents[vertex]), glm::vec3(mesh_.tangents[a])), mesh_.tangents[a].w);
        return crossings_.emplace(edge, vertex).first->second;
    }

    /// Opposite directions have no middle: then that of one end.
    static glm::vec3 unit(const glm::vec3& v, const glm::vec3& otherwise) {
        const float size = glm::length(v);
        return size > 1e-6f ? v / size : otherwise;
    }

    const Mesh& mesh_;
    std::vector<double> distances_;
    std::vector<uint32_t> taken_; // of each vertex: its number in the new mesh
    std::unordered_map<uint64_t, uint32_t> crossings_;
    Mesh made_;
    bool cuts_ = false; // something off a triangle
};

} // namespace

std::optional<Mesh> clippedMesh(const Mesh& mesh, const glm::dvec4& plane, double tolerance) {
    Clipping clipping(mesh, plane, tolerance);
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        clipping.add(&mesh.indices[i]);
    return clipping.take();
}

double clipTolerance(const Mesh& mesh, const glm::dmat4& sceneFromMesh) {
    Bounds bounds;
    for (const glm::vec3& position : mesh.positions)
        bounds.include(glm::dvec3(sceneFromMesh * glm::dvec4(glm::dvec3(position), 1.0)));
    return bounds.empty() ? 0.0 : kClipTolerance * bounds.diagonal();
}

} // namespace touchstone
