#pragma once

#include "study/live/live_error.h"
#include "workbench/panels/widgets.h"

namespace touchstone {

/// Errors of the last seconds against the most exact configurations, with the just-noticeable differences.
/// Marks "error".
void drawError(const study::LiveErrorFigures& error, Widgets& widgets);

/// How an error compares to what people just notice. Undecided: no threshold is known, or it exceeds its own
/// while another one of the same quantity holds.
enum class Perception : uint8_t { Below, Undecided, Above };

/// Verdicts at the 99th percentile: of each figure, and of contact lost or invented.
struct ErrorPerception {
    Perception force, forceShare, direction, contact;
    /// None is Above; true without contact.
    [[nodiscard]] bool below() const;
};
/// Force is imperceptible where either its absolute or its relative threshold holds.
[[nodiscard]] ErrorPerception errorPerception(const study::LiveErrorFigures& error);

} // namespace touchstone
