#pragma once

#include "workbench/panels/widgets.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Draws the finger's pad with what its contact location display shows (m along and across), in the lower
/// right corner of the picture. Main thread, within an ImGui frame. Returns its rectangle.
WidgetRect drawPadView(const glm::dvec2& location, const WidgetRect& picture, float scale);

} // namespace touchstone
