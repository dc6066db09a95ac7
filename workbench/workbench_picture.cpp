#include "haptics/comparison/comparison_solver.h"
#include "workbench/figures/quantity.h"
#include "workbench/panels/pad_view.h"
#include "workbench/screen/keys.h"
#include "workbench/workbench_window.h"

namespace touchstone {

void WorkbenchWindow::draw() {
    gallery_.update(state_.gallery, samples_, memory_.recent, screen_.target());
    materials_.programs().seenAt(drawn_.programs(), secondsNow()); // of the last frame
    const PixelRect area = pictureArea();
    const PanelInput input = panelInput(picture_.drawn().size);
    auto widgets = drawPanels(input, state_);
    widgets.merge(drawMaterials(input.scale));
    const auto points = static_cast<double>(ImGui::GetIO().DisplayFramebufferScale.x);
    if (const auto pad = touch_.padShown())
        widgets["pad"] = drawPadView(*pad, widgets["picture"], input.scale);
    view_.update({.origin = glm::dvec2(area.x, area.y) / points,
                  .area = glm::dvec2(area.width, area.height) / points,
                  .probe = shownTick().output.proxy,
                  .seconds = static_cast<double>(ImGui::GetIO().DeltaTime),
                  .mouseIsHand = state_.device.empty() && !state_.simulatedHand && !timeline_.looking(),
                  .looksBack = timeline_.looking(),
                  .covered = state_.gallery || state_.leaving.has_value() || dialog_.covers(),
                  .sculpts = state_.sculpt.on && touch_.sculpt().possible(),
                  .grasps = state_.settings.grasp == GraspMode::Button,
                  .look = [this](const Ray& ray) { return touch_.look(ray, state_.settings); }},
                 state_.view);
    showPart(area, points, widgets);
    doWhatWasAsked(widgets);
    sendSettings();
    // While an edge is dragged nothing is written.
    if ((memory_.folds != state_.folds || memory_.charts != state_.charts ||
         memory_.uiScale != state_.uiScale) &&
        !ImGui::IsAnyMouseDown())
        remember();

    if (hasModel())
        poseModel();
    const HapticSettings settings = shownSettings();
    const ModelPicture::Frame frame{
        .model = touch_.shown().model,
        .name = hasModel() ? materials_.path().stem().string() : "", // that of the file it was saved as
        .tick = shownTick(),
        .others = timeline_.looking() ? std::span<const OtherHands::State>() : touch_.otherHands().states(),
        .felt = timeline_.looking() ? nullptr : touch_.sculpt().felt(),
        .tickBelongs = !timeline_.looking() || timeline_.modelIsOpen(),
        .settings = settings,
        .camera = view_.camera(),
        .options = state_.view,
        .place = area,
        .sceneSize = quality_.sceneSize({area.width, area.height}),
        .keptSize = keptSize({area.width, area.height}),
        .allowedError =
            (picture_.drawn().state == PictureState::Kept ? keptQuality_ : quality_).allowedError(),
        .pixelsPerPoint = static_cast<float>(points),
        .scale = scale_,
        .software = screen_.gpu().isSoftware()};
    screen_.target().endFrame(&screen_.renderer(), picture_.draw(frame, screen_.renderer()));
    const double before = secondsNow();
    (void)picture_.save(frame, screen_.renderer());
    savedSeconds_ = secondsNow() - before;
    (void)chartPictures_.update(screen_.target());
    chartSaver_.update();
    status_.update(secondsNow(), input, state_, widgets,
                   {.drawn = picture_.drawn(),
                    .validationMessages = screen_.validationMessages(),
                    .otherMaterials = drawn_.redraws(),
                    .programs = materials_.programs()});
}

void WorkbenchWindow::poseModel() {
    showMaterials();
    touch_.sculpt().update(state_.sculpt, !timeline_.looking());
    touch_.sculpt().draw(screen_.renderer());
    const bool recorded = timeline_.looking() && timeline_.modelIsOpen() && !timeline_.again().running();
    touch_.pose(animationTime(shownSettings(), shownTick().time), screen_.renderer(),
                recorded ? timeline_.bodies() : std::span<const body::Pose>(),
                recorded ? timeline_.moved() : std::span<const DrivenPose>());
}

void WorkbenchWindow::showPart(const PixelRect& area, double points,
                               std::map<std::string, WidgetRect>& rects) {
    Widgets widgets(scale_, &state_.hovered);
    const auto corner = glm::vec2(glm::dvec2(area.x + area.width, area.y) / points);
    if (state_.view.axes && !state_.gallery && !dialog_.covers())
        if (const auto move =
                drawAxisGizmo(view_.camera(), corner, scale_, [&](const char* name) { widgets.mark(name); }))
            state_.view.move = move;
    const glm::dvec2 origin = glm::dvec2(area.x, area.y) / points,
                     size = glm::dvec2(area.width, area.height) / points;
    const auto pointed = [&] {
        const ImVec2 at = ImGui::GetIO().MousePos;
        if (!ImGui::IsMousePosValid())
            return -1;
        return touch_.nodeAt(view_.camera().rayThroughPixel(
            glm::dvec2(static_cast<double>(at.x), static_cast<double>(at.y)) - origin, size));
    };
    partMenu_.update({.scene = hasModel() ? touch_.shown().model.scene.get() : nullptr,
                      .covered = state_.gallery || state_.leaving.has_value() || dialog_.covers(),
                      .pointed = pointed},
                     state_.view.part, [&](const char* name) { widgets.mark(name); });
    rects.merge(widgets.take());
    try {
        touch_.showPart(state_.view.part);
    } catch (const std::exception& error) {
        problem_ = std::string("this part of the model cannot be felt: ") + error.what();
        state_.view.part = touch_.shown().model.part;
    }
}

std::map<std::string, WidgetRect> WorkbenchWindow::drawMaterials(float scale) {
    const ImVec2 display = ImGui::GetIO().DisplaySize;
    MaterialPanelInput input;
    if (hasModel()) {
        const Model& model = touch_.shown().model;
        input.scene = model.scene.get();
        input.deviceStiffness = touch_.tick().sample.limits.recommendedStiffness;
        const int object = touch_.tick().output.object;
        const auto& objects = model.haptic->objects;
        if (object >= 0 && static_cast<size_t>(object) < objects.size())
            input.probed = objects[static_cast<size_t>(object)]->material;
    }
    Widgets widgets(scale, &state_.hovered);
    const PictureRect picture = pictureRect(state_, {display.x, display.y}, scale);
    drawMaterialWindow(input, {picture.x, picture.y, picture.width, picture.height}, state_.editMaterials,
                       materials_, materialState_, widgets, !state_.sculpt.on);
    return widgets.take();
}

PanelInput WorkbenchWindow::panelInput(const glm::ivec2& sceneSize) {
    PanelInput input;
    if (hasModel())
        describeModel(input);
    input.problem = problem_;
    input.now = secondsNow();
    describeFiles(input);
    describeHand(input);
    describePicture(sceneSize, input);
    return input;
}

void WorkbenchWindow::describeModel(PanelInput& input) {
    const Scene& scene = *touch_.shown().model.scene;
    input.scene = &scene;
    input.haptic = touch_.shown().model.haptic.get();
    input.part = touch_.shown().model.part;
    input.modelPath = materials_.path().string();
    input.modelName = materials_.path().filename().string();
    input.modelFacts = figure(static_cast<double>(scene.triangleCount()), 1) + " triangles" +
                       (scene.touchable() ? "" : ": nothing to touch");
    for (const auto* warnings : {&scene.warnings, &input.haptic->warnings})
        for (const Warning& warning : *warnings)
            input.warnings.push_back((warning.place.empty() ? "" : warning.place + ": ") + warning.message);
    for (std::string& warning : settingWarnings(*input.haptic, state_.settings))
        input.warnings.push_back(std::move(warning));
    if (refusalOf(*input.haptic, state_.settings).empty() &&
        has(touch_.figures().last.output.flags, TickFlag::NeighbourhoodMissing))
        input.warnings.emplace_back("the contact method is being prepared: swept until then");
}

void WorkbenchWindow::describeFiles(PanelInput& input) {
    input.gallery = gallery_.entries();
    input.showPicture = [this](size_t place, const glm::vec2& from, const glm::vec2& to) {
        screen_.target().showPicture(place, from, to);
    };
    input.recent = memory_.recent;
    input.samples = samples_;
    input.sampleNotes = sampleNotes_;
    input.failing = &touch_.failing();
    input.materialNotice = materials_.notice();
    input.canSaveMaterials = materials_.canSaveInPlace();
    input.materialsEdited = materials_.edited();
    input.texturesEdited = materials_.texturesEdited();
    if (hasModel() && !timeline_.looking())
        input.textures = touch_.recording().recorder().textures();
    input.materialsWorking = materials_.working() || materials_.programs().pending();
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
}

void WorkbenchWindow::describeHand(PanelInput& input) {
    input.canSimulate = touch_.shown().path != nullptr;
    input.strokeNotice = touch_.strokeNotice();
    input.devices = touch_.devices().offers();
    input.others = touch_.otherHands().states();
    input.deviceStatus = touch_.devices().status();
    input.sound = touch_.sound().status();
    input.sculpt = touch_.sculpt().status();
    input.servo = &touch_.figures();
    input.servoStart = touch_.startedAt();
    input.forcePresses = touch_.forceSwitch().state().presses();
    input.forceKeyLate = forceKey_.late();
    input.typing = ImGui::GetIO().WantTextInput;
    input.timeline = &timeline_;
    input.dialog = &dialog_;
    input.tick = timeline_.looking() ? &shownTick() : &touch_.figures().last;
    input.forces = &touch_.forces();
}

void WorkbenchWindow::describePicture(const glm::ivec2& sceneSize, PanelInput& input) {
    input.frames = screen_.target().statistics().framesPresented;
    input.framesPerSecond = pace_.rate();
    input.camera = view_.camera();
    input.forceSent = forceSent(input.tick->output, shownSettings());
    input.savedPicture = picture_.note();
    const SavedNote &drawn = chartPictures_.note(), &written = chartSaver_.note();
    input.savedCharts = drawn.at > written.at ? drawn : written;
    input.chartsSaving = chartSaver_.busy();
    input.sceneSize = sceneSize;
    input.gpuName = screen_.gpu().name();
    input.scale = scale_;
    input.scaleFits = scale_ >= 0.999f * state_.uiScale * window_.layoutScale();
    if (!input.scaleFits)
        input.warnings.push_back("A UI scale of " + figure(100.0 * static_cast<double>(state_.uiScale)) +
                                 " % does not fit this window.");
    for (const std::string& warning : {memoryWarning_, window_.sizeWarning()})
        if (!warning.empty())
            input.warnings.push_back(warning);
}

void WorkbenchWindow::doWhatWasAsked(const std::map<std::string, WidgetRect>& widgets) {
    if (std::exchange(state_.recordPressed, false))
        touch_.recording().toggle();
    if (touch_.hasBodies() && !timeline_.looking() && keyPressed(keyOf('r')))
        touch_.resetBodies();
    if (touch_.hasBodies() && !timeline_.looking() && keyPressed(keyOf('j'))) {
        const bool grasps = state_.settings.grasp == GraspMode::Off;
        state_.settings.grasp = grasps ? GraspMode::Button : GraspMode::Off;
        state_.view.freeHand = grasps; // a held body goes where the hand does
    }
    if (std::exchange(state_.cancelPressed, false))
        opening_.cancel(screen_.renderer()), timeline_.cancelOpening();
    if (std::exchange(state_.dismissPressed, false))
        problem_.clear();
    if (std::exchange(state_.noticeDismissed, false))
        notice_.clear();
    if (std::exchange(state_.quitPressed, false))
        window_.close();
    if (const auto iso = std::exchange(state_.iso, std::nullopt); iso && hasModel()) {
        const Scene& scene = *touch_.shown().model.scene;
        open(scene.path, {.iso = iso, .volume = scene.volume});
    }
    if (const auto animation = std::exchange(state_.animation, std::nullopt); animation && hasModel())
        open(touch_.shown().model.scene->path, {.animation = std::to_string(*animation)});
    if (const auto gone = std::exchange(state_.forget, std::nullopt)) {
        memory_.forget(*gone);
        remember();
    }
    for (auto* asked : {&state_.open, &state_.timeline.open})
        if (const auto path = std::exchange(*asked, std::nullopt))
            leaveFor(*path);
    if (const auto wanted = std::exchange(state_.chartWanted, std::nullopt)) {
        const ForceHistory& history = state_.stopped ? *state_.stopped : touch_.forces();
        if (*wanted == ChartFile::Picture)
            chartPictures_.request(screen_.target(), pixelsOf(widgets.at("charts")), "charts");
        else if (*wanted == ChartFile::Csv)
            chartSaver_.saveCsv(history);
        else
            chartSaver_.saveFigure(
                history, state_.charts,
                {.model = std::filesystem::path(touch_.shown().identity.path).filename().string(),
                 .hand = handName(),
                 .settings = state_.settings});
    }
}

std::string WorkbenchWindow::handName() const {
    return !state_.device.empty() ? state_.device
           : state_.simulatedHand ? "simulated hand, stroke " + state_.stroke.name
                                  : "mouse";
}

PixelRect WorkbenchWindow::pixelsOf(const WidgetRect& rect) {
    const float pixels = ImGui::GetIO().DisplayFramebufferScale.x;
    return {static_cast<int>(rect.x * pixels), static_cast<int>(rect.y * pixels),
            static_cast<int>(rect.width * pixels), static_cast<int>(rect.height * pixels)};
}

glm::ivec2 WorkbenchWindow::keptSize(const glm::ivec2& area) const {
    if (!screen_.gpu().isSoftware() || state_.view.wireframe) // nothing is kept of edges
        return glm::ivec2(0);
    // Pixel for pixel where it can be: sceneSize is in multiples of eight.
    const glm::ivec2 size = keptQuality_.sceneSize(area);
    return keptQuality_.quality() == 1.0 && glm::all(glm::lessThan(glm::abs(area - size), glm::ivec2(8)))
               ? area
               : size;
}

PixelRect WorkbenchWindow::pictureArea() const {
    const float pixels = ImGui::GetIO().DisplayFramebufferScale.x;
    const glm::vec2 size(screen_.target().size());
    const PictureRect rect = pictureRect(state_, size, scale_ * pixels);
    return {static_cast<int>(rect.x), static_cast<int>(rect.y), std::max(16, static_cast<int>(rect.width)),
            std::max(16, static_cast<int>(rect.height))};
}

} // namespace touchstone
