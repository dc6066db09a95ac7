// The window: open it, load the model on a worker, let the servo touch it, draw what it felt thirty times a
// second.

#include "engine/core/error.h"
#include "haptics/servo/servo_loop.h"
#include "renderer/adaptive_resolution.h"
#include "renderer/scene_renderer.h"
#include "renderer/window_target.h"
#include "workbench/commands.h"
#include "workbench/editor/material_panel.h"
#include "workbench/gpu_options.h"
#include "workbench/guards/interrupt.h"
#include "workbench/hand/device_menu.h"
#include "workbench/hand/device_port.h"
#include "workbench/hand/hand_switch.h"
#include "workbench/hand/sight.h"
#include "workbench/model/animate.h"
#include "workbench/model/default_scene.h"
#include "workbench/model/model_loader.h"
#include "workbench/state_folder.h"
#include "workbench/window/layout.h"
#include "workbench/window/model_picture.h"
#include "workbench/window/recording_desk.h"
#include "workbench/window/saved_file.h"
#include "workbench/window/status_file.h"
#include "workbench/window/style.h"
#include "workbench/window/view_control.h"
#include "workbench/window/window.h"
#include "workbench/window/window_memory.h"

#include <imgui.h>
#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <map>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

constexpr double kFramePeriod = 1.0 / 30.0; // s
constexpr int kSoftwarePixels = 800 * 450;  // of the scene image where the CPU draws it
constexpr int kHardwarePixels = 2560 * 1440;
constexpr double kSmallestScale = 0.55; // of the picture's size; below it an edge is a staircase
constexpr double kChartSeconds = 10.0;
constexpr double kUploadTime = 0.008; // s of a frame, while a model is taken in

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

constexpr const char* kMemoryFile = "window.json"; // in the state folder

/// The size asked for on the command line, else that of the last run.
glm::ivec2 firstSize(const glm::ivec2& asked, const glm::ivec2& remembered) {
    return asked == WindowOptions{}.size && remembered.x > 0 ? remembered : asked;
}

/// Our own scenes, to be opened from the menu.
std::vector<std::filesystem::path> sampleScenes() {
    std::vector<std::filesystem::path> found;
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(defaultScene().parent_path(), error))
        if (entry.path().extension() == ".glb")
            found.push_back(entry.path());
    std::ranges::sort(found);
    return found;
}

/// One of our own scenes, which nobody saves over by accident.
bool isSample(const std::filesystem::path& path) {
    std::error_code error;
    return std::filesystem::weakly_canonical(path, error).parent_path() ==
           std::filesystem::weakly_canonical(defaultScene(), error).parent_path();
}

class Workbench {
  public:
    explicit Workbench(const WindowOptions& options)
        : memory_(readMemory(stateFolder() / kMemoryFile)),
          window_("Touchstone", firstSize(options.size, memory_.size)),
          gpu_(createGpuForWindow(window_.handle(), gpuOptions(options.gpu))),
          target_(*gpu_, window_.handle(), [this] { applyStyle(window_.layoutScale()); }), renderer_(*gpu_),
          resolution_({.largestPixels = gpu_->isSoftware() ? kSoftwarePixels : kHardwarePixels,
                       .smallestScale = kSmallestScale}),
          servo_(portOf(hand_), {.rateHz = options.rateHz, .stageTimes = true}),
          desk_(servo_, options.recording, "window", [this](const std::string& text) { notice_ = text; }),
          liveError_(options.rateHz), forces_(static_cast<size_t>(kChartSeconds * options.rateHz)),
          status_(options.statusJson) {
        // What the command line asks for goes before what the last run left.
        state_.settings = state_.chosen =
            options.settings == HapticSettings{} ? memory_.settings : options.settings;
        state_.folds = memory_.folds;
        state_.introduced = memory_.introduced;
        state_.simulatedHand = options.simulatedHand;
        state_.device = options.device;
        holdDevice();
        servo_.setSettings(state_.settings);
        servo_.start();
    }

