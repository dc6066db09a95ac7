#pragma once
// Keys of the window, whatever panel they concern.

#include "workbench/panels/panel_state.h"

namespace touchstone {

/// All keys of a frame. Those that a card or a dialog covers are not read.
void readPanelKeys(const PanelInput& input, PanelState& state);

/// Toggles a side panel: where both sides do not fit, the opened one replaces the other.
void foldSide(PanelState& state, bool PanelFolds::*side, bool PanelFolds::*other, const PanelInput& input);

} // namespace touchstone
