#pragma once

#include <filesystem>

namespace touchstone {

/// The doughnut: beside the build tree that this program was built in, or where the project was configured.
[[nodiscard]] std::filesystem::path defaultScene();

} // namespace touchstone
