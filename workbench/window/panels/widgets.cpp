#include "workbench/window/panels/widgets.h"

#include <imgui.h>

namespace touchstone {

void Widgets::mark(const char* name) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    rects_[name] = {low.x, low.y, high.x - low.x, high.y - low.y};
}

} // namespace touchstone
