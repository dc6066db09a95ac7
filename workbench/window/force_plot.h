#pragma once

#include "workbench/window/force_history.h"

namespace touchstone {

/// The force of the last seconds as two curves, magnitude and tangential part, in the ImGui window at hand.
/// `height` in pixels; as wide as the window.
void drawForcePlot(const ForceHistory& forces, float height);

} // namespace touchstone
