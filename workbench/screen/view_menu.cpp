#include "workbench/screen/view_menu.h"

#include <imgui.h>

#include <array>
#include <string>

namespace touchstone {

namespace {

using Mark = std::function<void(const char*)>;

void modeList(ViewOptions& options, const Mark& mark) {
    constexpr std::array kLabels{"as it looks",          "height map",
                                 "friction map",         "stiffness map",
                                 "damping map",          "normals",
                                 "texture coordinates",  "tilt of the felt normal",
                                 "angle between facets", "effects of the plan",
                                 "what people may feel"};
    static_assert(kLabels.size() == kViewModeNames.size());
    int mode = static_cast<int>(options.mode);
    ImGui::PushItemWidth(-1.0f);
    if (ImGui::Combo("##view", &mode, kLabels.data(), static_cast<int>(kLabels.size()),
                     static_cast<int>(kLabels.size())))
        options.mode = static_cast<ViewMode>(mode);
    mark("view");
    ImGui::PopItemWidth();
}

/// The size of saved pictures.
void pictureSizes(ViewOptions& options, const Mark& mark) {
    constexpr std::array<glm::ivec2, 5> kSizes{
        {{0, 0}, {1280, 720}, {1920, 1080}, {3840, 2160}, {7680, 4320}}};
    const auto label = [](const glm::ivec2& size) {
        return size.x == 0 ? std::string("as in the window")
                           : std::to_string(size.x) + " x " + std::to_string(size.y);
    };
    if (ImGui::BeginCombo("Picture size", label(options.pictureSize).c_str())) {
        for (const glm::ivec2& size : kSizes)
            if (ImGui::Selectable(label(size).c_str(), size == options.pictureSize))
                options.pictureSize = size;
        ImGui::EndCombo();
    }
    mark("pictureSize");
}

/// Where it is, and whether.
void fieldSlice(FieldSlice& slice, const Mark& mark) {
    constexpr std::array kLabels{"none", "across x", "across y", "across z"};
    int chosen = slice.axis + 1;
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    if (ImGui::Combo("Field slice (X)", &chosen, kLabels.data(), static_cast<int>(kLabels.size())))
        slice.axis = chosen - 1;
    mark("slice");
    if (slice.axis < 0)
        return;
    auto at = static_cast<float>(slice.at);
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    if (ImGui::SliderFloat("Place##slice", &at, 0.0f, 1.0f, "%.2f", ImGuiSliderFlags_AlwaysClamp))
        slice.at = static_cast<double>(at);
    mark("slice:place");
}

} // namespace

void drawViewMenu(ViewOptions& options, const std::function<void(const char*)>& mark) {
    modeList(options, mark);
    struct Toggle {
        const char* label;
        const char* name;
        bool& on;
    };
    ShownOverlays& shown = options.overlays;
    const std::array toggles{Toggle{"Probe", "showProbe", shown.probe},
                             Toggle{"Shadow", "showShadow", shown.shadow},
                             Toggle{"Force", "showForce", shown.force},
                             Toggle{"Planes", "showPlanes", shown.planes},
                             Toggle{"Friction", "showFriction", shown.friction},
                             Toggle{"Normal", "showNormal", shown.normal},
                             Toggle{"Wireframe (Z)", "wireframe", options.wireframe},
                             Toggle{"Grid (L)", "grid", options.grid},
                             Toggle{"Axes", "axes", options.axes},
                             Toggle{"Orthographic (5)", "orthographic", options.orthographic},
                             Toggle{"Magnifier (M)", "magnifier", options.magnifier},
                             Toggle{"Turntable (T)", "turntable", options.turntable}};
    const float column = 0.5f * ImGui::GetContentRegionAvail().x;
    for (size_t i = 0; i < toggles.size(); ++i) {
        if (i % 2 == 1)
            ImGui::SameLine(column);
        ImGui::Checkbox(toggles[i].label, &toggles[i].on);
        mark(toggles[i].name);
    }
    fieldSlice(options.slice, mark);
    struct Move {
        const char *label, *name;
        CameraMove move;
    };
    for (const Move& to :
         {Move{"All", "camera:all", CameraMove::Fit}, Move{"Front", "camera:front", CameraMove::Front},
          Move{"Right", "camera:right", CameraMove::Right}, Move{"Top", "camera:top", CameraMove::Top},
          Move{"Near", "camera:near", CameraMove::Probe}}) {
        if (ImGui::SmallButton(to.label))
            options.move = to.move;
        mark(to.name);
        ImGui::SameLine();
    }
    if (ImGui::SmallButton("Save picture"))
        options.savePicture = true;
    mark("savePicture");
    ImGui::SetNextItemWidth(0.5f * ImGui::GetContentRegionAvail().x);
    pictureSizes(options, mark);
}

} // namespace touchstone
