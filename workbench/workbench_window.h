#pragma once
// The window: loads models on a worker, runs the servo on them, and draws thirty times a second.
// workbench.cpp has the main loop; workbench_models.cpp opens, shows and leaves a model;
// workbench_picture.cpp draws a frame and handles its buttons.

#include "engine/core/error.h"
#include "engine/time/seconds_now.h"
#include "renderer/draw_quality.h"
#include "renderer/frame_pace.h"
#include "workbench/dialog/file_dialog.h"
#include "workbench/editor/drawn_materials.h"
#include "workbench/files/chart_file.h"
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
#include "workbench/readings/force_parts.h"
#include "workbench/screen/axis_gizmo.h"
#include "workbench/screen/key_queue.h"
#include "workbench/screen/key_watch.h"
#include "workbench/screen/model_picture.h"
#include "workbench/screen/part_menu.h"
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
#include <map>
#include <new>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {
/// Draw quality of a device: coarser for a software device.
[[nodiscard]] DrawQuality qualityOn(const Gpu& gpu);
/// Of frames over a kept picture, on any device: the whole resolution first.
[[nodiscard]] DrawQuality keptQuality();

/// Main thread only.
class WorkbenchWindow {
  public:
    /// Opens window and Vulkan, starts the servo. Throws Error.
    explicit WorkbenchWindow(const WindowOptions& options);
    /// Starts to load a model or a recording.
    void open(const std::filesystem::path& path, const SceneChoice& choice = {});
    ~WorkbenchWindow();
    WorkbenchWindow(const WorkbenchWindow&) = delete;
    WorkbenchWindow& operator=(const WorkbenchWindow&) = delete;
    /// One iteration of the main loop.
    void frame();
    /// Prompts before unsaved materials are lost, unless the system requests the end.
    [[nodiscard]] bool closed();
    [[nodiscard]] bool loading() const { return opening_.busy() || timeline_.opening(); }
    [[nodiscard]] bool hasModel() const { return touch_.hasModel(); }

  private:
    /// Work that draws. If its device is lost, another is created and shows the same content.
    template <class Work>
    void onScreen(const Work& work) {
        try {
            work();
        } catch (const DeviceLost& lost) {
            takeAnotherDevice(lost);
        }
    }
    void takeAnotherDevice(const DeviceLost& lost);
    /// Shows the model from the worker, or reports why there is none. Without any model, throws.
    void takeModel();
    /// In a handler of what a model's opening has thrown: tells it, with the model that is shown, or else
    /// with the sample. Throws it on for the program's first model.
    void stayWithout(const std::string& problem);
    void show(LoadedModel loaded);
    /// Touches the material editor's result; contact is kept where possible.
    void takeMaterials();
    void leaveFor(const std::filesystem::path& path);
    /// Names the window after the model's file and puts it first among the recent ones.
    void nameAfter(const std::filesystem::path& file);
    /// Asks for a file to open, or to save the materials to.
    void askForFile(FilePurpose purpose);
    /// Opens or saves to what the file dialog has chosen.
    void takeFile(double now);
    /// Continues to the user's target once unsaved materials are handled.
    void leave();
    /// Settings of the displayed tick.
    [[nodiscard]] HapticSettings shownSettings() const;
    /// The chosen settings, but with the force off while a recording is open.
    [[nodiscard]] HapticSettings sentSettings() const;
    /// Updates the open recording and opens its model. Without any model, throws where that fails.
    void lookBack(double now);
    /// The displayed tick: the recording's while one is open.
    [[nodiscard]] const TickRecord& shownTick() const;
    void sendSettings();
    /// Called when the event is handled, not in the frame that takes it.
    void keyDown(int key, int modifiers);
    void showMaterials();
    void prepareSettings();
    /// Sends its target to the current hand.
    void moveHand();
    void holdDevice();
    void draw();
    /// Materials, sculpture and poses of the model, as they are drawn next.
    void poseModel();
    /// Menu and keys that hide objects, and what they ask for.
    void showPart(const PixelRect& area, double points, std::map<std::string, WidgetRect>& rects);
    std::map<std::string, WidgetRect> drawMaterials(float scale);
    [[nodiscard]] PanelInput panelInput(const glm::ivec2& sceneSize);
    // Parts of it:
    void describeModel(PanelInput& input);
    void describeFiles(PanelInput& input);
    void describeHand(PanelInput& input);
    void describePicture(const glm::ivec2& sceneSize, PanelInput& input);
    /// Handles the requests of this frame's buttons and menus.
    void doWhatWasAsked(const std::map<std::string, WidgetRect>& widgets);
    /// Of the hand in use: "mouse".
    [[nodiscard]] std::string handName() const;
    /// Framebuffer pixels of a rectangle in window coordinates.
    [[nodiscard]] static PixelRect pixelsOf(const WidgetRect& rect);
    /// Saves the window's state for the next run.
    void remember();
    /// Resolution of the picture that is kept where the CPU draws, for a part of the framebuffer; else 0.
    [[nodiscard]] glm::ivec2 keptSize(const glm::ivec2& area) const;
    /// The part of the framebuffer without bar and panels, pixels.
    [[nodiscard]] PixelRect pictureArea() const;
    [[nodiscard]] double aspect() const;
    /// The scale that was asked for, as far as it fits the window.
    void followScale();
    /// Adapts the resolution to the frame time and waits for the next frame, handling events meanwhile.
    void pace(double start);
    std::string memoryWarning_;
    WindowMemory memory_;
    const std::vector<std::filesystem::path> samples_ = sampleScenes();
    const std::vector<std::string> sampleNotes_ = notesOf(samples_);
    Window window_;
    Screen screen_;
    EnvironmentLight environment_;
    DrawQuality quality_;     // of frames in which everything is drawn
    DrawQuality keptQuality_; // of frames over a kept picture, for what moves and lets see through it
    std::string notice_;      // of the recorder
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
    FileDialog dialog_;
    Gallery gallery_;
    ViewControl view_;
    PartMenu partMenu_;
    PartNames firstPart_; ///< of the command line, until a model is open
    PanelState state_;
    ModelPicture picture_{stateFolder() / "pictures"};
    PictureController chartPictures_{stateFolder() / "pictures"};
    ChartSaver chartSaver_;
    StatusFile status_;
    std::string problem_;
    size_t opened_ = 0; ///< models and recordings that were asked for
    UnsavedChangesPrompt unsavedChanges_;
    bool left_ = false;          // the user has answered the prompt for unsaved materials
    FramePace pace_{1.0 / 30.0}; // s, between frames
    double savedSeconds_ = 0.0;  // s of this frame that a picture to save took
    double longestFrame_ = 0.0;  // s, since a model was last opened
    float scale_ = 1.0f;         // window coordinates per layout unit
};

} // namespace touchstone