    void open(const std::filesystem::path& path) {
        problem_.clear();
        longestFrame_ = 0.0;
        loader_.start(path, handLimits());
    }

    /// Ends what is recorded as it should.
    ~Workbench() {
        servo_.stop();
        servoView_.drain(servo_, forces_, desk_.recorder(), liveError_, secondsNow());
        desk_.finish();
        remember();
    }
    Workbench(const Workbench&) = delete;
    Workbench& operator=(const Workbench&) = delete;

    /// One turn of the main loop.
    void frame() {
        const double start = secondsNow();
        takeModel();
        takeMaterials();
        prepareSettings();
        if (const auto dropped = window_.takeDropped())
            leaveFor(*dropped);
        leave();
        servo_.updateSnapshot();
        servoView_.drain(servo_, forces_, desk_.recorder(), liveError_, start);
        desk_.update();
        if (target_.beginFrame())
            draw();
        if (const auto goal = view_.handGoal())
            hand_.mouse().moveTo(*goal); // in every frame: a frozen window is a hand that is gone
        else
            hand_.mouse().release();
        hand_.simulate(state_.simulatedHand);
        hand_.face(view_.workspaceFromView());
        devices_.renew(start);
        holdDevice();
        pace(start);
    }

    /// Asks before unsaved materials are lost, unless it is the system that wants an end.
    [[nodiscard]] bool closed() {
        if (interrupted() || !window_.shouldClose() || left_ || !materials_.edits().edited())
            return interrupted() || window_.shouldClose();
        window_.stayOpen();
        state_.leaving.emplace();
        return false;
    }
    [[nodiscard]] bool loading() const { return loader_.loading() || uploading_.has_value(); }
    [[nodiscard]] bool hasModel() const { return shown_.model.scene != nullptr; }

  private:
    /// Shows the model that the worker has made, or says why there is none. Without any model, throws.
    void takeModel() {
        try {
            if (std::optional<LoadedModel> loaded = loader_.take()) {
                renderer_.beginScene(std::move(loaded->prepared));
                uploading_ = std::move(loaded);
            }
            if (uploading_ && renderer_.continueScene(kUploadTime))
                show(*std::exchange(uploading_, std::nullopt));
        } catch (const Error& error) {
            if (!hasModel())
                throw;
            uploading_.reset();
            problem_ = error.what();
        } catch (const std::bad_alloc&) {
            if (!hasModel())
                throw;
            uploading_.reset();
            problem_ = loader_.path().filename().string() + ": there is not enough memory for it";
        }
    }

    void show(LoadedModel loaded) {
        loaded.model.haptic =
            limited(*loaded.model.haptic); // another hand may be held than when it was begun
        shown_ = std::move(loaded);
        drawn_ = shown_.model.scene;
        shown_.identity.generated = shown_.model.scene->path == defaultScene().string();
        redrawn_.reset();
        materials_.open(shown_.model, isSample(shown_.model.scene->path));
        offerScene();
        hand_.offerPath(shown_.path);
        view_.lookAt(workspaceBounds(shown_.model), aspect());
        forces_.clear();
        memory_.opened(std::filesystem::absolute(shown_.model.scene->path));
        remember();
        window_.setTitle(shown_.model.scene->path + " – Touchstone");
    }

