#include "workbench/files/state_folder.h"

#include <cstdlib>

namespace touchstone {

std::filesystem::path stateFolder() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::filesystem::path(value != nullptr ? value : "");
    };
    // The specification requires that relative paths are ignored.
    if (const std::filesystem::path state = variable("XDG_STATE_HOME"); state.is_absolute())
        return state / "touchstone";
    if (const std::filesystem::path home = variable("HOME"); home.is_absolute())
        return home / ".local/state/touchstone";
    return std::filesystem::temp_directory_path() / "touchstone";
}

} // namespace touchstone
