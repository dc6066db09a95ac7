#pragma once

#include "haptics/scene/scene_sculptor.h"

#include <filesystem>

namespace touchstone {

/// Writes an object of a scene that is felt as a field: .glb (mesh, with normals) or .vdb (level set).
/// Returns the number of triangles, 0 for a .vdb. Throws Error.
size_t writeSculpted(const std::filesystem::path& file, const HapticScene& scene, size_t object);

} // namespace touchstone
