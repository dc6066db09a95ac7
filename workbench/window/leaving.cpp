#include "workbench/window/leaving.h"

#include <utility>

namespace touchstone {

bool Leaving::mayLeave(const Target& target, const MaterialDesk& materials, PanelState& state) {
    if (!materials.edits().edited())
        return true;
    state.leaving = target;
    return false;
}

std::optional<Leaving::Target> Leaving::update(MaterialDesk& materials, PanelState& state,
                                               std::string& problem) {
    using enum PanelState::Leave;
    const PanelState::Leave answer = std::exchange(state.leave, Undecided);
    if (!state.leaving || (answer == Undecided && !saves_))
        return std::nullopt;
    if (answer == Save) {
        materials.save();
        saves_ = true;
    }
    if (saves_ && materials.saving())
        return std::nullopt;
    const bool failed = std::exchange(saves_, false) && materials.failed();
    if (failed)
        problem = materials.notice();
    const Target target = *std::exchange(state.leaving, std::nullopt);
    return failed || answer == Stay ? std::nullopt : std::optional(target);
}

} // namespace touchstone
