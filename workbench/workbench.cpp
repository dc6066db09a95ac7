// The window: open it, load the model on a worker, let the servo touch it, draw what it felt thirty times a
// second.

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

namespace {

constexpr double kFramePeriod = 1.0 / 30.0; // s
constexpr int kSoftwarePixels = 800 * 450;  // of the scene image where the CPU draws it
constexpr int kHardwarePixels = 2560 * 1440;
constexpr double kSmallestScale = 0.55; // of the picture's size; below it an edge is a staircase
constexpr double kSoftwareError = 0.25; // pixels, by which simplified meshes differ where the CPU draws them

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr const char* kMemoryFile = "window.json"; // in the state folder

/// The size asked for on the command line, else that of the last run.
glm::ivec2 firstSize(const glm::ivec2& asked, const glm::ivec2& remembered) {
    return asked == WindowOptions{}.size && remembered.x > 0 ? remembered : asked;
}

DrawQuality qualityOn(const Gpu& gpu) {
    return DrawQuality({.largestPixels = gpu.isSoftware() ? kSoftwarePixels : kHardwarePixels,
                        .smallestScale = kSmallestScale,
                        .finestError = gpu.isSoftware() ? kSoftwareError : 0.0});
}

std::vector<std::filesystem::path> recordingFolders(const RecordingOptions& options) {
    return {stateFolder() / "recordings",
            options.flightFolder.empty() ? stateFolder() / "flight" : options.flightFolder};
}

class Workbench {
  public:
    explicit Workbench(const WindowOptions& options)
        : memory_(readMemory(stateFolder() / kMemoryFile)),
          window_("Touchstone", firstSize(options.size, memory_.size)),
          screen_(window_, gpuOptions(options.gpu)), quality_(qualityOn(screen_.gpu())),
          touch_(options, [this](const std::string& text) { notice_ = text; }),
          interruptedForce_(touch_.forceSwitch()), forceKey_(touch_.forceSwitch()),
          forceWatch_(window_.handle(), GLFW_KEY_SPACE, [this](bool plain) { forceKey_.press(plain); }),
          keys_(window_.handle(), [this](int key, int modifiers) { keyDown(key, modifiers); }),
          timeline_(touch_.again(), recordingFolders(options.recording)), status_(options.statusJson) {
        // What the command line asks for goes before what the last run left.
        state_.settings = memory_.settings;
        for (const auto& [name, value] : options.settings)
            (void)setSetting(state_.settings, name, value);
        state_.chosen = state_.settings;
        state_.sound = memory_.sound;
        state_.sound.on = state_.sound.on || options.sound;
        state_.folds = memory_.folds;
        state_.introduced = memory_.introduced;
        state_.simulatedHand = options.simulatedHand;
        state_.stroke = options.stroke;
        state_.workspace.zoom = options.zoom;
        state_.device = options.device;
        holdDevice();
        sendSettings();
        touch_.start();
        environment_.start(options.environment);
    }

    void open(const std::filesystem::path& path) {
        problem_.clear();
        state_.gallery = false;
        if (isRecording(path))
            return timeline_.open(path);
        longestFrame_ = 0.0;
        opening_.start(path, touch_.limits(), screen_.renderer());
    }

    ~Workbench() {
        touch_.forceSwitch().takeAway(
            false); // what follows may wait for a worker: nobody is pushed meanwhile
        try {
            remember();
        } catch (...) { // what the window remembers is worth no last order that is not sent
        }
    }
    Workbench(const Workbench&) = delete;
    Workbench& operator=(const Workbench&) = delete;

    /// One turn of the main loop.
    void frame() {
        const double start = secondsNow();
        pace_.begin(start);
        onScreen([this] {
            takeModel();
            if (const auto wrong = environment_.update(screen_.renderer()))
                problem_ = *wrong;
        });
        takeMaterials();
        prepareSettings();
        if (const auto dropped = window_.takeDropped())
            leaveFor(*dropped);
        leave();
        touch_.update(start);
        // While a recording is looked at the force is off: then the key only takes it away for afterwards.
        state_.settings.forceEnabled =
            forceKey_.settle(state_.settings.forceEnabled,
                             !ImGui::GetIO().WantTextInput && !timeline_.looking(), forceWatch_.presses());
        lookBack(start);
        onScreen([this] {
            keys_.feed();
            if (screen_.target().beginFrame())
                draw();
            else
                view_.letGo(); // nobody sees what is pressed
        });
        moveHand();
        touch_.devices().renew(start);
        holdDevice();
        pace(start);
    }

