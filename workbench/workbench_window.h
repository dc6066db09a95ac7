#pragma once
// The window: it loads models on a worker, lets the servo touch them, and draws thirty times a second what
// was felt. workbench.cpp tells a frame's story; workbench_models.cpp has what opens, shows and leaves a
// model, workbench_picture.cpp what a frame draws and what its buttons ask for.

#include "engine/core/error.h"
#include "renderer/draw_quality.h"
#include "renderer/frame_pace.h"
#include "workbench/editor/drawn_materials.h"
#include "workbench/files/saved_file.h"
#include "workbench/files/state_folder.h"
#include "workbench/gallery/file_note.h"
#include "workbench/gallery/gallery.h"
#include "workbench/guards/interrupt.h"
#include "workbench/model/animate.h"
#include "workbench/model/default_scene.h"
#include "workbench/model/environment_light.h"
#include "workbench/model/opening.h"
#include "workbench/options/commands.h"
#include "workbench/options/gpu_options.h"
#include "workbench/panels/material_window.h"
#include "workbench/screen/key_queue.h"
#include "workbench/screen/key_watch.h"
#include "workbench/screen/model_picture.h"
#include "workbench/screen/screen.h"
#include "workbench/screen/view_control.h"
#include "workbench/timeline/timeline_controller.h"
#include "workbench/touch/force_key.h"
#include "workbench/touch/live_touch.h"
#include "workbench/window/layout.h"
#include "workbench/window/status_file.h"
#include "workbench/window/unsaved_changes_prompt.h"
#include "workbench/window/window_memory.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

/// s, of the steady clock.
[[nodiscard]] inline double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}
/// How finely a device draws: coarser where the CPU does.
[[nodiscard]] DrawQuality qualityOn(const Gpu& gpu);

/// All of it on the main thread.
class WorkbenchWindow {
  public:
    /// Opens window and Vulkan, starts the servo. Throws Error.
    explicit WorkbenchWindow(const WindowOptions& options);
    /// Begins to read a model, or a recording to look at.
    void open(const std::filesystem::path& path);
    ~WorkbenchWindow();
    WorkbenchWindow(const WorkbenchWindow&) = delete;
    WorkbenchWindow& operator=(const WorkbenchWindow&) = delete;
    /// One turn of the main loop.
    void frame();
    /// Asks before unsaved materials are lost, unless it is the system that wants an end.
    [[nodiscard]] bool closed();
    [[nodiscard]] bool loading() const { return opening_.busy() || timeline_.opening(); }
    [[nodiscard]] bool hasModel() const { return touch_.hasModel(); }

  private:
    /// Work that draws. Where its device is lost another is taken, and shows again what was shown.
    template <class Work>
    void onScreen(const Work& work) {
        try {
            work();
        } catch (const DeviceLost& lost) {
            takeAnotherDevice(lost);
        }
    }
    void takeAnotherDevice(const DeviceLost& lost);
    /// Shows the model that the worker has made, or says why there is none. Without any model, throws.
    void takeModel();
    void show(LoadedModel loaded);
    /// Touches what the material editor has made, and goes on touching where it may.
    void takeMaterials();
    void leaveFor(const std::filesystem::path& path);
    /// Goes where the user wanted to go, once unsaved materials are seen to.
    void leave();
    [[nodiscard]] const HapticSettings& shownSettings() const {
        return timeline_.looking() && !timeline_.again().running() ? timeline_.settings() : state_.settings;
    }
    /// Sees to the recording that is looked at, and opens the model that it touched. Without any model,
    /// throws where it cannot be opened.
    void lookBack(double now);
    /// What the picture and the panels show: the recording's tick while one is looked at.
    [[nodiscard]] const TickRecord& shownTick() const;
    /// The settings as they are chosen; but the force is off while a recording is looked at.
    void sendSettings();
    /// When the event is handled, not in the frame that takes it.
    void keyDown(int key, int modifiers);
    void showMaterials();
    void prepareSettings();
    /// Tells the hand where it is to be, whichever it is.
    void moveHand();
    void holdDevice();
    void draw();
    std::map<std::string, WidgetRect> drawMaterials(float scale);
    [[nodiscard]] PanelInput panelInput(const glm::ivec2& sceneSize);
    /// What the buttons and menus of this frame asked for.
    void doWhatWasAsked(const std::map<std::string, WidgetRect>& widgets);
    void saveChart();
    /// Framebuffer pixels of a place in window coordinates.
    [[nodiscard]] static PixelRect pixelsOf(const WidgetRect& rect);
    /// For the next run.
    void remember();
    /// The part of the framebuffer that bar and panels leave, pixels.
    [[nodiscard]] PixelRect pictureArea() const;
    [[nodiscard]] double aspect() const;
    /// Adapts the picture to the time it took and waits for the next frame's turn, handling events meanwhile.
    void pace(double start);
    WindowMemory memory_;
    const std::vector<std::filesystem::path> samples_ = sampleScenes();
    const std::vector<std::string> sampleNotes_ = notesOf(samples_);
    Window window_;
    Screen screen_;
    EnvironmentLight environment_;
    DrawQuality quality_;
    std::string notice_; // of the recorder
    LiveTouch touch_;
    InterruptedForce interruptedForce_;
    ForceKey forceKey_;
    KeyWatch forceWatch_;
    KeyQueue keys_;
    TimelineController timeline_;
    Opening opening_;
    DrawnMaterials drawn_;
    MaterialController materials_;
    MaterialPanelState materialState_;
    Gallery gallery_;
    ViewControl view_;
    PanelState state_;
    ModelPicture picture_{stateFolder() / "pictures"};
    PictureController chartPictures_{stateFolder() / "pictures"};
    StatusFile status_;
    std::string problem_;
    UnsavedChangesPrompt unsavedChanges_;
    bool left_ = false;          // the user has said what becomes of unsaved materials
    FramePace pace_{1.0 / 30.0}; // s, from frame to frame
    double longestFrame_ = 0.0;  // s, since a model was last opened
};

} // namespace touchstone
