#pragma once

#include <filesystem>
#include <vector>

namespace touchstone {

/// The board of effects: beside the build tree of this program, or where the project was configured.
[[nodiscard]] std::filesystem::path defaultScene();

/// Our own scenes, sorted by name, for the menu.
[[nodiscard]] std::vector<std::filesystem::path> sampleScenes();

/// True for one of our own scenes, which must not be overwritten by accident.
[[nodiscard]] bool isSample(const std::filesystem::path& path);

} // namespace touchstone