    /// Asks before unsaved materials are lost, unless it is the system that wants an end.
    [[nodiscard]] bool closed() {
        if (interrupted() || !window_.shouldClose() || left_)
            return interrupted() || window_.shouldClose();
        if (unsavedChanges_.mayLeave({}, materials_, state_))
            return true;
        window_.stayOpen();
        return false;
    }
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

    void takeAnotherDevice(const DeviceLost& lost) {
        problem_ = "The graphics device was lost (" + lost.problem() +
                   "). What is felt went on; the picture is made anew.";
        drawn_.takeDevice();
        picture_.takeDevice();
        environment_.takeDevice();
        for (std::optional<DeviceLost> why = lost; why;)
            try {
                screen_.renew(*std::exchange(why, std::nullopt), secondsNow());
                quality_ = qualityOn(screen_.gpu());
                opening_.takeDevice(screen_.renderer());
            } catch (const DeviceLost& again) {
                why = again;
            }
    }

    /// Shows the model that the worker has made, or says why there is none. Without any model, throws.
    void takeModel() {
        // What was changed while it was read is asked for, too.
        if (opening_.arriving() && hasModel() &&
            (materials_.saving() || !unsavedChanges_.mayLeave(opening_.path(), materials_, state_)))
            return;
        try {
            if (std::optional<LoadedModel> loaded = opening_.update(screen_.renderer()))
                show(*std::move(loaded));
        } catch (const DeviceLost&) {
            throw;
        } catch (const Error& error) {
            if (!hasModel())
                throw;
            problem_ = error.what();
        } catch (const std::bad_alloc&) {
            if (!hasModel())
                throw;
            problem_ = opening_.path().filename().string() + ": there is not enough memory for it";
        }
    }

    void show(LoadedModel loaded) {
        const ScenePtr scene = loaded.model.scene;
        notice_.clear(); // of the model before
        touch_.show(std::move(loaded), scene->path == defaultScene().string());
        drawn_.shown(scene);
        unsavedChanges_.begin();
        materials_.open(touch_.shown().model, isSample(scene->path));
        view_.lookAt(workspaceBounds(touch_.shown().model), aspect());
        memory_.opened(std::filesystem::absolute(scene->path));
        remember();
        window_.setTitle(scene->path + " – Touchstone");
    }

    /// Touches what the material editor has made, and goes on touching where it may.
    void takeMaterials() {
        if (!hasModel())
            return;
        if (const std::optional<FileStamp> saved = materials_.takeSaved())
            touch_.saved(materials_.path(), *saved, textOf(materials_.edits().patches()));
        const std::optional<MadeMaterials> made = materials_.update(touch_.shown().model);
        if (!made)
            return;
        if (made->read)
            drawn_.renew(); // it has other images
        touch_.change(*made);
    }

    void leaveFor(const std::filesystem::path& path) {
        if (isRecording(path) || unsavedChanges_.mayLeave(path, materials_, state_))
            open(path);
    }

    /// Goes where the user wanted to go, once unsaved materials are seen to.
    void leave() {
        const std::optional<UnsavedChangesPrompt::Answer> answer =
            unsavedChanges_.update(materials_, state_, problem_);
        if (!answer)
            return;
        const bool arriving = opening_.arriving() && answer->target == opening_.path();
        if (arriving && !answer->go)
            opening_.cancel(screen_.renderer());
        if (arriving || !answer->go)
            return;
        if (!answer->target.empty())
            return open(answer->target);
        left_ = true;
        window_.close();
    }

    [[nodiscard]] const HapticSettings& shownSettings() const {
        return timeline_.looking() && !timeline_.again().running() ? timeline_.settings() : state_.settings;
    }

    /// Sees to the recording that is looked at, and opens the model that it touched. Without any model,
    /// throws where it cannot be opened.
    void lookBack(double now) {
        timeline_.update({.now = now,
                          .model = hasModel() ? &touch_.shown().model : nullptr,
                          .open = hasModel() ? &touch_.shown().identity : nullptr,
                          .live = &touch_.forces(),
                          .servoTime = touch_.tick().time,
                          .listed = state_.timeline.shown});
        // Off and on again clears a latch, which nobody must do unawares: the force then stays off.
        if (timeline_.looking() && has(touch_.tick().output.flags, TickFlag::SafetyLatched))
            state_.settings.forceEnabled = false;
        if (const std::optional<Error> problem = timeline_.takeProblem()) {
            if (!hasModel() && !opening_.busy())
                throw *problem;
            problem_ = problem->what();
        }
        if (const auto model = timeline_.takeModelWanted())
            leaveFor(*model);
    }

