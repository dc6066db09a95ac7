#pragma once

#include "workbench/panels/panel_state.h"

#include <glm/glm.hpp>

namespace touchstone {

/// `folds`, with further panels folded so that the picture keeps some room in a small window: first the
/// scene, then the readings.
[[nodiscard]] PanelFolds fittingFolds(const PanelFolds& folds, const glm::vec2& window, float scale);

/// The picture's rectangle in window coordinates: the window without bar and unfolded panels.
struct PictureRect {
    float x = 0.0f, y = 0.0f, width = 1.0f, height = 1.0f;
};
[[nodiscard]] PictureRect pictureRect(const PanelFolds& folds, const glm::vec2& window, float scale);

/// Draws bar, panels and cards over the ImGui frame, handles the keys that are not the camera's, and applies
/// all of it to `state`. Returns the rectangles of its widgets by name.
std::map<std::string, WidgetRect> drawPanels(const PanelInput& input, PanelState& state);

} // namespace touchstone
