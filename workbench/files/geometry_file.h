#pragma once

#include "engine/scene/scene.h"

#include <filesystem>

namespace touchstone {

/// Writes the triangles of a scene's static pose as a GLB: a node for each instance, with normals, texture
/// coordinates and colours where they are stated, and the materials' names. Looks, haptics, lines and points
/// are not in it. Throws Error.
void writeGeometry(const std::filesystem::path& file, const Scene& scene);

} // namespace touchstone
