#pragma once

#include "workbench/panels/panel_state.h"

#include <filesystem>
#include <string>
#include <vector>

namespace touchstone {

/// The window's state between runs. Not kept: the force switch, which is on at every start, and the hand.
struct WindowMemory {
    HapticSettings settings;
    PanelFolds folds;
    ShownQuantities charts = kFirstQuantities;
    SoundChoice sound;
    float uiScale = 1.0f; ///< within kMinUiScale..kMaxUiScale
    bool introduced = false;
    glm::ivec2 size{0};                        ///< screen coordinates; 0: unknown
    std::vector<std::filesystem::path> recent; ///< files opened, newest first
    bool operator==(const WindowMemory&) const = default;

    static constexpr size_t kMaxRecent = 8;
    void opened(const std::filesystem::path& file);
    void forget(const std::filesystem::path& file) { std::erase(recent, file); }
};

/// The contents of `file`; defaults for the rest. A missing or invalid file, or one of another version, gives
/// the defaults. `warning`: what was not taken of a file that is there; may be null.
[[nodiscard]] WindowMemory readMemory(const std::filesystem::path& file, std::string* warning = nullptr);

/// False where it cannot be written: the state is lost then.
bool writeMemory(const std::filesystem::path& file, const WindowMemory& memory);

} // namespace touchstone
