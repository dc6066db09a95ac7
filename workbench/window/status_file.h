#pragma once

#include "workbench/editor/program_editor.h"
#include "workbench/panels/panel_state.h"
#include "workbench/screen/model_picture.h"

#include <filesystem>

namespace touchstone {

/// Writes the window's state to a JSON file, for scripts and tests (`--status-json`). Main thread.
class StatusFile {
  public:
    explicit StatusFile(std::filesystem::path target) : target_(std::move(target)) {}

    /// What the screen tells of itself.
    struct Screen {
        ModelPicture::Drawn drawn;
        size_t validationMessages = 0;
        uint64_t otherMaterials = 0; ///< DrawnMaterials::redraws
        const ProgramEditor& programs;
    };
    /// Does nothing without a target. `now`: s. `widgets` in window coordinates.
    void update(double now, const PanelInput& input, const PanelState& state,
                const std::map<std::string, WidgetRect>& widgets, const Screen& screen);

  private:
    static constexpr double kLookBack = 0.5; // s, of the means and the largest values

    std::filesystem::path target_;
    uint64_t updates_ = 0;
};

} // namespace touchstone
