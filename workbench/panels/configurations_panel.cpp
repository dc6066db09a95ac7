#include "workbench/figures/quantity.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>

namespace touchstone {

namespace {

/// Combo of an effect's mode while it is on; `first` is the enumerator of the first label.
template <class Mode, size_t N>
void way(Widgets& widgets, const char* name, Mode& mode, Mode off, Mode first,
         const std::array<const char*, N>& labels) {
    if (mode == off)
        return;
    int chosen = static_cast<int>(mode) - static_cast<int>(first);
    if (widgets.combo(name, chosen, labels))
        mode = static_cast<Mode>(chosen + static_cast<int>(first));
}

/// The proxy's moves.
void moves(HapticSettings& settings, Widgets& widgets) {
    constexpr std::array kMoves{1, 2, 4, 8, 16, 64};
    char shown[48];
    std::snprintf(shown, sizeof shown, "moves: at most %d a tick", settings.iterationBudget);
    ImGui::PushItemWidth(-1.0f);
    if (ImGui::BeginCombo("##iterationBudget", shown)) {
        for (const int most : kMoves)
            if (ImGui::Selectable(std::to_string(most).c_str(), most == settings.iterationBudget))
                settings.iterationBudget = most;
        ImGui::EndCombo();
    }
    widgets.mark("iterationBudget");
    ImGui::PopItemWidth();
}

/// Largest typed values: those of the settings, N/m and mm.
constexpr double kMaxStiffness = 1e5, kMaxRadius = 50.0;

void sliders(HapticSettings& settings, Widgets& widgets) {
    ImGui::PushItemWidth(-1.0f);
    auto stiffness = static_cast<float>(settings.stiffness);
    if (widgets.slider("stiffness", "stiffness", stiffness, {.low = 0.0f, .high = 3000.0f},
                       stiffness <= 0.0f ? "the material's" : quantity(settings.stiffness, "N/m")))
        settings.stiffness = std::clamp(static_cast<double>(stiffness), 0.0, kMaxStiffness);
    const bool point = settings.contact != ContactMethod::Sweep;
    if (point)
        ImGui::BeginDisabled();
    auto radius = static_cast<float>(1e3 * settings.proxyRadius); // mm: what is typed
    if (widgets.slider("proxyRadius", "proxy radius", radius, {.low = 0.0f, .high = 5.0f},
                       point ? "a point" : quantity(settings.proxyRadius, "m")))
        settings.proxyRadius = 1e-3 * std::clamp(static_cast<double>(radius), 0.0, kMaxRadius);
    if (point)
        ImGui::EndDisabled();
    ImGui::PopItemWidth();
}

} // namespace

void drawConfigurations(PanelState& state, Widgets& widgets) {
    HapticSettings& settings = state.settings;
    constexpr std::array kContact{"contact: swept sphere", "contact: neighbourhood watch",
                                  "contact: rays (god-object)", "contact: virtual point (Kim)",
                                  "contact: potential"};
    int method = static_cast<int>(settings.contact);
    if (widgets.combo("contact", method, kContact))
        settings.contact = static_cast<ContactMethod>(method);
    if (settings.contact == ContactMethod::Rays) {
        constexpr std::array kPrecision{"precision: double", "precision: single"};
        int precision = static_cast<int>(settings.precision);
        if (widgets.combo("precision", precision, kPrecision))
            settings.precision = static_cast<Precision>(precision);
    }
    moves(settings, widgets);
    way(widgets, "shadingModel", settings.forceShading, ShadingMode::Off, ShadingMode::TwoPass,
        std::array{"shading: two passes (Ruspini)", "shading: projected (Ho)",
                   "shading: direction (Morgenbesser)", "shading: as each material says",
                   "shading: two passes once a tick", "shading: two passes, patch of normals"});
    way(widgets, "textureLaw", settings.texture, TextureMode::Off, TextureMode::Law,
        std::array{"texture: displacement law", "texture: Blinn's normal", "texture: Minsky's lateral force",
                   "texture: Blinn's normal and magnitude"});
    if (settings.texture != TextureMode::Off) {
        // These have no value for off: the one before the first.
        way(widgets, "textureFilter", settings.textureFilter, static_cast<TextureFilter>(0xFF),
            TextureFilter::Nearest,
            std::array{"filter: nearest", "filter: bilinear", "filter: bicubic", "filter: mip, by speed"});
        way(widgets, "textureGradient", settings.textureGradient, static_cast<TextureGradient>(0xFF),
            TextureGradient::Central,
            std::array{"gradient: central", "gradient: precomputed", "gradient: analytic"});
    }
    way(widgets, "frictionLaw", settings.friction, FrictionMode::Off, FrictionMode::Zilles,
        std::array{"friction: sawtooth (Zilles)", "friction: two states (Ho)", "friction: elasto-plastic",
                   "friction: velocity threshold", "friction: lagging point (Kim)"});
    sliders(settings, widgets);
}

} // namespace touchstone
