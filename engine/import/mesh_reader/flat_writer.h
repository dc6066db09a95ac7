#pragma once

struct aiScene;

namespace touchstone {

/// Writes the scene's triangles in the form of engine/import/mesh_file/flat_format.h to standard output.
/// Throws std::runtime_error.
void writeFlat(const aiScene& scene);

} // namespace touchstone
