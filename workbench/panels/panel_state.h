#pragma once
// What the panels show and what they change. Plain values of the main thread.

#include "devices/choice/device_choice.h"
#include "devices/device/workspace_map.h"
#include "devices/stroke/stroke_library.h"
#include "haptics/settings/effect_plan.h"
#include "haptics/settings/haptic_settings.h"
#include "renderer/camera.h"
#include "workbench/gallery/gallery_entry.h"
#include "workbench/panels/timeline_panel.h"
#include "workbench/panels/widgets.h"
#include "workbench/readings/force_history.h"
#include "workbench/readings/servo_view.h"
#include "workbench/screen/view_options.h"
#include "workbench/sound/sound_choice.h"

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

class HapticScene;

/// What the panels show.
struct PanelInput {
    std::string modelName, modelFacts; ///< "doughnut.glb", "64,800 triangles"
    const Scene* scene = nullptr;      ///< what is shown; null: nothing yet
    const HapticScene* haptic = nullptr;
    std::span<const std::filesystem::path> recent, samples; ///< to open
    std::span<const std::string> sampleNotes;               ///< what there is to feel in each sample
    std::span<const GalleryEntry> gallery;
    /// Shows the picture of an entry of the gallery between two corners, window coordinates.
    std::function<void(size_t, const glm::vec2&, const glm::vec2&)> showPicture;
    std::vector<std::string> warnings;
    std::string problem;       ///< of the last load, with its remedy; empty: none
    uint32_t forcePresses = 0; ///< of the force key so far
    bool typing = false;       ///< into a text field
    double servoStart = 0.0;   ///< CLOCK_MONOTONIC, s, at which the time of the ticks is 0
    std::string notice;        ///< of the recorder: what went wrong, or what was kept
    bool recording = false;
    std::string recordingFile; ///< the last one; empty: none yet
    double recordedSeconds = 0.0;
    /// Of the material editor.
    std::string materialNotice;    ///< what became of the last save or change; empty: nothing to tell
    bool canSaveMaterials = false; ///< into the file that is open
    bool materialsEdited = false, materialsWorking = false; ///< not in the file yet; not touchable yet
    bool loading = false;
    std::string loadName; ///< of the file
    double loadFraction = 0.0;
    std::string loadActivity;
    bool canSimulate = false; ///< there is a path for the simulated hand
    std::string strokeNotice; ///< that the stroke is being laid, or why it cannot be; empty: nothing to tell
    std::vector<DeviceOffer> devices;
    std::string deviceStatus; ///< where the chosen device is, or what is wrong with it
    SoundStatus sound;
    const ServoView* servo = nullptr;
    TimelineController* timeline = nullptr;
    const TickRecord* tick = nullptr; ///< that is shown: the servo's newest, or the recording's at the cursor
    const ForceHistory* forces = nullptr;
    std::string picture; ///< what became of the last picture that was to be saved; empty: none yet
    uint64_t frames = 0; ///< presented since the window opened
    double framesPerSecond = 0.0;
    double longestFrame = 0.0; ///< s of work in one frame since a model was last opened
    OrbitCamera camera;
    glm::ivec2 sceneSize{0};
    std::string gpuName;
    float scale = 1.0f; ///< window coordinates for one unit of the layout
};

/// Which panels are folded away.
struct PanelFolds {
    bool left = false, right = false, bottom = false;
    bool operator==(const PanelFolds&) const = default;
};

enum class ChartFile : uint8_t { Csv, Picture };

/// What the panels change.
struct PanelState {
    HapticSettings settings;
    HapticSettings chosen; ///< what the toggles return to when switched on again
    bool simulatedHand = false;
    WorkspaceWish workspace; ///< clutch and zoom
    bool centrePressed = false;
    StrokeRequest stroke; ///< of the simulated hand; place and front are where it is laid
    std::string device;   ///< what chooses it; empty: the mouse or the simulated hand
    SoundChoice sound;
    ViewOptions view;
    PanelFolds folds;
    bool help = false;
    bool walking = false;       ///< the arrow keys walk through the panels
    bool gallery = false;       ///< is open
    size_t galleryAt = 0;       ///< entry that Enter opens
    bool editMaterials = false; ///< the material editor is open
    bool introduced = false;    ///< the first-run card was read
    TimelinePanelState timeline;
    std::optional<ForceHistory> stopped;            ///< what the charts show while they are paused
    std::string openPath = std::string(1024, '\0'); ///< what is being typed

    // Asked for in this frame; whoever does it takes it back:
    /// Where the user wants to go although materials are not saved: another model, or nowhere (an empty
    /// path).
    std::optional<std::filesystem::path> leaving;
    enum class Leave : uint8_t { Undecided, Save, Discard, Stay } leave = Leave::Undecided; ///< in this frame
    bool recordPressed = false, cancelPressed = false, dismissPressed = false, quitPressed = false;
    bool noticeDismissed = false;
    std::optional<ChartFile> chartWanted;
    std::optional<std::filesystem::path> open, forget; ///< forget: that it was opened
};

} // namespace touchstone
