#pragma once
// Input and output of the panels. Plain values of the main thread.

#include "devices/choice/device_choice.h"
#include "devices/device/workspace_map.h"
#include "devices/stroke/stroke_library.h"
#include "haptics/settings/effect_plan.h"
#include "haptics/settings/haptic_settings.h"
#include "renderer/camera.h"
#include "workbench/files/saved_file.h"
#include "workbench/gallery/gallery_entry.h"
#include "workbench/hand/other_hands.h"
#include "workbench/panels/timeline_panel.h"
#include "workbench/panels/widgets.h"
#include "workbench/readings/chart_quantities.h"
#include "workbench/readings/force_history.h"
#include "workbench/readings/servo_view.h"
#include "workbench/screen/view_options.h"
#include "workbench/sculpt/sculpt_controller.h"
#include "workbench/sound/sound_choice.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

class FailingProgram; // workbench/readings/failing_program.h
class FileDialog;
class HapticScene;
class PersistentTextures; // haptics/texture/persistent_textures.h

/// Input of the panels.
struct PanelInput {
    std::string modelName, modelFacts; ///< "doughnut.glb", "64,800 triangles"
    std::string modelPath;             ///< of the open file, also after Save as
    const Scene* scene = nullptr;      ///< the current scene; null: none yet
    const HapticScene* haptic = nullptr;
    ScenePart part;                                         ///< what is seen and felt of it
    std::span<const std::filesystem::path> recent, samples; ///< to open
    std::span<const std::string> sampleNotes;               ///< note of each sample
    std::span<const GalleryEntry> gallery;
    /// Draws the picture of a gallery entry between two corners, window coordinates.
    std::function<void(size_t, const glm::vec2&, const glm::vec2&)> showPicture;
    std::vector<std::string> warnings;
    std::string problem;       ///< of the last load, with its remedy; empty: none
    uint32_t forcePresses = 0; ///< presses of the force key so far
    bool forceKeyLate = false; ///< a press only switches the force off (ForceKey::late)
    bool typing = false;       ///< a text field has the focus
    double now = 0.0;          ///< s, secondsNow() of the frame
    double servoStart = 0.0;   ///< CLOCK_MONOTONIC, s, at time 0 of the ticks
    std::string notice;        ///< of the recorder: a problem, or a kept file
    bool recording = false;
    std::string recordingFile; ///< the last one; empty: none yet
    double recordedSeconds = 0.0;
    /// Of the material editor.
    const FailingProgram* failing =
        nullptr;                   ///< program without a result where it is touched; null: not known
    std::string materialNotice;    ///< result of the last save or change; empty: none
    bool canSaveMaterials = false; ///< to the open file
    bool materialsEdited = false, materialsWorking = false; ///< unsaved; not in effect yet
    bool loading = false;
    std::string loadName; ///< of the file
    double loadFraction = 0.0;
    std::string loadActivity;
    /// What touch has made of the persistent textures of `haptic`; null: none.
    const PersistentTextures* textures = nullptr;
    bool texturesEdited = false; ///< touch has changed some since they were saved
    bool canSimulate = false;    ///< there is a path for the simulated hand
    std::string strokeNotice;    ///< the stroke is being laid, or why it cannot be; empty: no message
    std::vector<DeviceOffer> devices;
    std::span<const OtherHands::State> others; ///< the hands beside the first
    std::string deviceStatus;                  ///< where the chosen device is, or its problem
    SoundStatus sound;
    SculptStatus sculpt;
    const ServoView* servo = nullptr;
    TimelineController* timeline = nullptr;
    FileDialog* dialog = nullptr;
    const TickRecord* tick = nullptr; ///< on display: the servo's latest, or the recording's at the cursor
    const ForceHistory* forces = nullptr;
    bool forceSent = true;     ///< the force of `tick` is sent to the device (readings/force_parts.h)
    SavedNote savedPicture;    ///< result of the last saved picture
    SavedNote savedCharts;     ///< of the last file of charts
    bool chartsSaving = false; ///< one is being drawn
    uint64_t frames = 0;       ///< presented since the window opened
    double framesPerSecond = 0.0;
    double longestFrame = 0.0; ///< s of work in one frame since a model was last opened
    OrbitCamera camera;
    glm::ivec2 sceneSize{0};
    std::string gpuName;
    float scale = 1.0f;    ///< window coordinates per layout unit
    bool scaleFits = true; ///< false: the UI scale is smaller than asked for, since the window is
};

/// Which panels are folded away, and how large those are that are not: units of layout, less where the window
/// has no room for it. Side panels are made wider only: all they show fits into their least width.
struct PanelFolds {
    static constexpr float kLeftWidth = 236.0f, kRightWidth = 296.0f, kBottomHeight = 196.0f;

    bool left = false, right = false, bottom = false;
    float leftWidth = kLeftWidth, rightWidth = kRightWidth, bottomHeight = kBottomHeight;
    bool operator==(const PanelFolds&) const = default;
};

enum class ChartFile : uint8_t { Csv, Picture, Figure };

/// Output of the panels.
struct PanelState {
    HapticSettings settings;
    HapticSettings chosen; ///< restored when a toggle is switched on again
    bool simulatedHand = false;
    WorkspaceWish workspace; ///< clutch and zoom
    bool centrePressed = false;
    StrokeRequest stroke; ///< of the simulated hand; place and front are set where it is laid
    std::string device;   ///< its choice; empty: the mouse or the simulated hand
    SoundChoice sound;
    SculptChoice sculpt;
    ViewOptions view;
    PanelFolds folds;
    float uiScale = 1.0f; ///< asked for, beside the monitor's
    HoveredWidget hovered;
    ShownQuantities charts = kFirstQuantities;
    bool help = false;
    bool walking = false;       ///< the arrow keys move between the panels' widgets
    bool gallery = false;       ///< is open
    size_t galleryAt = 0;       ///< the entry that Enter opens
    bool editMaterials = false; ///< the material editor is open
    bool introduced = false;    ///< the first-run card was dismissed
    TimelinePanelState timeline;
    std::optional<ForceHistory> stopped; ///< contents of the charts while they are paused

    // Requests of this frame; cleared by the code that handles them:
    /// Target of leaving in spite of unsaved materials: another model, or an empty path to exit.
    std::optional<std::filesystem::path> leaving;
    enum class Leave : uint8_t { Undecided, Save, Discard, Stay } leave = Leave::Undecided; ///< in this frame
    bool recordPressed = false, cancelPressed = false, dismissPressed = false, quitPressed = false;
    bool openPressed = false; ///< ask for a file to open
    bool noticeDismissed = false;
    std::optional<ChartFile> chartWanted;
    std::optional<double> iso;                         ///< of the volume: build this surface
    std::optional<int> animation;                      ///< Scene::animations: play this one
    std::optional<std::filesystem::path> open, forget; ///< forget: remove it from the recent files
};

} // namespace touchstone
