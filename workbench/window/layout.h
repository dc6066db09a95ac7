#pragma once

#include "workbench/panels/panel_state.h"

#include <glm/glm.hpp>

namespace touchstone {

/// `folds`, and what else must be folded so that the picture keeps some room in a small window: first the
/// scene, then what is felt.
[[nodiscard]] PanelFolds fittingFolds(const PanelFolds& folds, const glm::vec2& window, float scale);

/// Where the picture is, in window coordinates: what bar and unfolded panels leave of the window.
struct PictureRect {
    float x = 0.0f, y = 0.0f, width = 1.0f, height = 1.0f;
};
[[nodiscard]] PictureRect pictureRect(const PanelFolds& folds, const glm::vec2& window, float scale);

/// Draws bar, panels and cards over the ImGui frame, does what keys ask for that are not the camera's, and
/// applies all of it to `state`. Returns where its widgets are, by name.
std::map<std::string, WidgetRect> drawPanels(const PanelInput& input, PanelState& state);

} // namespace touchstone
