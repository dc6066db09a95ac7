#include "workbench/window/unsaved_changes_prompt.h"

#include <utility>

namespace touchstone {

bool UnsavedChangesPrompt::mayLeave(const Target& target, const MaterialController& materials,
                                    PanelState& state) {
    if (!materials.edited() || discarded_ == materials.revision())
        return true;
    if (!state.leaving)
        state.gallery = state.help = false; // nothing covers the prompt
    state.leaving = target;
    return false;
}

std::optional<UnsavedChangesPrompt::Answer>
UnsavedChangesPrompt::update(MaterialController& materials, PanelState& state, std::string& problem) {
    using enum PanelState::Leave;
    const PanelState::Leave answer = std::exchange(state.leave, Undecided);
    if (!state.leaving)
        return std::nullopt;
    const auto answered = [&](bool go) {
        saves_ = false;
        return Answer{go, *std::exchange(state.leaving, std::nullopt)};
    };
    if (answer == Stay)
        return answered(false);
    if (answer == Discard) {
        discarded_ = materials.revision();
        return answered(true);
    }
    if (answer == Save) {
        materials.save();
        saves_ = true;
    }
    if (!saves_ || materials.saving())
        return std::nullopt;
    if (materials.failed()) {
        problem = materials.notice();
        return answered(false);
    }
    saves_ = false;
    return materials.edited() ? std::nullopt : std::optional(answered(true));
}

} // namespace touchstone
