#pragma once

#include "workbench/editor/material_desk.h"
#include "workbench/window/panels/panel_state.h"

#include <filesystem>
#include <optional>
#include <string>

namespace touchstone {

/// Asks before unsaved materials are lost to another model or to the end. Main thread.
class Leaving {
  public:
    /// Where to go; nowhere, an empty path, is the end.
    using Target = std::filesystem::path;

    /// True where it may be left for at once; else the question is put.
    [[nodiscard]] bool mayLeave(const Target& target, const MaterialDesk& materials, PanelState& state);
    /// In every frame: where to go, once the user has said what becomes of the materials. A save that fails
    /// keeps them, and `problem` says why.
    [[nodiscard]] std::optional<Target> update(MaterialDesk& materials, PanelState& state,
                                               std::string& problem);

  private:
    bool saves_ = false; // the user waits for a save, to go on after it
};

} // namespace touchstone
