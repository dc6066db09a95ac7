#pragma once

#include "workbench/editor/material_controller.h"
#include "workbench/panels/panel_state.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace touchstone {

/// Prompts before unsaved materials are lost to another model or at exit. Main thread.
class UnsavedChangesPrompt {
  public:
    /// The model to open; an empty path: exit.
    using Target = std::filesystem::path;
    struct Answer {
        bool go = false; ///< false: the user cancels
        Target target;
    };

    /// True where leaving is possible at once; otherwise prompts.
    [[nodiscard]] bool mayLeave(const Target& target, const MaterialController& materials, PanelState& state);
    /// Every frame: the user's answer, once it has been carried out. A failed save keeps the edits, and
    /// `problem` gives the reason; edits made during the save prompt again.
    [[nodiscard]] std::optional<Answer> update(MaterialController& materials, PanelState& state,
                                               std::string& problem);
    /// Another model: forgets what was discarded of the previous one.
    void begin() { discarded_.reset(); }

  private:
    bool saves_ = false;                // a save is in progress, after which leaving continues
    std::optional<uint64_t> discarded_; // the revision that may be lost
};

} // namespace touchstone
