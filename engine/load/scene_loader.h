#pragma once
// Loads glTF and GLB: read, validate, build; OBJ, STL and PLY, which become a GLB first; and volumes, whose
// surface does. Any thread; throws touchstone::Error.

#include "engine/import/file/load_options.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace touchstone {

/// Reads the file, follows its URIs inside its own folder, validates everything before use and builds the
/// immutable scene. Broken images become warnings and grey; broken geometry, structure or references throw.
[[nodiscard]] ScenePtr loadScene(const std::filesystem::path& path, const LoadOptions& options = {});

/// The same for a file that is already in memory; its URIs are relative to `folder`.
[[nodiscard]] ScenePtr loadSceneFromMemory(std::vector<uint8_t> bytes, const std::filesystem::path& folder,
                                           const LoadOptions& options = {});

} // namespace touchstone