    /// Touches what the material editor has made, and goes on touching where it may.
    void takeMaterials() {
        if (!hasModel())
            return;
        if (const std::optional<FileStamp> saved = materials_.takeSaved()) {
            const std::filesystem::path& path = materials_.path();
            shown_.identity.path = path.string();
            shown_.identity.absolutePath = std::filesystem::absolute(path).string();
            shown_.identity.generated = false;
            shown_.identity.fileSize = saved->size;
            shown_.identity.fileHash = saved->hash;
            shown_.identity.edits = textOf(materials_.edits().patches());
            desk_.recorder().sceneOffered(offered_, shown_.identity);
        }
        const std::optional<MadeMaterials> made = materials_.update(shown_.model);
        if (!made)
            return;
        if (made->scene != nullptr)
            shown_.model.scene = made->scene;
        if (made->read)
            drawn_.reset(); // it has other images
        made->haptic->limits = handLimits();
        shown_.model.haptic = made->haptic;
        shown_.identity.feltHash = made->feltHash;
        shown_.identity.edits = made->edits;
        offerScene(made->touchGoesOn ? SceneSwap::SameGeometry : SceneSwap::Anew);
    }

    void leaveFor(const std::filesystem::path& path) {
        if (hasModel() && materials_.edits().edited())
            state_.leaving = path;
        else
            open(path);
    }

    /// What the user said about unsaved materials; a save that fails keeps them.
    void leave() {
        using enum PanelState::Leave;
        const PanelState::Leave answer = std::exchange(state_.leave, Undecided);
        if (!state_.leaving || (answer == Undecided && !savesToLeave_))
            return;
        if (answer == Save) {
            materials_.save();
            savesToLeave_ = true;
        }
        if (savesToLeave_ && materials_.saving())
            return;
        const bool stays = answer == Stay || (savesToLeave_ && materials_.failed());
        if (savesToLeave_ && materials_.failed())
            problem_ = materials_.notice();
        savesToLeave_ = false;
        const std::filesystem::path path = *std::exchange(state_.leaving, std::nullopt);
        if (stays)
            return;
        if (!path.empty())
            return open(path);
        left_ = true;
        window_.close();
    }

    /// The eye needs the edited materials only where it shows what is felt. A worker prepares them, and they
    /// are taken in by slices as a new model is.
    void showMaterials() {
        if (uploading_) {
            redrawn_.reset();
            return;
        }
        const bool stale =
            drawn_ != shown_.model.scene && (drawn_ == nullptr || state_.view.mode != ViewMode::Shaded);
        if (stale && !preparing_.valid() && redrawn_ == nullptr)
            preparing_ =
                std::async(std::launch::async, [scene = shown_.model.scene] { return prepareScene(scene); });
        try {
            if (preparing_.valid() &&
                preparing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
                const std::shared_ptr<const PreparedScene> prepared = preparing_.get();
                if (prepared->scene == shown_.model.scene) { // else another change came meanwhile
                    redrawn_ = prepared->scene;
                    renderer_.beginScene(prepared);
                }
            }
            if (redrawn_ != nullptr && renderer_.continueScene(kUploadTime))
                drawn_ = std::exchange(redrawn_, nullptr);
        } catch (const std::exception& error) {
            redrawn_.reset();
            drawn_ = shown_.model.scene; // not again until something else is changed
            problem_ = std::string("the view could not be made anew: ") + error.what();
        }
    }

    /// What contact=neighbourhood walks on and the slopes of textureGradient=precomputed are built on a
    /// worker when they are first asked for. Until they are there the servo sweeps, or works the slopes out.
    void prepareSettings() {
        if (!hasModel())
            return;
        const std::shared_ptr<const HapticScene>& haptic = shown_.model.haptic;
        const bool busy =
            building_.valid() && building_.wait_for(std::chrono::seconds(0)) != std::future_status::ready;
        if (building_.valid() && !busy) {
            try {
                building_.get();
            } catch (const std::exception& error) {
                problem_ = std::string("the settings could not be prepared: ") + error.what();
                state_.settings.contact = ContactMethod::Sweep;
                state_.settings.textureGradient = TextureGradient::Central;
                servo_.setSettings(state_.settings);
                return;
            }
        }
        const bool walk = state_.settings.contact == ContactMethod::Neighbourhood &&
                          haptic->neighbourhoods() == nullptr,
                   slopes = state_.settings.textureGradient == TextureGradient::Precomputed &&
                            haptic->slopes() == nullptr;
        if (!busy && (walk || slopes))
            building_ = std::async(std::launch::async, [haptic, walk, slopes] {
                if (walk)
                    haptic->buildNeighbourhoods();
                if (slopes)
                    haptic->buildSlopes();
            });
    }

