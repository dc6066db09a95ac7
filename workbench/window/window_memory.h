#pragma once

#include "workbench/panels/panel_state.h"

#include <filesystem>
#include <vector>

namespace touchstone {

/// What the window keeps from one run to the next. Not kept: the force switch, which every run begins with
/// on, and the hand.
struct WindowMemory {
    HapticSettings settings;
    PanelFolds folds;
    SoundChoice sound;
    bool introduced = false;
    glm::ivec2 size{0};                        ///< screen coordinates; 0: not known
    std::vector<std::filesystem::path> recent; ///< files opened, newest first
    bool operator==(const WindowMemory&) const = default;

    static constexpr size_t kMaxRecent = 8;
    void opened(const std::filesystem::path& file);
    void forget(const std::filesystem::path& file) { std::erase(recent, file); }
};

/// What `file` holds of it; the rest as it comes. A file that is not there, is broken or of another version
/// harms nothing.
[[nodiscard]] WindowMemory readMemory(const std::filesystem::path& file);

/// False where it cannot be written: then the next run does not know.
bool writeMemory(const std::filesystem::path& file, const WindowMemory& memory);

} // namespace touchstone
