#include "workbench/screen/part_menu.h"

#include "workbench/screen/keys.h"

#include <imgui.h>

#include <span>

namespace touchstone {

namespace {

constexpr const char* kMenu = "objectMenu";

void partKeys(const PartMenu::Situation& now, ScenePart& part) {
    if (altPressed(keyOf('h')))
        part.hidden.clear();
    if (!keyPressed(keyOf('h')) || ImGui::GetIO().WantCaptureMouse)
        return;
    const int node = now.pointed();
    if (node < 0)
        return;
    if (ImGui::GetIO().KeyShift)
        isolateNodes(*now.scene, std::span(&node, 1), part);
    else
        hideNode(*now.scene, node, part);
}

/// Pressed and released in one place: dragged, the right button turns the view.
bool clickedRight() {
    constexpr float kStill = 4.0f; // window coordinates
    const ImVec2 dragged = ImGui::GetMouseDragDelta(ImGuiMouseButton_Right, kStill);
    return ImGui::IsMouseReleased(ImGuiMouseButton_Right) && !ImGui::GetIO().WantCaptureMouse &&
           dragged.x == 0.0f && dragged.y == 0.0f;
}

} // namespace

void drawPartItems(const Scene& scene, int node, ScenePart& part,
                   const std::function<void(const char*)>& mark) {
    ImGui::TextDisabled("%s", nodeLabel(scene, node).c_str());
    if (isHidden(part, node)) {
        if (ImGui::MenuItem("Show"))
            showNode(scene, node, part);
    } else if (ImGui::MenuItem("Hide", "H")) {
        hideNode(scene, node, part);
    }
    mark("hideObject");
    if (ImGui::MenuItem("Isolate", "Shift+H"))
        isolateNodes(scene, std::span(&node, 1), part);
    mark("isolateObject");
    if (ImGui::MenuItem("Show all", "Alt+H", false, !part.hidden.empty()))
        part.hidden.clear();
    mark("showAllObjects");
}

void PartMenu::update(const Situation& now, ScenePart& part, const std::function<void(const char*)>& mark) {
    if (now.scene == nullptr)
        return;
    if (!now.covered) {
        partKeys(now, part);
        if (clickedRight() && (node_ = now.pointed()) >= 0)
            ImGui::OpenPopup(kMenu);
    }
    if (!ImGui::BeginPopup(kMenu))
        return;
    if (static_cast<size_t>(node_) < now.scene->nodes.size())
        drawPartItems(*now.scene, node_, part, mark);
    else // of another model
        ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
}

} // namespace touchstone
