#include "workbench/window/panel.h"

#include "workbench/figures/time_histogram.h"
#include "workbench/window/force_plot.h"
#include "workbench/window/panels/budget_panel.h"
#include "workbench/window/panels/error_panel.h"
#include "workbench/window/view_menu.h"

#include <imgui.h>

#include <array>
#include <cstdio>

namespace touchstone {

namespace {

class Panel {
  public:
    Panel(const PanelInput& input, PanelState& state) : in_(input), state_(state), widgets_(input.scale) {}

    std::map<std::string, WidgetRect> draw() {
        header();
        model();
        hand();
        record();
        feel();
        force();
        section("TICK");
        drawBudget(*in_.servo, widgets_);
        section("ERROR");
        drawError(in_.servo->error, widgets_);
        plan();
        servo();
        view();
        warnings();
        keys();
        return widgets_.take();
    }

  private:
    void header() {
        const auto [text, color] = lamp();
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float radius = 0.32f * ImGui::GetTextLineHeight();
        ImGui::GetWindowDrawList()->AddCircleFilled(
            ImVec2(at.x + radius, at.y + 0.5f * ImGui::GetTextLineHeight()), radius, color);
        ImGui::Dummy(ImVec2(2.0f * radius, ImGui::GetTextLineHeight()));
        ImGui::SameLine();
        ImGui::TextUnformatted(text);
        mark("lamp");
        ImGui::Spacing();
    }

    struct Lamp {
        const char* text;
        ImU32 color;
    };
    [[nodiscard]] Lamp lamp() const {
        constexpr ImU32 kGrey = IM_COL32(120, 126, 133, 255), kGreen = IM_COL32(80, 200, 120, 255),
                        kAmber = IM_COL32(240, 180, 60, 255), kRed = IM_COL32(235, 75, 65, 255);
        const HapticOutput& tick = in_.servo->last.output;
        if (in_.loading)
            return {"Loading", kAmber};
        if (has(tick.flags, TickFlag::SafetyLatched))
            return {"Force off after a fault: press space twice", kRed};
        if (!state_.settings.forceEnabled)
            return {"Force off (space)", kAmber};
        if (has(tick.flags, TickFlag::StartedInside))
            return {"Inside: move out to touch", kAmber};
        if (has(tick.flags, TickFlag::InputInvalid))
            return {"No hand", kGrey};
        if (has(tick.flags, TickFlag::ForceRamping) && tick.contacts > 0)
            return {"Force fades in", kAmber};
        return tick.contacts > 0 ? Lamp{"Touching", kGreen} : Lamp{"In the air", kGrey};
    }

    void section(const char* title) {
        ImGui::Dummy(ImVec2(0.0f, 2.0f * in_.scale));
        ImGui::TextDisabled("%s", title);
        ImGui::Separator();
    }

    void model() {
        section("MODEL");
        ImGui::TextUnformatted(in_.modelName.empty() ? "none yet" : in_.modelName.c_str());
        if (!in_.modelFacts.empty())
            ImGui::TextDisabled("%s", in_.modelFacts.c_str());
        if (in_.loading)
            ImGui::ProgressBar(static_cast<float>(in_.loadFraction), ImVec2(-1.0f, 0.0f),
                               in_.loadActivity.c_str());
        if (!in_.problem.empty()) {
            ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0.95f, 0.5f, 0.42f, 1.0f));
            ImGui::TextWrapped("%s", in_.problem.c_str());
            ImGui::PopStyleColor();
        }
    }

    void hand() {
        section("HAND");
        const bool held = !state_.device.empty();
        if (ImGui::RadioButton("Mouse", !held && !state_.simulatedHand))
            letGo(false);
        mark("mouse");
        ImGui::SameLine(0.0f, 24.0f * in_.scale);
        if (!in_.canSimulate)
            ImGui::BeginDisabled();
        if (ImGui::RadioButton("Simulated hand", !held && state_.simulatedHand))
            letGo(true);
        mark("simulatedHand");
        if (!in_.canSimulate)
            ImGui::EndDisabled();
        if (held || !in_.devices.empty())
            devices();
        if (!in_.deviceStatus.empty())
            ImGui::TextWrapped("%s", in_.deviceStatus.c_str());
    }

    void letGo(bool simulate) {
        state_.simulatedHand = simulate;
        state_.device.clear();
    }