    /// Holds what was chosen. A device is driven only by a scene with its own limits: it waits until the
    /// servo has adopted that; meanwhile nothing is held.
    void holdDevice() {
        hand_.collect();
        if (state_.device != devices_.chosen())
            chooseDevice();
        if (coming_ != nullptr && (!hasModel() || servo_.snapshot().scene == offered_))
            hand_.hold(std::exchange(coming_, nullptr));
    }

    void chooseDevice() {
        hand_.hold(nullptr);
        coming_.reset();
        coming_ = devices_.choose(state_.device);
        state_.device = devices_.chosen();
        if (!hasModel())
            return;
        try {
            shown_.model.haptic = limited(*shown_.model.haptic);
            offerScene();
        } catch (const std::bad_alloc&) {
            coming_.reset();
            devices_.choose("");
            state_.device.clear();
            problem_ = "there is not enough memory for the device's limits: nothing is held";
        }
    }

    /// Of what is held or will be next.
    [[nodiscard]] DeviceLimits handLimits() const {
        return coming_ != nullptr ? coming_->limits() : hand_.limits();
    }

    /// The same scene within the hand's limits.
    [[nodiscard]] std::shared_ptr<HapticScene> limited(const HapticScene& scene) const {
        std::shared_ptr<HapticScene> copy = copyOf(scene);
        copy->limits = handLimits();
        copy->warnings = scene.warnings;
        return copy;
    }

    /// To the servo, and to what records it.
    void offerScene(SceneSwap swap = SceneSwap::Anew) {
        shown_.identity.limits = shown_.model.haptic->limits;
        sight_.show(shown_.model.haptic, shown_.model.scene);
        offered_ = servo_.offerScene(shown_.model.haptic, shown_.model.scene, swap);
        desk_.recorder().sceneOffered(offered_, shown_.identity);
        liveError_.sceneOffered(offered_, shown_.model.haptic, shown_.model.scene);
    }

    void draw() {
        const PixelRect area = pictureArea();
        const PanelInput input = panelInput(resolution_.sceneSize({area.width, area.height}));
        const HapticSettings before = state_.settings;
        const PanelFolds folds = state_.folds;
        auto widgets = drawPanels(input, state_);
        widgets.merge(drawMaterials(input.scale));
        const auto points = static_cast<double>(ImGui::GetIO().DisplayFramebufferScale.x);
        view_.update({.origin = glm::dvec2(area.x, area.y) / points,
                      .area = glm::dvec2(area.width, area.height) / points,
                      .probe = servo_.snapshot().output.proxy,
                      .seconds = static_cast<double>(ImGui::GetIO().DeltaTime),
                      .mouseIsHand = state_.device.empty() && !state_.simulatedHand,
                      .look =
                          [this](const Ray& ray) {
                              return sight_.look(ray, servo_.snapshot().time, state_.settings);
                          }},
                     state_.view);
        doWhatWasAsked(widgets);
        if (!(state_.settings == before))
            servo_.setSettings(state_.settings);
        if (!(state_.folds == folds))
            remember();

        if (hasModel()) {
            showMaterials();
            poseAt(servo_.snapshot().time, *shown_.model.scene, renderer_);
        }
        const ModelPicture::Frame frame{.model = shown_.model,
                                        .tick = servo_.snapshot(),
                                        .settings = state_.settings,
                                        .camera = view_.camera(),
                                        .options = state_.view,
                                        .place = area,
                                        .sceneSize = input.sceneSize,
                                        .pixelsPerPoint = static_cast<float>(points),
                                        .scale = window_.layoutScale(),
                                        .software = gpu_->isSoftware()};
        target_.endFrame(&renderer_, picture_.draw(frame));
        if (picture_.save(target_, frame))
            notice_ = picture_.message();
        if (chartPictures_.update(target_))
            notice_ = chartPictures_.message();
        status_.update(secondsNow(), input, state_, widgets, gpu_->validationMessages().size());
    }

