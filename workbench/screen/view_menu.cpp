#include "workbench/screen/view_menu.h"

#include <imgui.h>

#include <array>

namespace touchstone {

namespace {

void modeList(ViewOptions& options) {
    constexpr std::array kLabels{"as it looks",          "height map",
                                 "friction map",         "stiffness map",
                                 "damping map",          "normals",
                                 "texture coordinates",  "tilt of the felt normal",
                                 "angle between facets", "effects of the plan"};
    static_assert(kLabels.size() == kViewModeNames.size());
    int mode = static_cast<int>(options.mode);
    ImGui::PushItemWidth(-1.0f);
    if (ImGui::Combo("##view", &mode, kLabels.data(), static_cast<int>(kLabels.size()),
                     static_cast<int>(kLabels.size())))
        options.mode = static_cast<ViewMode>(mode);
    ImGui::PopItemWidth();
}

} // namespace

void drawViewMenu(ViewOptions& options, const std::function<void(const char*)>& mark) {
    modeList(options);
    mark("view");
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
                             Toggle{"Magnifier (M)", "magnifier", options.magnifier},
                             Toggle{"Turntable (T)", "turntable", options.turntable}};
    const float column = 0.5f * ImGui::GetContentRegionAvail().x;
    for (size_t i = 0; i < toggles.size(); ++i) {
        if (i % 2 == 1)
            ImGui::SameLine(column);
        ImGui::Checkbox(toggles[i].label, &toggles[i].on);
        mark(toggles[i].name);
    }
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
}

} // namespace touchstone