    /// What is plugged in.
    void devices() {
        const char* shown = state_.device.empty() ? "hold a device" : state_.device.c_str();
        for (const DeviceOffer& offer : in_.devices)
            if (offer.choice == state_.device)
                shown = offer.name.c_str();
        ImGui::PushItemWidth(-1.0f);
        if (ImGui::BeginCombo("##device", shown)) {
            for (const DeviceOffer& offer : in_.devices)
                if (ImGui::Selectable((offer.name + "  " + offer.choice).c_str(),
                                      offer.choice == state_.device))
                    state_.device = offer.choice;
            ImGui::EndCombo();
        }
        mark("device");
        ImGui::PopItemWidth();
    }

    void record() {
        if (in_.recording)
            ImGui::PushStyleColor(ImGuiCol_Button, IM_COL32(150, 45, 40, 255));
        // One widget, whatever it says.
        state_.recordPressed = ImGui::SmallButton(in_.recording ? "Stop###record" : "Record###record");
        if (in_.recording)
            ImGui::PopStyleColor();
        mark("record");
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s", in_.recordingFile.empty() ? "keeps every tick, for `touchstone replay`"
                                                              : in_.recordingFile.c_str());
        if (in_.recordingFile.empty())
            return;
        ImGui::SameLine();
        ImGui::TextDisabled("%.1f s in %s", in_.recordedSeconds,
                            in_.recordingFile.substr(in_.recordingFile.rfind('/') + 1).c_str());
    }

    /// A check box for an effect that may have several ways of being on: it comes back in the way it was.
    template <class Mode>
    void toggle(const char* label, const char* name, Mode& mode, Mode& chosen, Mode off, Mode usual) {
        bool on = mode != off;
        if (on)
            chosen = mode;
        if (ImGui::Checkbox(label, &on))
            mode = !on ? off : (chosen != off ? chosen : usual);
        mark(name);
    }

    void contact() {
        constexpr std::array kLabels{"contact: swept sphere", "contact: neighbourhood watch"};
        ImGui::PushItemWidth(-1.0f);
        int method = static_cast<int>(state_.settings.contact);
        if (ImGui::Combo("##contact", &method, kLabels.data(), static_cast<int>(kLabels.size())))
            state_.settings.contact = static_cast<ContactMethod>(method);
        mark("contact");
        ImGui::PopItemWidth();
    }

    /// How a smooth surface is made of facets, while it is.
    void shadingModel() {
        constexpr std::array kLabels{"shading: two passes (Ruspini)", "shading: projected (Ho)",
                                     "shading: direction (Morgenbesser)", "shading: as each material says"};
        ShadingMode& mode = state_.settings.forceShading;
        if (mode == ShadingMode::Off)
            return;
        ImGui::PushItemWidth(-1.0f);
        int model = static_cast<int>(mode) - static_cast<int>(ShadingMode::TwoPass);
        if (ImGui::Combo("##shadingModel", &model, kLabels.data(), static_cast<int>(kLabels.size())))
            mode = static_cast<ShadingMode>(model + static_cast<int>(ShadingMode::TwoPass));
        mark("shadingModel");
        ImGui::PopItemWidth();
    }

    /// The proxy's moves.
    void budget() {
        constexpr std::array kMoves{1, 2, 4, 8, 16, 64};
        char shown[48];
        std::snprintf(shown, sizeof shown, "at most %d moves a tick", state_.settings.iterationBudget);
        ImGui::PushItemWidth(-1.0f);
        if (ImGui::BeginCombo("##iterationBudget", shown)) {
            for (const int moves : kMoves)
                if (ImGui::Selectable(std::to_string(moves).c_str(),
                                      moves == state_.settings.iterationBudget))
                    state_.settings.iterationBudget = moves;
            ImGui::EndCombo();
        }
        mark("iterationBudget");
        ImGui::PopItemWidth();
    }

    /// How the maps become force, while they do.
    void textureLaw() {
        constexpr std::array kLabels{"texture: displacement law", "texture: Blinn's normal",
                                     "texture: Minsky's lateral force"};
        if (state_.settings.texture == TextureMode::Off)
            return;
        ImGui::PushItemWidth(-1.0f);
        int law = static_cast<int>(state_.settings.texture) - static_cast<int>(TextureMode::Law);
        if (ImGui::Combo("##textureLaw", &law, kLabels.data(), static_cast<int>(kLabels.size())))
            state_.settings.texture = static_cast<TextureMode>(law + static_cast<int>(TextureMode::Law));
        mark("textureLaw");
        ImGui::PopItemWidth();
    }

    /// How maps are read, while they are.
    void textureReading() {
        constexpr std::array kFilters{"filter: nearest", "filter: bilinear", "filter: bicubic",
                                      "filter: mip, by speed"};
        constexpr std::array kGradients{"gradient: central", "gradient: precomputed", "gradient: analytic"};
        if (state_.settings.texture == TextureMode::Off)
            return;
        ImGui::PushItemWidth(-1.0f);
        int filter = static_cast<int>(state_.settings.textureFilter);
        if (ImGui::Combo("##textureFilter", &filter, kFilters.data(), static_cast<int>(kFilters.size())))
            state_.settings.textureFilter = static_cast<TextureFilter>(filter);
        mark("textureFilter");
        int gradient = static_cast<int>(state_.settings.textureGradient);
        if (ImGui::Combo("##textureGradient", &gradient, kGradients.data(),
                         static_cast<int>(kGradients.size())))
            state_.settings.textureGradient = static_cast<TextureGradient>(gradient);
        mark("textureGradient");
        ImGui::PopItemWidth();
    }

    /// Which law holds the proxy back, while one does.
    void frictionLaw() {
        constexpr std::array kLabels{"friction: sawtooth (Zilles)", "friction: two states (Ho)",
                                     "friction: elasto-plastic"};
        FrictionMode& mode = state_.settings.friction;
        if (mode == FrictionMode::Off)
            return;
        ImGui::PushItemWidth(-1.0f);
        int law = static_cast<int>(mode) - static_cast<int>(FrictionMode::Zilles);
        if (ImGui::Combo("##frictionLaw", &law, kLabels.data(), static_cast<int>(kLabels.size())))
            mode = static_cast<FrictionMode>(law + static_cast<int>(FrictionMode::Zilles));
        mark("frictionLaw");
        ImGui::PopItemWidth();
    }

    void feel() {
        section("FEEL");
        HapticSettings& settings = state_.settings;
        HapticSettings& chosen = state_.chosen;
        contact();
        toggle("Force shading", "forceShading", settings.forceShading, chosen.forceShading, ShadingMode::Off,
               ShadingMode::Material);
        shadingModel();
        toggle("Texture", "texture", settings.texture, chosen.texture, TextureMode::Off, TextureMode::Law);
        textureLaw();
        textureReading();
        toggle("Friction", "friction", settings.friction, chosen.friction, FrictionMode::Off,
               FrictionMode::Zilles);
        frictionLaw();
        budget();
        ImGui::PushItemWidth(-1.0f);
        auto stiffness = static_cast<float>(settings.stiffness);
        const char* shown = stiffness <= 0.0f ? "stiffness: the material's" : "stiffness %.0f N/m";
        if (ImGui::SliderFloat("##stiffness", &stiffness, 0.0f, 3000.0f, shown))
            settings.stiffness = static_cast<double>(stiffness);
        mark("stiffness");
        const bool point = settings.contact == ContactMethod::Neighbourhood;
        if (point)
            ImGui::BeginDisabled();
        auto radius = static_cast<float>(1e3 * settings.proxyRadius);
        if (ImGui::SliderFloat("##proxyRadius", &radius, 0.0f, 5.0f,
                               point ? "proxy radius: a point" : "proxy radius %.2f mm"))
            settings.proxyRadius = 1e-3 * static_cast<double>(radius);
        mark("proxyRadius");
        if (point)
            ImGui::EndDisabled();
        ImGui::PopItemWidth();
    }

    void force() {
        section("FORCE");
        const HapticOutput& tick = in_.servo->last.output;
        ImGui::Text("%.2f N", glm::length(tick.force));
        ImGui::SameLine();
        ImGui::TextDisabled("at a depth of %.2f mm", 1e3 * tick.penetration);
        drawForcePlot(*in_.forces, 80.0f * in_.scale);
        PassivityMode& passivity = state_.settings.passivity;
        bool controlled = passivity == PassivityMode::Control;
        if (ImGui::Checkbox("Passivity control", &controlled))
            passivity = controlled ? PassivityMode::Control : PassivityMode::Observe;
        mark("passivity");
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("Damps what the device gives the hand beyond what it took");
        ImGui::SameLine();
        if (passivity != PassivityMode::Off)
            ImGui::TextDisabled("%+.2f mJ", 1e3 * tick.energyBalance);
    }

    /// What the scene calls for, and why.
    void plan() {
        if (in_.plan.empty() || !ImGui::TreeNode("effects of this scene"))
            return;
        for (const PlannedEffect& effect : in_.plan) {
            const auto material = static_cast<size_t>(effect.material);
            const bool named = effect.material >= 0 && material < in_.materialNames.size();
            ImGui::TextColored(effect.on ? ImVec4(0.45f, 0.82f, 0.55f, 1.0f)
                                         : ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled),
                               "%s %s", effect.on ? "on" : "off", effectName(effect.effect));
            ImGui::PushTextWrapPos(0.0f);
            ImGui::TextDisabled("%s: %s", named ? in_.materialNames[material].c_str() : "default material",
                                effect.reason.c_str());
            ImGui::PopTextWrapPos();
        }
        ImGui::TreePop();
    }

    void row(const char* label, const char* format, double a, double b = 0.0) {
        ImGui::TextDisabled("%s", label);
        ImGui::SameLine(120.0f * in_.scale);
        ImGui::Text(format, a, b);
    }

    void servo() {
        section("SERVO");
        const ServoView& servo = *in_.servo;
        row("rate", "%.0f Hz of %.0f", servo.ticksPerSecond, servo.rateHz);
        row("missed", "%.0f of %.0f", static_cast<double>(servo.counters.missed),
            static_cast<double>(servo.counters.ticks));
        row("step", "%.1f µs, p99 %.1f µs", servo.stepP50Us, servo.stepP99Us);
        if (ImGui::IsItemHovered())
            showTimeHistogram("Time of a step, up to µs (log of ticks)", "last 4 s", servo.stepHistogram,
                              in_.scale);
        row("wake-up", "%.1f µs, p99 %.1f µs", servo.wakeP50Us, servo.wakeP99Us);
        if (ImGui::IsItemHovered())
            showTimeHistogram("Wake-up after the deadline, up to µs (log of ticks)", servo.scheduling.c_str(),
                              servo.wakeHistogram, in_.scale);
        if (servo.stolenShare && *servo.stolenShare > 0.0005)
            row("stolen", "%.1f %% of a processor", 100.0 * *servo.stolenShare);
        row("picture", "%.0f frames/s", in_.framesPerSecond);
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%d x %d on %s", in_.sceneSize.x, in_.sceneSize.y, in_.gpuName.c_str());
    }

    void view() {
        section("VIEW");
        drawViewMenu(state_.view, [this](const char* name) { mark(name); });
    }

    void warnings() {
        if (in_.warnings.empty() && in_.notice.empty())
            return;
        section("WARNINGS");
        ImGui::PushTextWrapPos(0.0f);
        if (!in_.notice.empty())
            ImGui::TextUnformatted(in_.notice.c_str());
        for (const std::string& warning : in_.warnings)
            ImGui::TextUnformatted(warning.c_str());
        ImGui::PopTextWrapPos();
    }

    void keys() {
        ImGui::Dummy(ImVec2(0.0f, 4.0f * in_.scale));
        ImGui::TextDisabled("Pointer and keys: rest here to read");
        if (!ImGui::IsItemHovered())
            return;
        ImGui::BeginTooltip();
        ImGui::TextUnformatted("Left drag      moves the hand in the plane of the view\n"
                               "Wheel          moves it in depth (Shift: finely)\n"
                               "Right or middle drag turns the view; Shift shifts it, Ctrl zooms\n"
                               "Alt+left drag  does the same\n"
                               "Ctrl+wheel     zooms\n"
                               "Home or F      shows all\n"
                               "1, 3, 7        from the front, the right, above; Ctrl: the other side\n"
                               ".              goes near the probe\n"
                               "T              turntable\n"
                               "V              the next view, Shift: the one before\n"
                               "M              magnifier\n"
                               "O              overlays\n"
                               "F12            saves the picture\n"
                               "Space          switches the force off and on\n"
                               "A .glb or .gltf dropped here is opened");
        ImGui::EndTooltip();
    }

    void mark(const char* name) { widgets_.mark(name); }

    const PanelInput& in_;
    PanelState& state_;
    Widgets widgets_;
};

} // namespace

std::map<std::string, WidgetRect> drawPanel(const PanelInput& input, PanelState& state) {
    const ImGuiIO& io = ImGui::GetIO();
    const float width = kPanelWidth * input.scale;
    ImGui::SetNextWindowPos(ImVec2(io.DisplaySize.x - width, 0.0f));
    ImGui::SetNextWindowSize(ImVec2(width, io.DisplaySize.y));
    ImGui::Begin("panel", nullptr,
                 ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings);
    std::map<std::string, WidgetRect> widgets = Panel(input, state).draw();
    ImGui::End();
    return widgets;
}

} // namespace touchstone
