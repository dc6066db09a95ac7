#pragma once

#include <filesystem>

namespace touchstone {

/// Folder of automatically written files: $XDG_STATE_HOME/touchstone, else ~/.local/state/touchstone, else in
/// the system's temporary folder. Not created here.
[[nodiscard]] std::filesystem::path stateFolder();

} // namespace touchstone