    /// The material editor, over the picture's upper left corner at first.
    std::map<std::string, WidgetRect> drawMaterials(float scale) {
        Widgets widgets(scale);
        materialKeys(materials_, materialState_);
        if (!state_.editMaterials)
            return {};
        const ImVec2 display = ImGui::GetIO().DisplaySize;
        const PictureRect picture = pictureRect(state_.folds, {display.x, display.y}, scale);
        constexpr float kWidth = 320.0f, kHeight = 610.0f; // units
        ImGui::SetNextWindowPos(ImVec2(picture.x + widgets.units(8.0f), picture.y + widgets.units(8.0f)),
                                ImGuiCond_FirstUseEver);
        ImGui::SetNextWindowSize(ImVec2(widgets.units(kWidth), widgets.units(kHeight)),
                                 ImGuiCond_FirstUseEver);
        MaterialPanelInput input;
        if (hasModel()) {
            input.scene = shown_.model.scene.get();
            input.deviceStiffness = shown_.model.haptic->limits.recommendedStiffness;
            const int object = servo_.snapshot().output.object;
            const auto& objects = shown_.model.haptic->objects;
            if (object >= 0 && static_cast<size_t>(object) < objects.size())
                input.probed = objects[static_cast<size_t>(object)]->material;
        }
        if (ImGui::Begin("Material", &state_.editMaterials, ImGuiWindowFlags_NoSavedSettings))
            drawMaterialPanel(input, materials_, materialState_, widgets);
        ImGui::End();
        return widgets.take();
    }

    [[nodiscard]] PanelInput panelInput(const glm::ivec2& sceneSize) const {
        PanelInput input;
        if (hasModel()) {
            const Scene& scene = *shown_.model.scene;
            input.scene = &scene;
            input.haptic = shown_.model.haptic.get();
            input.modelName = std::filesystem::path(scene.path).filename().string();
            input.modelFacts = std::to_string(scene.triangleCount()) + " triangles" +
                               (scene.touchable() ? "" : ": nothing to touch");
            for (const auto* warnings : {&scene.warnings, &shown_.model.haptic->warnings})
                for (const Warning& warning : *warnings)
                    input.warnings.push_back(warning.place + ": " + warning.message);
            for (std::string& warning : settingWarnings(state_.settings))
                input.warnings.push_back(std::move(warning));
            if (has(servoView_.last.output.flags, TickFlag::NeighbourhoodMissing))
                input.warnings.emplace_back("the neighbourhood watch is being prepared: swept until then");
        }
        input.problem = problem_;
        input.recent = memory_.recent;
        input.samples = samples_;
        input.materialNotice = materials_.notice();
        input.canSaveMaterials = materials_.canSaveInPlace();
        input.materialsEdited = materials_.edits().edited();
        input.materialsWorking = materials_.working();
        input.loading = loading();
        input.longestFrame = longestFrame_;
        input.loadName = loader_.path().filename().string();
        input.loadFraction = loader_.fraction();
        input.loadActivity = loader_.activity();
        input.notice = notice_;
        input.recording = desk_.recorder().recording();
        input.recordingFile = desk_.recorder().file().string();
        input.recordedSeconds = static_cast<double>(desk_.recorder().ticks()) / servo_.rateHz();
        input.canSimulate = shown_.path != nullptr;
        input.devices = devices_.offers();
        input.deviceStatus = devices_.status();
        input.servo = &servoView_;
        input.forces = &forces_;
        input.framesPerSecond = framesPerSecond_;
        input.camera = view_.camera();
        input.picture = picture_.message();
        input.sceneSize = sceneSize;
        input.gpuName = gpu_->name();
        input.scale = window_.layoutScale();
        return input;
    }

