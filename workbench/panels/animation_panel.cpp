#include "engine/scene/animation.h"
#include "workbench/panels/panels.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace touchstone {

namespace {

std::string seconds(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.2f s", value);
    return text;
}

/// Goes on from `shown` (s of the animation) at `speed`, seen from the servo's `time`.
void play(double shown, double speed, double time, HapticSettings& settings) {
    settings.animationSpeed = speed;
    settings.animationOffset = shown - speed * time;
}

void chooseAnimation(const Scene& scene, int playing, PanelState& state, Widgets& widgets) {
    std::vector<std::string> names;
    for (size_t a = 0; a < scene.animations.size(); ++a)
        names.push_back(std::to_string(a) + "  " + scene.animations[a].name);
    std::vector<const char*> labels;
    for (const std::string& name : names)
        labels.push_back(name.c_str());
    int chosen = playing;
    if (widgets.combo("animation", chosen, labels) && chosen != playing)
        state.animation = chosen;
}

} // namespace

void drawAnimation(const PanelInput& input, PanelState& state, Widgets& widgets) {
    const Animation* const animation = input.scene != nullptr ? playedAnimation(*input.scene) : nullptr;
    if (animation == nullptr || input.tick == nullptr)
        return;
    widgets.section("ANIMATION");
    const Scene& scene = *input.scene;
    if (scene.animations.size() > 1)
        chooseAnimation(scene, static_cast<int>(animation - scene.animations.data()), state, widgets);
    const double time = input.tick->time, shown = animationTime(state.settings, time);
    // The speed that a pause interrupts; 1 at first.
    ImGuiStorage& storage = *ImGui::GetStateStorage();
    const ImGuiID before = ImGui::GetID("speedBefore");
    const bool plays = state.settings.animationSpeed != 0.0;
    float speed = plays ? static_cast<float>(state.settings.animationSpeed) : storage.GetFloat(before, 1.0f);
    storage.SetFloat(before, speed);
    if (widgets.button("playAnimation", plays ? "Pause##animation" : "Play##animation"))
        play(shown, plays ? 0.0 : static_cast<double>(speed), time, state.settings);
    const double duration = animation->duration;
    if (!(duration > 0.0))
        return;
    ImGui::PushItemWidth(-1.0f);
    auto at = static_cast<float>(loopedTime(*animation, shown));
    if (widgets.slider("animationTime", "at", at,
                       {.low = 0.0f, .high = static_cast<float>(duration), .clamp = true},
                       seconds(static_cast<double>(at)) + " of " + seconds(duration)))
        play(static_cast<double>(at), state.settings.animationSpeed, time, state.settings);
    char text[32];
    std::snprintf(text, sizeof text, "%.2f x", static_cast<double>(speed));
    if (widgets.slider("animationSpeed", "speed", speed, {.low = -2.0f, .high = 2.0f, .clamp = false},
                       text)) {
        // In the middle it would stand still: that is the button's.
        constexpr float kSlowest = 0.01f;
        if (std::abs(speed) < kSlowest)
            speed = kSlowest;
        storage.SetFloat(before, speed);
        if (plays)
            play(shown, static_cast<double>(speed), time, state.settings);
    }
    ImGui::PopItemWidth();
}

} // namespace touchstone
