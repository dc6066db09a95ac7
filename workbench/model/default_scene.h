#pragma once

#include <filesystem>
#include <vector>

namespace touchstone {

/// The doughnut: beside the build tree that this program was built in, or where the project was configured.
[[nodiscard]] std::filesystem::path defaultScene();

/// Our own scenes, sorted by name; to be opened from the menu.
[[nodiscard]] std::vector<std::filesystem::path> sampleScenes();

/// One of our own scenes, which nobody saves over by accident.
[[nodiscard]] bool isSample(const std::filesystem::path& path);

} // namespace touchstone
