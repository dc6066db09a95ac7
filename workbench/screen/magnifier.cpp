#include "workbench/screen/magnifier.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>

namespace touchstone {

OrbitCamera Magnifier::camera(const OrbitCamera& main, const glm::dvec3& probe) {
    OrbitCamera camera = main;
    camera.target = probe;
    camera.distance = 0.5 * kField / std::tan(0.5 * camera.fovY);
    return camera;
}

PixelRect Magnifier::place(const PixelRect& picture) {
    const int size = std::max(64, static_cast<int>(0.34 * std::min(picture.width, picture.height)));
    const int margin = size / 16;
    return {picture.x + picture.width - size - margin, picture.y + margin, size, size};
}

void Magnifier::drawFrame(const glm::vec2& corner, float size, float scale) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const ImVec2 low(corner.x, corner.y), high(corner.x + size, corner.y + size);
    draw.AddRect(low, high, IM_COL32(225, 229, 233, 255), 0.0f, 0, 2.0f * scale);
    // A scale bar of 2 mm.
    const float bar = size * static_cast<float>(2e-3 / kField), y = high.y - 10.0f * scale,
                x = low.x + 10.0f * scale;
    draw.AddLine(ImVec2(x, y), ImVec2(x + bar, y), IM_COL32(255, 255, 255, 255), 2.0f * scale);
    draw.AddText(ImVec2(x, y - ImGui::GetTextLineHeight() - 2.0f * scale), IM_COL32(255, 255, 255, 255),
                 "2 mm");
}

} // namespace touchstone
