#pragma once
// The single list of the vertex arrays of a Mesh. All code that copies, splits, reorders, counts or checks
// vertices uses it: an array that such code omits is shorter than `positions` afterwards, and is read past
// its end (an importer that split vertices without `heights` did exactly that).

#include "engine/core/member_count.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>

namespace touchstone {

/// A vertex array of a mesh and its name.
template <class Array>
struct VertexArray {
    const char* name;
    Array& values;
};

/// The VertexArrays of a Mesh or const Mesh as a tuple, `positions` first. Each of them is empty or has one
/// entry per vertex, and can be interpolated (`sources` cannot: who makes new vertices between others drops
/// the deformation). Does not compile while a member of Mesh is neither listed as a vertex array nor as
/// something else.
template <class AnyMesh>
requires std::is_same_v<std::remove_const_t<AnyMesh>, Mesh>
auto vertexArrays(AnyMesh& mesh) {
    // The binding fails to compile if Mesh gains or loses a member, the count if one is bound and not listed.
    auto& [name, positions, normals, tangents, uv0, uv1, colors, stiffness, damping, friction, heights,
           indices, lineIndices, pointIndices, material, normalsFromFile, tangentsFromFile, deformation,
           sources] = mesh;
    const auto array = [](const char* label, auto& values) {
        return VertexArray<std::remove_reference_t<decltype(values)>>{label, values};
    };
    const auto other = [](const auto&... members) {
        return std::integral_constant<size_t, sizeof...(members)>{};
    };
    const auto arrays = std::tuple(
        array("positions", positions), array("normals", normals), array("tangents", tangents),
        array("uv0", uv0), array("uv1", uv1), array("colors", colors), array("stiffness", stiffness),
        array("damping", damping), array("friction", friction), array("heights", heights));
    const auto others = other(name, indices, lineIndices, pointIndices, material, normalsFromFile,
                              tangentsFromFile, deformation, sources);
    static_assert(std::tuple_size_v<std::remove_const_t<decltype(arrays)>> + decltype(others)::value ==
                      memberCount<Mesh>(),
                  "list every member of Mesh here: as a vertex array, or as something else");
    return arrays;
}

/// Calls f(name, array) for every vertex array of a Mesh or const Mesh.
template <class AnyMesh, class F>
void forEachVertexArray(AnyMesh& mesh, F&& f) {
    std::apply([&f](const auto&... arrays) { (f(arrays.name, arrays.values), ...); }, vertexArrays(mesh));
}

/// Calls f(from's array, to's array) for every vertex array of two meshes.
template <class F>
void forEachVertexArray(const Mesh& from, Mesh& to, F&& f) {
    const auto sources = vertexArrays(from);
    const auto targets = vertexArrays(to);
    [&]<size_t... I>(std::index_sequence<I...>) {
        (f(std::get<I>(sources).values, std::get<I>(targets).values), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<std::remove_const_t<decltype(sources)>>>());
}

/// Appends a copy of vertex `v` to every vertex array and returns its index. `v` is in range.
uint32_t duplicateVertex(Mesh& mesh, uint32_t v);

/// Makes vertex i a copy of the former vertex from[i], in every vertex array: drops, reorders, duplicates.
/// Indices are left to the caller. All of `from` are in range.
void selectVertices(Mesh& mesh, std::span<const uint32_t> from);

/// Drops the vertices that no triangle, segment or point uses. The order of the others stays, and indices are
/// updated. No effect where nothing is drawn.
void dropUnusedVertices(Mesh& mesh);

/// Bytes of one vertex over the mesh's arrays.
[[nodiscard]] uint64_t bytesPerVertex(const Mesh& mesh);

/// A violation of the invariants of Mesh on which memory safety and finite forces depend: an array that is
/// neither empty nor as long as `positions`, a value that is not finite, a number of indices that is no
/// multiple of three (of two for lines), an index out of range. Empty if they hold. Linear in the mesh.
[[nodiscard]] std::optional<std::string> meshFault(const Mesh& mesh);

/// Throws Error (file, place) with meshFault, if there is one. All code that makes meshes ends with it, and
/// code that uses other code's meshes begins with it.
void checkMesh(const Mesh& mesh, const std::string& file, const std::string& place);

} // namespace touchstone
