#pragma once

#include "workbench/panels/panel_state.h"

#include <glm/glm.hpp>

namespace touchstone {

/// The folds of `state`, with further panels folded so that the picture keeps some room in a small window:
/// first the scene, then the readings.
[[nodiscard]] PanelFolds fittingFolds(const PanelState& state, const glm::vec2& window, float scale);

/// The picture's rectangle in window coordinates: the window without bar, introduction and unfolded panels.
struct PictureRect {
    float x = 0.0f, y = 0.0f, width = 1.0f, height = 1.0f;
};
[[nodiscard]] PictureRect pictureRect(const PanelState& state, const glm::vec2& window, float scale);

/// Draws bar, panels and cards over the ImGui frame, handles the keys that are not the camera's, and applies
/// all of it to `state`. Returns the rectangles of its widgets by name.
std::map<std::string, WidgetRect> drawPanels(const PanelInput& input, PanelState& state);

} // namespace touchstone
