#pragma once

#include "engine/import/mesh_file/flat_format.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// An array of a mesh, as a part of FlatMeshes::arrays. Offsets are multiples of four.
struct FlatRange {
    size_t offset = 0, bytes = 0;
};

struct FlatMesh {
    std::string name;
    FlatCounts counts;
    FlatRange positions, corners;
    std::optional<FlatRange> normals, textureCoordinates, colors;
};

/// An answer of the mesh reader that has been checked: every index names a vertex or a material, every
/// position is finite, and the arrays fill `arrays` exactly. Normals, texture coordinates and colours may
/// hold any number.
struct FlatMeshes {
    std::vector<std::string> materials;
    std::vector<FlatMesh> meshes;    ///< at least one
    std::span<const uint8_t> arrays; ///< part of the bytes that were read
};

/// Reads and checks an answer; `shownAs` names the model in messages. Throws Error. Any thread.
[[nodiscard]] FlatMeshes readFlatMeshes(std::span<const uint8_t> bytes, const std::string& shownAs);

} // namespace touchstone