    /// What the picture and the panels show: the recording's tick while one is looked at.
    [[nodiscard]] const TickRecord& shownTick() const {
        return timeline_.looking() && !timeline_.again().running() ? timeline_.tick() : touch_.tick();
    }

    /// The settings as they are chosen; but the force is off while a recording is looked at.
    void sendSettings() {
        forceKey_.set(state_.settings.forceEnabled);
        HapticSettings settings = state_.settings;
        settings.forceEnabled = settings.forceEnabled && !timeline_.looking();
        touch_.send(settings);
    }

    /// When the event is handled, not in the frame that takes it.
    void keyDown(int key, int modifiers) {
        constexpr int kNotPlain = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
        if (key == GLFW_KEY_SPACE)
            forceKey_.pressInWindow((modifiers & kNotPlain) == 0, forceWatch_.presses());
    }

    void showMaterials() {
        if (opening_.uploading())
            return drawn_.interrupt();
        try {
            drawn_.update(screen_.renderer(), touch_.shown().model.scene,
                          state_.view.mode != ViewMode::Shaded);
        } catch (const DeviceLost&) {
            throw;
        } catch (const std::exception& error) {
            problem_ = std::string("the view could not be made anew: ") + error.what();
        }
    }

    void prepareSettings() {
        try {
            touch_.prepare(state_.settings);
        } catch (const std::exception& error) {
            problem_ = std::string("the settings could not be prepared: ") + error.what();
            state_.settings.contact = ContactMethod::Sweep;
            state_.settings.textureGradient = TextureGradient::Central;
            sendSettings();
        }
    }

    /// Tells the hand where it is to be, whichever it is.
    void moveHand() {
        DeviceMultiplexer& hand = touch_.hand();
        if (touch_.takeBuiltAgain())
            view_.lift();
        if (const auto goal = view_.handGoal())
            hand.mouse().moveTo(*goal);
        else
            hand.mouse().release();
        hand.simulate(state_.simulatedHand);
        hand.workspace(state_.workspace);
        if (std::exchange(state_.centrePressed, false))
            hand.centre();
        hand.face(view_.workspaceFromView());
        touch_.sound().update(state_.sound);
        touch_.layStroke(state_.stroke, -view_.camera().forward(), state_.simulatedHand);
    }

    void holdDevice() {
        if (!touch_.hold(state_.device))
            problem_ = "there is not enough memory for the device's limits: nothing is held";
    }

    void draw() {
        gallery_.update(state_.gallery, samples_, memory_.recent, screen_.target());
        const PixelRect area = pictureArea();
        const PanelInput input = panelInput(quality_.sceneSize({area.width, area.height}));
        const PanelFolds folds = state_.folds;
        auto widgets = drawPanels(input, state_);
        widgets.merge(drawMaterials(input.scale));
        const auto points = static_cast<double>(ImGui::GetIO().DisplayFramebufferScale.x);
        view_.update({.origin = glm::dvec2(area.x, area.y) / points,
                      .area = glm::dvec2(area.width, area.height) / points,
                      .probe = shownTick().output.proxy,
                      .seconds = static_cast<double>(ImGui::GetIO().DeltaTime),
                      .mouseIsHand = state_.device.empty() && !state_.simulatedHand && !timeline_.looking(),
                      .looksBack = timeline_.looking(),
                      .covered = state_.gallery || state_.leaving.has_value(),
                      .look = [this](const Ray& ray) { return touch_.look(ray, state_.settings); }},
                     state_.view);
        doWhatWasAsked(widgets);
        sendSettings();
        if (!(state_.folds == folds))
            remember();

        if (hasModel()) {
            showMaterials();
            poseAt(shownTick().time, *touch_.shown().model.scene, screen_.renderer());
        }
        const ModelPicture::Frame frame{.model = touch_.shown().model,
                                        .tick = shownTick(),
                                        .tickBelongs = !timeline_.looking() || timeline_.modelIsOpen(),
                                        .settings = shownSettings(),
                                        .camera = view_.camera(),
                                        .options = state_.view,
                                        .place = area,
                                        .sceneSize = input.sceneSize,
                                        .allowedError = quality_.allowedError(),
                                        .pixelsPerPoint = static_cast<float>(points),
                                        .scale = window_.layoutScale(),
                                        .software = screen_.gpu().isSoftware()};
        screen_.target().endFrame(&screen_.renderer(), picture_.draw(frame, screen_.renderer()));
        if (picture_.save(screen_.target(), frame))
            notice_ = picture_.message();
        if (chartPictures_.update(screen_.target()))
            notice_ = chartPictures_.message();
        status_.update(secondsNow(), input, state_, widgets, screen_.validationMessages());
    }

