#include "engine/scene/mesh_vertices.h"

#include "engine/core/error.h"
#include "engine/scene/mesh_deformation.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {
namespace {

bool finite(float value) {
    return std::isfinite(value);
}

template <int N>
bool finite(const glm::vec<N, float>& v) {
    for (int c = 0; c < N; ++c)
        if (!std::isfinite(v[c]))
            return false;
    return true;
}

} // namespace

uint32_t duplicateVertex(Mesh& mesh, uint32_t v) {
    forEachVertexArray(mesh, [v](const char*, auto& array) {
        if (array.empty())
            return;
        const auto value = array[v]; // push_back may reallocate what array[v] refers to
        array.push_back(value);
    });
    if (!mesh.sources.empty())
        mesh.sources.push_back(uint32_t(mesh.sources[v]));
    return static_cast<uint32_t>(mesh.positions.size() - 1);
}

void selectVertices(Mesh& mesh, std::span<const uint32_t> from) {
    forEachVertexArray(mesh, [from](const char*, auto& array) {
        if (array.empty())
            return;
        std::remove_reference_t<decltype(array)> selected(from.size());
        for (size_t i = 0; i < from.size(); ++i)
            selected[i] = array[from[i]];
        array = std::move(selected);
    });
    if (mesh.sources.empty())
        return;
    std::vector<uint32_t> sources(from.size());
    for (size_t i = 0; i < from.size(); ++i)
        sources[i] = mesh.sources[from[i]];
    mesh.sources = std::move(sources);
}

void dropUnusedVertices(Mesh& mesh) {
    constexpr uint32_t kUnused = std::numeric_limits<uint32_t>::max();
    std::vector<uint32_t> place(mesh.positions.size(), kUnused);
    const auto lists = {&mesh.indices, &mesh.lineIndices, &mesh.pointIndices};
    for (const auto* list : lists)
        for (const uint32_t v : *list)
            place[v] = 0;
    std::vector<uint32_t> used;
    for (uint32_t v = 0; v < place.size(); ++v)
        if (place[v] != kUnused) {
            place[v] = static_cast<uint32_t>(used.size());
            used.push_back(v);
        }
    if (used.empty() || used.size() == place.size())
        return;
    selectVertices(mesh, used);
    for (auto* list : lists)
        for (uint32_t& v : *list)
            v = place[v];
}

uint64_t bytesPerVertex(const Mesh& mesh) {
    uint64_t bytes = 0;
    forEachVertexArray(mesh, [&bytes](const char*, const auto& array) {
        if (!array.empty())
            bytes += sizeof(array[0]);
    });
    return bytes;
}

std::optional<std::string> meshFault(const Mesh& mesh) {
    const size_t count = mesh.positions.size();
    std::optional<std::string> fault;
    forEachVertexArray(mesh, [&](const char* name, const auto& array) {
        if (fault)
            return;
        if (!array.empty() && array.size() != count) {
            fault = std::string(name) + " has " + std::to_string(array.size()) + " entries for " +
                    std::to_string(count) + " vertices";
            return;
        }
        const auto broken =
            std::find_if(array.begin(), array.end(), [](const auto& value) { return !finite(value); });
        if (broken != array.end())
            fault =
                std::string(name) + " of vertex " + std::to_string(broken - array.begin()) + " is not finite";
    });
    if (fault)
        return fault;
    if (mesh.deformation != nullptr) {
        const size_t all = mesh.deformation->positions.size();
        if (mesh.sources.size() != count ||
            std::any_of(mesh.sources.begin(), mesh.sources.end(), [&](uint32_t v) { return v >= all; }))
            return "the sources of its deformation are not those of its vertices";
    }
    if (mesh.indices.size() % 3 != 0)
        return std::to_string(mesh.indices.size()) + " indices are no triangles";
    if (mesh.lineIndices.size() % 2 != 0)
        return std::to_string(mesh.lineIndices.size()) + " indices are no line segments";
    for (const auto* indices : {&mesh.indices, &mesh.lineIndices, &mesh.pointIndices}) {
        const auto beyond = std::find_if(indices->begin(), indices->end(),
                                         [count](uint32_t index) { return index >= count; });
        if (beyond != indices->end())
            return "index " + std::to_string(*beyond) + " exceeds the last of " + std::to_string(count) +
                   " vertices";
    }
    return std::nullopt;
}

void checkMesh(const Mesh& mesh, const std::string& file, const std::string& place) {
    if (const auto fault = meshFault(mesh))
        throw Error(file, place, "the mesh is inconsistent: " + *fault,
                    "this is a fault of Touchstone; please report it with the file");
}

} // namespace touchstone
