#pragma once

#include "devices/device_choice.h"
#include "haptics/effect_plan.h"
#include "haptics/haptic_settings.h"
#include "renderer/camera.h"
#include "workbench/window/force_history.h"
#include "workbench/window/panels/widgets.h"
#include "workbench/window/servo_view.h"
#include "workbench/window/view_options.h"

#include <map>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// What the panel shows.
struct PanelInput {
    std::string modelName, modelFacts; ///< "doughnut.glb", "64,800 triangles"
    std::vector<std::string> warnings;
    std::string problem; ///< of the last load, with its remedy; empty: none
    std::string notice;  ///< of the recorder: what went wrong, or what was kept
    bool recording = false;
    std::string recordingFile; ///< the last one; empty: none yet
    double recordedSeconds = 0.0;
    bool loading = false;
    double loadFraction = 0.0;
    std::string loadActivity;
    bool canSimulate = false; ///< there is a path for the simulated hand
    std::vector<DeviceOffer> devices;
    std::string deviceStatus; ///< where the chosen device is, or what is wrong with it
    const ServoView* servo = nullptr;
    std::span<const PlannedEffect> plan; ///< of the scene
    std::vector<std::string> materialNames;
    const ForceHistory* forces = nullptr;
    std::string picture; ///< what became of the last picture that was to be saved; empty: none yet
    double framesPerSecond = 0.0;
    OrbitCamera camera;
    glm::ivec2 sceneSize{0};
    std::string gpuName;
    float scale = 1.0f; ///< window coordinates for one unit of the layout
};

/// What the panel changes. Plain values of the main thread.
struct PanelState {
    HapticSettings settings;
    HapticSettings chosen; ///< what the toggles return to when switched on again
    bool simulatedHand = false;
    std::string device; ///< what chooses it; empty: the mouse or the simulated hand
    ViewOptions view;
    bool recordPressed = false; ///< the record button, in this frame
};

/// Units of layout that the panel takes on the right of the window.
inline constexpr float kPanelWidth = 320.0f;

/// Draws the panel over the right side of the ImGui frame and applies what the user did to `state`. Returns
/// where its widgets are, by name ("friction", "texture", "forceShading", "stiffness", ...).
std::map<std::string, WidgetRect> drawPanel(const PanelInput& input, PanelState& state);

} // namespace touchstone