    std::map<std::string, WidgetRect> drawMaterials(float scale) {
        const ImVec2 display = ImGui::GetIO().DisplaySize;
        MaterialPanelInput input;
        if (hasModel()) {
            const Model& model = touch_.shown().model;
            input.scene = model.scene.get();
            input.deviceStiffness = model.haptic->limits.recommendedStiffness;
            const int object = touch_.tick().output.object;
            const auto& objects = model.haptic->objects;
            if (object >= 0 && static_cast<size_t>(object) < objects.size())
                input.probed = objects[static_cast<size_t>(object)]->material;
        }
        Widgets widgets(scale);
        const PictureRect picture = pictureRect(state_.folds, {display.x, display.y}, scale);
        drawMaterialWindow(input, {picture.x, picture.y, picture.width, picture.height}, state_.editMaterials,
                           materials_, materialState_, widgets);
        return widgets.take();
    }

    [[nodiscard]] PanelInput panelInput(const glm::ivec2& sceneSize) {
        PanelInput input;
        if (hasModel()) {
            const Scene& scene = *touch_.shown().model.scene;
            input.scene = &scene;
            input.haptic = touch_.shown().model.haptic.get();
            input.modelName = std::filesystem::path(scene.path).filename().string();
            input.modelFacts = std::to_string(scene.triangleCount()) + " triangles" +
                               (scene.touchable() ? "" : ": nothing to touch");
            for (const auto* warnings : {&scene.warnings, &input.haptic->warnings})
                for (const Warning& warning : *warnings)
                    input.warnings.push_back(warning.place + ": " + warning.message);
            for (std::string& warning : settingWarnings(state_.settings))
                input.warnings.push_back(std::move(warning));
            if (has(touch_.figures().last.output.flags, TickFlag::NeighbourhoodMissing))
                input.warnings.emplace_back("the contact method is being prepared: swept until then");
        }
        input.problem = problem_;
        input.gallery = gallery_.entries();
        input.showPicture = [this](size_t place, const glm::vec2& from, const glm::vec2& to) {
            screen_.target().showPicture(place, from, to);
        };
        input.recent = memory_.recent;
        input.samples = samples_;
        input.sampleNotes = sampleNotes_;
        input.materialNotice = materials_.notice();
        input.canSaveMaterials = materials_.canSaveInPlace();
        input.materialsEdited = materials_.edits().edited();
        input.materialsWorking = materials_.working();
        input.loading = loading();
        input.longestFrame = longestFrame_;
        const bool recording = timeline_.opening();
        input.loadName = (recording ? timeline_.openingFile() : opening_.path()).filename().string();
        input.loadFraction = recording ? timeline_.openingFraction() : opening_.fraction();
        input.loadActivity = recording ? "reading the recording" : opening_.activity();
        input.notice = notice_;
        const ServoRecorder& recorder = touch_.recording().recorder();
        input.recording = recorder.recording();
        input.recordingFile = recorder.file().string();
        input.recordedSeconds = static_cast<double>(recorder.ticks()) / touch_.rateHz();
        input.canSimulate = touch_.shown().path != nullptr;
        input.strokeNotice = touch_.strokeNotice();
        input.devices = touch_.devices().offers();
        input.deviceStatus = touch_.devices().status();
        input.sound = touch_.sound().status();
        input.servo = &touch_.figures();
        input.servoStart = touch_.startedAt();
        input.forcePresses = touch_.forceSwitch().state().presses();
        input.typing = ImGui::GetIO().WantTextInput;
        input.timeline = &timeline_;
        input.tick = timeline_.looking() ? &shownTick() : &touch_.figures().last;
        input.forces = &touch_.forces();
        input.frames = screen_.target().statistics().framesPresented;
        input.framesPerSecond = pace_.rate();
        input.camera = view_.camera();
        input.picture = picture_.message();
        input.sceneSize = sceneSize;
        input.gpuName = screen_.gpu().name();
        input.scale = window_.layoutScale();
        return input;
    }

