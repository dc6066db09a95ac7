#include "devices/choice/device_choice.h"
#include "engine/core/input_file.h"
#include "workbench/figures/ui_scale.h"
#include "workbench/workbench_window.h"

#include <cstdio>
#include <optional>

namespace touchstone {

namespace {

constexpr int kSoftwarePixels = 800 * 450; // of the scene image on a software device
constexpr int kMostPixels = 2560 * 1440;   // of one that is kept, or drawn by hardware
constexpr int kSettling =
    2; // frames after another way of drawing whose times are those of the last: two in flight
constexpr double kSmallestScale = 0.55; // of the picture's size; below it edges show staircases
constexpr double kSoftwareError = 0.5;  // pixels, least tolerance of meshes that a software device simplifies

constexpr const char* kMemoryFile = "window.json"; // in the state folder

/// The size given on the command line, else that of the last run.
glm::ivec2 firstSize(const std::optional<glm::ivec2>& asked, const glm::ivec2& remembered) {
    return asked ? *asked : remembered.x > 0 ? remembered : glm::ivec2(1280, 800);
}

std::vector<std::filesystem::path> recordingFolders(const RecordingOptions& options) {
    return {stateFolder() / "recordings",
            options.flightFolder.empty() ? stateFolder() / "flight" : options.flightFolder};
}

} // namespace

DrawQuality qualityOn(const Gpu& gpu) {
    return DrawQuality({.largestPixels = gpu.isSoftware() ? kSoftwarePixels : kMostPixels,
                        .smallestScale = kSmallestScale,
                        .finestError = gpu.isSoftware() ? kSoftwareError : 0.0});
}

DrawQuality keptQuality() {
    return DrawQuality(
        {.largestPixels = kMostPixels, .smallestScale = kSmallestScale, .finestError = kSoftwareError});
}

WorkbenchWindow::WorkbenchWindow(const WindowOptions& options)
    : memory_(readMemory(stateFolder() / kMemoryFile, &memoryWarning_)),
      window_("Touchstone", firstSize(options.size, memory_.size)), screen_(window_, gpuOptions(options.gpu)),
      quality_(qualityOn(screen_.gpu())), keptQuality_(keptQuality()),
      touch_(options, [this](const std::string& text) { notice_ = text; }),
      interruptedForce_(touch_.forceSwitch()), forceKey_(touch_.forceSwitch()),
      forceWatch_(window_.handle(), GLFW_KEY_SPACE, [this](bool plain) { forceKey_.press(plain); }),
      keys_(window_.handle(), [this](int key, int modifiers) { keyDown(key, modifiers); }),
      timeline_(touch_.again(), recordingFolders(options.recording)), status_(options.statusJson) {
    // The command line takes precedence over the last run.
    state_.settings = memory_.settings;
    for (const auto& [name, value] : options.settings)
        (void)setSetting(state_.settings, name, value);
    state_.chosen = state_.settings;
    state_.sound = memory_.sound;
    state_.sound.on = state_.sound.on || options.sound;
    state_.folds = memory_.folds;
    state_.uiScale = options.uiScale > 0.0f ? options.uiScale : memory_.uiScale;
    state_.charts = memory_.charts;
    state_.introduced = memory_.introduced;
    for (const std::string& warning : {memoryWarning_, window_.sizeWarning()})
        if (!warning.empty())
            std::fprintf(stderr, "touchstone: warning: %s\n", warning.c_str());
    state_.simulatedHand = options.simulatedHand;
    state_.stroke = options.stroke;
    state_.workspace.zoom = options.zoom;
    state_.device = options.device;
    state_.view.pictureSize = options.pictureSize;
    firstPart_ = options.part;
    onScreen([this] { screen_.renderer().warmUp(); });
    // A second device would say to the validation layer what nobody reads.
    if (const Gpu& gpu = screen_.gpu(); gpu.isSoftware() && !gpu.validationActive()) {
        opening_.compileFor(gpu.name());
        drawn_.compileFor(gpu.name());
    }
    holdDevice();
    sendSettings();
    touch_.start();
    environment_.start(options.environment);
}

WorkbenchWindow::~WorkbenchWindow() {
    touch_.forceSwitch().takeAway(false); // the rest may wait for a worker: no force meanwhile
    try {
        remember();
    } catch (...) { // a failure to save the window's state must not skip the last order
    }
}

void WorkbenchWindow::frame() {
    const double start = secondsNow();
    pace_.begin(start);
    onScreen([this] {
        followScale();
        takeModel();
        if (const auto wrong = environment_.update(screen_.renderer()))
            problem_ = *wrong;
    });
    takeMaterials();
    prepareSettings();
    if (const auto dropped = window_.takeDropped())
        leaveFor(*dropped);
    takeFile(start);
    leave();
    touch_.update(start);
    materials_.programs().showFault(touch_.failing().program(), touch_.failing().fault());
    if (touch_.feelsWhole())
        materials_.programs().feltAt(materials_.touched(), secondsNow());
    if (!timeline_.looking())
        touch_.operate(state_.settings);
    // While a recording is open the force is off: then the key only switches it off for afterwards.
    const bool writes = ImGui::GetIO().WantTextInput || dialog_.awaitsText();
    state_.settings.forceEnabled = forceKey_.settle(state_.settings.forceEnabled,
                                                    !writes && !timeline_.looking(), forceWatch_.presses());
    lookBack(start);
    onScreen([this] {
        keys_.feed(dialog_.awaitsText());
        if (screen_.target().beginFrame())
            draw();
        else
            view_.letGo(); // without a frame, input has no visible effect
    });
    moveHand();
    touch_.devices().renew(start);
    holdDevice();
    pace(start);
}

bool WorkbenchWindow::closed() {
    if (interrupted() || !window_.shouldClose() || left_)
        return interrupted() || window_.shouldClose();
    if (unsavedChanges_.mayLeave({}, materials_, state_))
        return true;
    window_.stayOpen();
    return false;
}

const TickRecord& WorkbenchWindow::shownTick() const {
    return timeline_.looking() && !timeline_.again().running() ? timeline_.tick() : touch_.tick();
}

HapticSettings WorkbenchWindow::shownSettings() const {
    return timeline_.looking() && !timeline_.again().running() ? timeline_.settings() : sentSettings();
}

HapticSettings WorkbenchWindow::sentSettings() const {
    HapticSettings settings = state_.settings;
    settings.forceEnabled = settings.forceEnabled && !timeline_.looking();
    return settings;
}

void WorkbenchWindow::sendSettings() {
    forceKey_.set(state_.settings.forceEnabled);
    touch_.send(sentSettings());
}

void WorkbenchWindow::keyDown(int key, int modifiers) {
    constexpr int kNotPlain = GLFW_MOD_CONTROL | GLFW_MOD_ALT | GLFW_MOD_SUPER;
    if (key == GLFW_KEY_SPACE)
        forceKey_.pressInWindow((modifiers & kNotPlain) == 0, forceWatch_.presses());
}

void WorkbenchWindow::prepareSettings() {
    try {
        touch_.prepare(state_.settings);
    } catch (const std::exception& error) {
        problem_ = std::string("the settings could not be prepared: ") + error.what();
        state_.settings.contact = ContactMethod::Sweep;
        state_.settings.textureGradient = TextureGradient::Central;
        sendSettings();
    }
}

void WorkbenchWindow::moveHand() {
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
    touch_.otherHands().face(view_.workspaceFromView());
    touch_.sound().update(state_.sound);
    touch_.layStroke(state_.stroke, -view_.camera().forward(), state_.simulatedHand);
}

void WorkbenchWindow::holdDevice() {
    touch_.hold(state_.device);
}

void WorkbenchWindow::remember() {
    memory_.settings = state_.settings;
    memory_.settings.forceEnabled = true;
    memory_.sound = state_.sound;
    memory_.folds = state_.folds;
    memory_.uiScale = state_.uiScale;
    memory_.charts = state_.charts;
    memory_.introduced = state_.introduced;
    memory_.size = glm::ivec2(glm::vec2(window_.size()) / window_.layoutScale()); // the requested size
    writeMemory(stateFolder() / kMemoryFile, memory_);
}

void WorkbenchWindow::followScale() {
    scale_ = fittingScale(state_.uiScale, window_.layoutScale(), glm::vec2(window_.size()));
    screen_.restyle(scale_);
}

double WorkbenchWindow::aspect() const {
    const PixelRect area = pictureArea();
    return static_cast<double>(area.width) / area.height;
}

void WorkbenchWindow::pace(double start) {
    const double busy = secondsNow() - start;
    // The picture that was saved in this frame says nothing about how long the others take; nor do the steps
    // of one that is being refined.
    const double drawing = std::max(busy - std::exchange(savedSeconds_, 0.0), screen_.busy());
    const ModelPicture::Drawn& drawn = picture_.drawn();
    if (drawn.state != PictureState::Refining && drawn.frames > kSettling)
        (drawn.state == PictureState::Kept ? keptQuality_ : quality_).frameDone(drawing);
    if (screen_.target().statistics().framesPresented > 1) // the first keeps no picture waiting
        longestFrame_ = std::max(longestFrame_, busy);
    window_.waitEvents(0.0);
    // An edit that is on its way is felt as soon as it is made, not a frame later.
    constexpr double kLook = 0.003; // s
    for (double left = pace_.due() - secondsNow(); left > 0.0; left = pace_.due() - secondsNow()) {
        const bool edits = materials_.onTheWay();
        window_.waitEvents(edits ? std::min(left, kLook) : left);
        if (edits)
            takeMaterials();
    }
}

int windowCommand(const WindowOptions& options) {
    catchInterrupts();
    // What is wrong with the command line, before the display is asked for.
    if (!options.scene.empty())
        requireFile(options.scene, options.scene.string(),
                    "name a glTF, OBJ, STL or PLY model, a volume, or a recording");
    if (!options.device.empty())
        requireDevice(options.device, "mouse, hand (the simulated one)");
    for (const std::string& device : options.otherDevices)
        if (device != "hand")
            requireDevice(device, "hand (the simulated one)");
    WorkbenchWindow workbench(options);
    workbench.open(
        options.scene.empty() ? defaultScene() : options.scene,
        {.iso = options.iso, .volume = nullptr, .animation = options.animation, .loose = options.loose});
    while (!workbench.closed())
        workbench.frame();
    return 0;
}

} // namespace touchstone
