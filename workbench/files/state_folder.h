#pragma once

#include <filesystem>

namespace touchstone {

/// Where the program keeps what it makes unasked: $XDG_STATE_HOME/touchstone, else ~/.local/state/touchstone,
/// else in the system's temporary folder. Not made here.
[[nodiscard]] std::filesystem::path stateFolder();

} // namespace touchstone
