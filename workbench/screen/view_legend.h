#pragma once

#include "renderer/false_color.h"
#include "workbench/screen/effect_colors.h"

namespace touchstone {

/// The meaning of the picture's colours.
struct ViewLegend {
    ViewMode mode = ViewMode::Shaded;
    FalseColorScale scale;
    std::vector<EffectColors::Kind> kinds; ///< of ViewMode::Effects and Perception
};

/// "height", "friction coefficient": the quantity of a view.
[[nodiscard]] const char* viewTitle(ViewMode mode);

/// Draws the legend over the picture, beneath all ImGui windows, with its lower left corner at `corner` in
/// window coordinates. Nothing for the shaded view. `scale`: window coordinates per layout unit.
void drawViewLegend(const ViewLegend& legend, const glm::vec2& corner, float scale);

} // namespace touchstone
