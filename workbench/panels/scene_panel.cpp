#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "workbench/panels/panels.h"
#include "workbench/screen/part_menu.h"

#include <imgui.h>

#include <string>
#include <vector>

namespace touchstone {

namespace {

constexpr size_t kMaxNodes = 300; // in the tree; the rest is counted
constexpr float kIndent = 12.0f;  // layout units, of a level

/// The Scene node that is touched, or -1.
int touchedNode(const PanelInput& input) {
    const int object = input.tick->output.object;
    if (input.haptic == nullptr || object < 0 || static_cast<size_t>(object) >= input.haptic->objects.size())
        return -1;
    const int instance = input.haptic->objects[static_cast<size_t>(object)]->instance;
    return instance >= 0 && static_cast<size_t>(instance) < input.scene->instances.size()
               ? input.scene->instances[static_cast<size_t>(instance)].node
               : -1;
}

class NodeTree {
  public:
    NodeTree(const Scene& scene, int touched, ScenePart& part, Widgets& widgets)
        : scene_(scene), touched_(touched), part_(part), widgets_(widgets), children_(scene.nodes.size()) {
        for (size_t i = 0; i < scene.nodes.size(); ++i)
            if (scene.nodes[i].parent >= 0)
                children_[static_cast<size_t>(scene.nodes[i].parent)].push_back(i);
    }

    void draw() {
        ImGui::PushStyleVar(ImGuiStyleVar_IndentSpacing, widgets_.units(kIndent));
        for (size_t i = 0; i < scene_.nodes.size(); ++i)
            if (scene_.nodes[i].parent < 0)
                draw(i);
        ImGui::PopStyleVar();
        if (scene_.nodes.size() > kMaxNodes)
            ImGui::TextDisabled("and %zu more", scene_.nodes.size() - kMaxNodes);
    }

  private:
    void draw(size_t node) {
        if (drawn_++ >= kMaxNodes)
            return;
        const bool leaf = children_[node].empty(), touched = static_cast<int>(node) == touched_;
        const std::string name = nodeLabel(scene_, static_cast<int>(node));
        ImGui::PushID(static_cast<int>(node));
        const bool hidden = isHidden(part_, static_cast<int>(node));
        // Close together, but for the menu, which is a popup of its own.
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(widgets_.units(1.0f), 0.0f));
        eye(static_cast<int>(node), hidden);
        ImGui::SameLine(0.0f, widgets_.units(2.0f));
        const bool colored = touched || hidden;
        if (colored)
            ImGui::PushStyleColor(ImGuiCol_Text, hidden ? ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled)
                                                        : ImVec4(0.45f, 0.82f, 0.55f, 1.0f));
        const bool open = ImGui::TreeNodeEx(name.c_str(), ImGuiTreeNodeFlags_DefaultOpen |
                                                              ImGuiTreeNodeFlags_SpanAvailWidth |
                                                              (leaf ? ImGuiTreeNodeFlags_Leaf : 0));
        widgets_.mark(("node:" + std::to_string(node)).c_str());
        ImGui::PopStyleVar();
        if (colored)
            ImGui::PopStyleColor();
        if (ImGui::BeginPopupContextItem("object")) {
            drawPartItems(scene_, static_cast<int>(node), part_,
                          [this](const char* item) { widgets_.mark(item); });
            ImGui::EndPopup();
        }
        if (open) {
            for (const size_t child : children_[node])
                draw(child);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }

    /// A disc that is full while the object is shown, a ring while it is hidden; a click changes it.
    void eye(int node, bool hidden) {
        const float side = ImGui::GetTextLineHeight(), radius = 0.28f * side;
        const ImVec2 at = ImGui::GetCursorScreenPos(), centre(at.x + 0.5f * side, at.y + 0.5f * side);
        if (ImGui::InvisibleButton("eye", ImVec2(side, side)))
            hidden ? showNode(scene_, node, part_) : hideNode(scene_, node, part_);
        const ImU32 color =
            ImGui::GetColorU32(ImGui::IsItemHovered() ? ImGuiCol_Text : ImGuiCol_TextDisabled);
        if (hidden)
            ImGui::GetWindowDrawList()->AddCircle(centre, radius, color);
        else
            ImGui::GetWindowDrawList()->AddCircleFilled(centre, radius, color);
        widgets_.mark(("eye:" + std::to_string(node)).c_str());
    }

    const Scene& scene_;
    int touched_;
    ScenePart& part_;
    Widgets& widgets_;
    std::vector<std::vector<size_t>> children_;
    size_t drawn_ = 0;
};

} // namespace

void drawScene(const PanelInput& input, PanelState& state, Widgets& widgets) {
    widgets.wrapped(input.modelName.empty() ? "none yet" : input.modelName);
    widgets.mark("model", input.scene != nullptr ? input.modelPath : std::string());
    if (!input.modelFacts.empty())
        widgets.wrapped(input.modelFacts, ImGui::GetColorU32(ImGuiCol_TextDisabled));
    drawVolume(input, state, widgets);
    drawAnimation(input, state, widgets);
    if (input.scene != nullptr && !input.scene->nodes.empty())
        NodeTree(*input.scene, touchedNode(input), state.view.part, widgets).draw();
    if (input.warnings.empty() && input.notice.empty())
        return;
    widgets.section("WARNINGS");
    if (!input.notice.empty()) {
        widgets.wrapped(input.notice);
        if (ImGui::SmallButton("Dismiss##notice"))
            state.noticeDismissed = true;
        widgets.mark("dismissNotice");
    }
    for (const std::string& warning : input.warnings)
        widgets.wrapped(warning);
}

} // namespace touchstone
