#pragma once

#include "workbench/editor/material_controller.h"
#include "workbench/panels/panel_state.h"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace touchstone {

/// Asks before unsaved materials are lost to another model or to the end. Main thread.
class UnsavedChangesPrompt {
  public:
    /// Where to go; nowhere, an empty path, is the end.
    using Target = std::filesystem::path;
    struct Answer {
        bool go = false; ///< false: the user stays
        Target target;
    };

    /// True where it may be left for at once; else the question is put.
    [[nodiscard]] bool mayLeave(const Target& target, const MaterialController& materials, PanelState& state);
    /// In every frame: what the user has said becomes of the materials, once that is done. A save that fails
    /// keeps them, and `problem` says why; what is changed while it is saved is asked for anew.
    [[nodiscard]] std::optional<Answer> update(MaterialController& materials, PanelState& state,
                                               std::string& problem);
    /// Another model: what was discarded of the one before says nothing of it.
    void begin() { discarded_.reset(); }

  private:
    bool saves_ = false;                // the user waits for a save, to go on after it
    std::optional<uint64_t> discarded_; // the revision that may be lost
};

} // namespace touchstone
