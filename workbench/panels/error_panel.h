#pragma once

#include "study/live/live_error.h"
#include "workbench/panels/widgets.h"

namespace touchstone {

/// Errors of the last seconds against the most exact configurations, with the just-noticeable differences.
/// Marks "error".
void drawError(const study::LiveErrorFigures& error, Widgets& widgets);

/// Whether `error` is imperceptible at its 99th percentile; true without contact.
[[nodiscard]] bool belowPerception(const study::LiveErrorFigures& error);

} // namespace touchstone
