#pragma once
// OBJ, STL and PLY, read by a process of its own (engine/import/mesh_reader): a file that crashes, hangs or
// fills the library that reads it ends that process, and is an Error here.

#include "engine/import/file/import_context.h"
#include "engine/import/mesh_file/mesh_format.h"
#include "engine/process/limited_process.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace touchstone {

/// Largest file that is given to the reader, bytes.
inline constexpr uint64_t kMaxMeshFileBytes = uint64_t{1} << 30;

/// The program that reads meshes. It gets the bytes of one file and no access to any other, nor to a network.
struct MeshReader {
    std::filesystem::path program;
    ProcessLimits limits;
};

/// touchstone_mesh_reader beside the running program, for a file of so many bytes: at most 5 s of a processor
/// and 1 s for each MB, ten times as long of the clock, 4 GiB.
[[nodiscard]] MeshReader installedMeshReader(uint64_t bytes);

/// The mesh as a GLB. Warns of what the file does not state. Throws Error, and Cancelled within 20 ms.
[[nodiscard]] std::vector<uint8_t> meshAsGlb(ImportContext& context, std::vector<uint8_t> bytes,
                                             MeshFormat format, const MeshReader& reader);

/// The format that a file has by its bytes, else, where these are neither glTF nor another format that is
/// known, by its name. None: to be read as glTF. Throws Error, naming it, for another known format under the
/// name of a mesh.
[[nodiscard]] std::optional<MeshFormat> meshFormatOf(const ImportContext& context,
                                                     std::span<const uint8_t> bytes);

/// The file as glTF: its own bytes, or meshAsGlb.
[[nodiscard]] std::vector<uint8_t> asGltf(ImportContext& context, std::vector<uint8_t> bytes);

/// Throws Error where a file with the name of a mesh is too large, before it is read. Others pass.
void checkMeshSize(const std::filesystem::path& file);

} // namespace touchstone