    /// What the buttons and menus of this frame asked for.
    void doWhatWasAsked(const std::map<std::string, WidgetRect>& widgets) {
        if (std::exchange(state_.recordPressed, false))
            touch_.recording().toggle();
        if (std::exchange(state_.cancelPressed, false))
            opening_.cancel(screen_.renderer()), timeline_.cancelOpening();
        if (std::exchange(state_.dismissPressed, false))
            problem_.clear();
        if (std::exchange(state_.noticeDismissed, false))
            notice_.clear();
        if (std::exchange(state_.quitPressed, false))
            window_.close();
        if (const auto gone = std::exchange(state_.forget, std::nullopt)) {
            memory_.forget(*gone);
            remember();
        }
        for (auto* asked : {&state_.open, &state_.timeline.open})
            if (const auto path = std::exchange(*asked, std::nullopt))
                leaveFor(*path);
        if (const auto wanted = std::exchange(state_.chartWanted, std::nullopt)) {
            if (*wanted == ChartFile::Picture)
                chartPictures_.request(screen_.target(), pixelsOf(widgets.at("charts")), "charts");
            else
                saveChart();
        }
    }

    void saveChart() {
        try {
            const std::filesystem::path file = savedFile("charts", ".csv");
            writeChart(file, state_.stopped ? *state_.stopped : touch_.forces());
            notice_ = "saved " + file.string();
        } catch (const std::exception& error) {
            problem_ = error.what();
        }
    }

    /// Framebuffer pixels of a place in window coordinates.
    [[nodiscard]] static PixelRect pixelsOf(const WidgetRect& rect) {
        const float pixels = ImGui::GetIO().DisplayFramebufferScale.x;
        return {static_cast<int>(rect.x * pixels), static_cast<int>(rect.y * pixels),
                static_cast<int>(rect.width * pixels), static_cast<int>(rect.height * pixels)};
    }

    /// For the next run.
    void remember() {
        memory_.settings = state_.settings;
        memory_.settings.forceEnabled = true;
        memory_.sound = state_.sound;
        memory_.folds = state_.folds;
        memory_.introduced = state_.introduced;
        memory_.size = glm::ivec2(glm::vec2(window_.size()) / window_.layoutScale()); // as it was asked for
        writeMemory(stateFolder() / kMemoryFile, memory_);
    }

    /// The part of the framebuffer that bar and panels leave, pixels.
    [[nodiscard]] PixelRect pictureArea() const {
        const float pixels = ImGui::GetIO().DisplayFramebufferScale.x;
        const glm::vec2 size(screen_.target().size());
        const PictureRect rect = pictureRect(state_.folds, size, window_.layoutScale() * pixels);
        return {static_cast<int>(rect.x), static_cast<int>(rect.y),
                std::max(16, static_cast<int>(rect.width)), std::max(16, static_cast<int>(rect.height))};
    }
    [[nodiscard]] double aspect() const {
        const PixelRect area = pictureArea();
        return static_cast<double>(area.width) / area.height;
    }

    /// Adapts the picture to the time it took and waits for the next frame's turn, handling events meanwhile.
    void pace(double start) {
        const double busy = secondsNow() - start;
        quality_.frameDone(std::max(busy, screen_.busy()));
        longestFrame_ = std::max(longestFrame_, busy);
        window_.waitEvents(0.0);
        for (double left = pace_.due() - secondsNow(); left > 0.0; left = pace_.due() - secondsNow())
            window_.waitEvents(left);
    }

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
    bool left_ = false; // the user has said what becomes of unsaved materials
    FramePace pace_{kFramePeriod};
    double longestFrame_ = 0.0; // s, since a model was last opened
};

} // namespace

int windowCommand(const WindowOptions& options) {
    catchInterrupts();
    Workbench workbench(options);
    workbench.open(options.scene.empty() ? defaultScene() : options.scene);
    while (!workbench.closed())
        workbench.frame();
    return 0;
}

} // namespace touchstone
