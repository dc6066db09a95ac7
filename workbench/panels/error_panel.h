#pragma once

#include "study/live/live_error.h"
#include "workbench/panels/widgets.h"

namespace touchstone {

/// How far from the most exact configurations the touch of the last seconds was, beside the differences that
/// people just notice. Marks "error".
void drawError(const study::LiveErrorFigures& error, Widgets& widgets);

/// Whether nobody is expected to notice what `error` holds, at its 99th percentile; true without contact.
[[nodiscard]] bool belowPerception(const study::LiveErrorFigures& error);

} // namespace touchstone