    /// What the buttons and menus of this frame asked for.
    void doWhatWasAsked(const std::map<std::string, WidgetRect>& widgets) {
        if (std::exchange(state_.recordPressed, false))
            desk_.toggle();
        if (std::exchange(state_.cancelPressed, false)) {
            loader_.abandon();
            uploading_.reset();
            renderer_.abandonScene();
        }
        if (std::exchange(state_.dismissPressed, false))
            problem_.clear();
        if (std::exchange(state_.quitPressed, false))
            window_.close();
        if (const auto asked = std::exchange(state_.open, std::nullopt))
            leaveFor(*asked);
        if (const auto wanted = std::exchange(state_.chartWanted, std::nullopt)) {
            if (*wanted == ChartFile::Picture)
                chartPictures_.request(target_, pixelsOf(widgets.at("charts")), "charts");
            else
                saveChart();
        }
    }

    void saveChart() {
        try {
            const std::filesystem::path file = savedFile("charts", ".csv");
            writeChart(file, state_.stopped ? *state_.stopped : forces_);
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
        memory_.folds = state_.folds;
        memory_.introduced = state_.introduced;
        memory_.size = glm::ivec2(glm::vec2(window_.size()) / window_.layoutScale()); // as it was asked for
        writeMemory(stateFolder() / kMemoryFile, memory_);
    }

    /// The part of the framebuffer that bar and panels leave, pixels.
    [[nodiscard]] PixelRect pictureArea() const {
        const float pixels = ImGui::GetIO().DisplayFramebufferScale.x;
        const glm::vec2 size(target_.size());
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
        resolution_.frameDone(secondsNow() - start);
        longestFrame_ = std::max(longestFrame_, secondsNow() - start);
        window_.waitEvents(0.0);
        for (double left = start + kFramePeriod - secondsNow(); left > 0.0;
             left = start + kFramePeriod - secondsNow())
            window_.waitEvents(left);
        constexpr double kShare = 0.1; // of the newest frame in the running mean
        const double rate = 1.0 / (secondsNow() - start);
        framesPerSecond_ = framesPerSecond_ <= 0.0 ? rate : (1.0 - kShare) * framesPerSecond_ + kShare * rate;
    }

    WindowMemory memory_;
    const std::vector<std::filesystem::path> samples_ = sampleScenes();
    Window window_;
    std::unique_ptr<Gpu> gpu_;
    WindowTarget target_;
    SceneRenderer renderer_;
    AdaptiveResolution resolution_;
    DeviceMenu devices_;
    HandSwitch hand_;
    std::shared_ptr<LinkedDevice> coming_; // held once the servo has adopted a scene with its limits
    uint32_t offered_ = 0;                 // number of the newest scene
    ServoLoop servo_;
    std::string notice_; // of the recorder
    RecordingDesk desk_;
    study::LiveError liveError_;
    ModelLoader loader_;
    std::optional<LoadedModel> uploading_; ///< not yet shown: the renderer takes it in slices
    LoadedModel shown_;
    ScenePtr drawn_; // what the renderer has
    MaterialDesk materials_;
    MaterialPanelState materialState_;
    ViewControl view_;
    Sight sight_;
    PanelState state_;
    ServoView servoView_;
    ForceHistory forces_;
    ModelPicture picture_{renderer_, stateFolder() / "pictures"};
    PictureDesk chartPictures_{stateFolder() / "pictures"};
    StatusFile status_;
    std::string problem_;
    bool savesToLeave_ = false; // the user waits for a save, to go on after it
    bool left_ = false;         // the user has said what becomes of unsaved materials
    std::future<void> building_;
    std::future<std::shared_ptr<const PreparedScene>> preparing_; // of edited materials
    ScenePtr redrawn_;                                            // that the renderer is taking in for them
    double framesPerSecond_ = 0.0;
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
