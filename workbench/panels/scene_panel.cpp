#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <string>
#include <vector>

namespace touchstone {

namespace {

constexpr size_t kMaxNodes = 300; // in the tree; the rest is counted

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
    NodeTree(const Scene& scene, int touched, Widgets& widgets)
        : scene_(scene), touched_(touched), widgets_(widgets), children_(scene.nodes.size()) {
        for (size_t i = 0; i < scene.nodes.size(); ++i)
            if (scene.nodes[i].parent >= 0)
                children_[static_cast<size_t>(scene.nodes[i].parent)].push_back(i);
    }

    void draw() {
        for (size_t i = 0; i < scene_.nodes.size(); ++i)
            if (scene_.nodes[i].parent < 0)
                draw(i);
        if (scene_.nodes.size() > kMaxNodes)
            ImGui::TextDisabled("and %zu more", scene_.nodes.size() - kMaxNodes);
    }

  private:
    void draw(size_t node) {
        if (drawn_++ >= kMaxNodes)
            return;
        const bool leaf = children_[node].empty(), touched = static_cast<int>(node) == touched_;
        const std::string name =
            scene_.nodes[node].name.empty() ? "node " + std::to_string(node) : scene_.nodes[node].name;
        ImGui::PushID(static_cast<int>(node));
        if (touched)
            ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.45f, 0.82f, 0.55f, 1.0f));
        const bool open = ImGui::TreeNodeEx(name.c_str(), ImGuiTreeNodeFlags_DefaultOpen |
                                                              ImGuiTreeNodeFlags_SpanAvailWidth |
                                                              (leaf ? ImGuiTreeNodeFlags_Leaf : 0));
        widgets_.mark(("node:" + std::to_string(node)).c_str());
        if (touched)
            ImGui::PopStyleColor();
        if (open) {
            for (const size_t child : children_[node])
                draw(child);
            ImGui::TreePop();
        }
        ImGui::PopID();
    }

    const Scene& scene_;
    int touched_;
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
    if (input.scene != nullptr && !input.scene->nodes.empty())
        NodeTree(*input.scene, touchedNode(input), widgets).draw();
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
