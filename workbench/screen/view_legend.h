#pragma once

#include "renderer/false_color.h"
#include "workbench/screen/effect_colors.h"

namespace touchstone {

/// What the colours of the picture stand for.
struct ViewLegend {
    ViewMode mode = ViewMode::Shaded;
    FalseColorScale scale;
    std::vector<EffectColors::Kind> kinds; ///< of ViewMode::Effects
};

/// "height", "friction coefficient": what a view shows.
[[nodiscard]] const char* viewTitle(ViewMode mode);

/// A number of the scale with its unit, as people say it: metres as mm or µm.
[[nodiscard]] std::string scaleLabel(double value, std::string_view unit);

/// Draws the legend over the picture, beneath all ImGui windows, with its lower left corner at `corner` in
/// window coordinates. Nothing for the shaded view. `scale`: window coordinates for one unit of the layout.
void drawViewLegend(const ViewLegend& legend, const glm::vec2& corner, float scale);

} // namespace touchstone
