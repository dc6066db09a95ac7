// The window's loops without a window: devices and simulated hands touch the model in real time.

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "engine/core/realtime_guard.h"
#include "engine/import/volume_file/volume_edits.h"
#include "engine/time/seconds_now.h"
#include "haptics/body/joint_settings.h"
#include "haptics/comparison/comparison_solver.h"
#include "haptics/scene/shape_object.h"
#include "renderer/draw_quality.h"
#include "renderer/picture_file.h"
#include "renderer/scene_renderer.h"
#include "session/session.h"
#include "workbench/commands/run_hands.h"
#include "workbench/commands/run_sculpt.h"
#include "workbench/commands/stroke_outcome.h"
#include "workbench/figures/settings_json.h"
#include "workbench/figures/stolen_time.h"
#include "workbench/figures/texture_figures.h"
#include "workbench/figures/tick_csv.h"
#include "workbench/figures/tick_statistics.h"
#include "workbench/files/recording_controller.h"
#include "workbench/guards/interrupt.h"
#include "workbench/model/animate.h"
#include "workbench/model/dented_meshes.h"
#include "workbench/model/environment_light.h"
#include "workbench/model/model.h"
#include "workbench/model/shown_soft_bodies.h"
#include "workbench/model/shown_textures.h"
#include "workbench/options/commands.h"
#include "workbench/options/gpu_options.h"
#include "workbench/screen/overlays.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFrameRate = 30.0;

View firstView(const Model& model, const glm::ivec2& size) {
    const double aspect = static_cast<double>(size.x) / size.y;
    View view =
        viewOf(OrbitCamera::threeQuarter(workspaceBounds(model), aspect), model.workspaceFromScene, aspect);
    view.part = model.part;
    view.shells = shellsOf(*model.haptic);
    return view;
}

/// Statistics and files of the ticks.
class TickReader final : public TickSubscriber {
  public:
    TickReader(const Model& model, const RunOptions& options)
        : model_(model), options_(options), world_(model.scene, *model.haptic, WorldBodies::Shown),
          rows_(options.recordTicks.size()) {
        // Times are those of all hands: percentiles of the first hand's records suffice.
        for (size_t hand = 0; hand < options.devices.size(); ++hand)
            statistics.emplace_back(hand == 0 ? 0 : 1);
        for (const std::filesystem::path& file : options.recordTicks) {
            csv_.push_back(std::make_unique<OutputFile>(file));
            csv_.back()->write(tickCsvHeader(options.pad));
        }
    }

    void take(const TickRecord& record, const HapticSettings&) override {
        TickStatistics& own = statistics[record.hand];
        own.addLive(record);
        const ObjectMotions motions = world_.advance(animationTime(options_.settings, record.time),
                                                     has(record.output.flags, TickFlag::DeformationHeld));
        if (record.output.contacts > 0 && world_.bodies() == nullptr)
            own.addProxyGap(
                proxyGap(world_.touched(*model_.haptic), motions, record.output, options_.settings));
        if (record.hand < rows_.size())
            appendTickRow(rows_[record.hand], record.time, record.output, record.stepNs);
        if (record.hand < rows_.size() && options_.pad)
            appendPadPlace(rows_[record.hand], record.sample, record.output);
        if (record.hand > 0)
            return;
        last = record;
        if (record.output.contacts > 0)
            lastContact = record;
    }
    void flush(double) override {
        for (size_t hand = 0; hand < csv_.size(); ++hand) {
            csv_[hand]->write(rows_[hand]);
            rows_[hand].clear();
        }
    }
    void commit() {
        for (const auto& csv : csv_)
            csv->commit();
    }

    std::vector<TickStatistics> statistics; ///< one per hand
    // Of hand 0:
    TickRecord last;
    std::optional<TickRecord> lastContact;

  private:
    const Model& model_;
    const RunOptions& options_;
    WorldState world_;
    std::vector<std::unique_ptr<OutputFile>> csv_; // of the hands that have one
    std::vector<std::string> rows_;
};

struct Frames {
    uint64_t count = 0;
    double seconds = 0.0;
    uint64_t late = 0;      ///< frames that missed the start of the next one
    glm::ivec2 smallest{0}; ///< pixels: the resolution decreases while frames are late
};

TickLook lookOf(const TickRecord& tick, const HapticSettings& settings, const Model& model) {
    return {.shown = {},
            .frictionCoefficient = frictionCoefficientAt(tick, settings, *model.scene, *model.haptic)};
}

/// Draws at the frame rate until the time is over, beside the servo.
Frames drawFrames(const RunOptions& options, const Model& model, Session& session,
                  const ServoRecorder& recorder, SceneRenderer& renderer) {
    View view = firstView(model, options.size);
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / kFrameRate));
    const auto length =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.seconds));
    const Clock::time_point start = Clock::now();
    Clock::time_point next = start;
    Frames frames{.smallest = options.size};
    DrawQuality resolution({.largestPixels = options.size.x * options.size.y});
    Overlay overlay;
    WorldState shown(model.scene, *model.haptic, WorldBodies::Shown);
    ShownTextures textures;
    ShownSoftBodies shownSoft;
    DentedMeshes dented;
    HapticSettings settings = options.settings;
    body::JointSettings controls;
    if (shown.bodies() != nullptr)
        controls = body::JointSettings(*shown.bodies());
    while (Clock::now() - start < length && !interrupted()) {
        const Clock::time_point begin = Clock::now();
        session.pump(secondsNow());
        const TickRecord& tick = session.tick();
        overlay.clear();
        drawTick(tick, settings, lookOf(tick, settings, model), overlay);
        view.probe = probeShadow(tick, settings);
        if (const body::BodyPoses* poses = session.servo().bodyPoses()) {
            poseBodies(*poses, tick.time, shown, renderer);
            if (controls.apply(poses->workspaceFromBody, settings))
                session.set(settings);
        } else {
            poseAt(animationTime(settings, tick.time), *model.scene, renderer);
        }
        if (SoftStates* const soft = session.servo().soft())
            shownSoft.show(*soft, *model.scene, *model.haptic, renderer);
        textures.show(*model.haptic, recorder.textures(), renderer);
        dented.show(session.servo().dents(), *model.scene, *model.haptic, renderer);
        const glm::ivec2 size = resolution.sceneSize(options.size);
        frames.smallest = glm::min(frames.smallest, size);
        renderer.render(view, overlay, size.x, size.y);
        resolution.frameDone(std::chrono::duration<double>(Clock::now() - begin).count());
        ++frames.count;
        next += period;
        if (Clock::now() > next) {
            next = Clock::now();
            ++frames.late;
        }
        std::this_thread::sleep_until(std::min(next, start + length));
    }
    frames.seconds = std::chrono::duration<double>(Clock::now() - start).count();
    return frames;
}

nlohmann::ordered_json servoJson(const ServoLoop& servo, const TickStatistics& statistics, double seconds,
                                 const std::optional<double>& stolen) {
    const ServoLoop::Counters counters = servo.counters();
    const ServoScheduling scheduling = servo.scheduling();
    nlohmann::ordered_json json{{"ticks", counters.ticks}, {"missed", counters.missed}};
    json.update(statistics.wakeJson());
    json.update({{"rate_hz", servo.rateHz()},
                 {"ticks_per_second", static_cast<double>(counters.ticks) / seconds},
                 {"skipped", counters.skipped},
                 {"dropped_records", counters.droppedRecords},
                 {"scheduling", scheduling.policy},
                 {"memory_locked", scheduling.memoryLocked},
                 {"pinned_cpu", scheduling.pinnedCpu},
                 {"stolen_s", stolen ? nlohmann::ordered_json(*stolen) : nlohmann::ordered_json()}});
    return json;
}

/// The results of one hand.
nlohmann::ordered_json handJson(const RunHands& hands, const TickStatistics& statistics, size_t hand) {
    nlohmann::ordered_json json = hands.json(hand);
    json.update({{"contact", statistics.contactJson()},
                 {"force", statistics.forceJson()},
                 {"energy", statistics.energyJson()},
                 {"flags", statistics.flagsJson()}});
    return json;
}

nlohmann::ordered_json framesJson(const Frames& frames, const glm::ivec2& size) {
    return {{"count", frames.count},
            {"fps", static_cast<double>(frames.count) / frames.seconds},
            {"late", frames.late},
            {"width", size.x},
            {"height", size.y},
            {"smallest_width", frames.smallest.x},
            {"smallest_height", frames.smallest.y}};
}

nlohmann::ordered_json gpuJson(const Gpu& gpu) {
    return {{"name", gpu.name()},
            {"description", gpu.description()},
            {"validation_active", gpu.validationActive()},
            {"validation_messages", gpu.validationMessages().size()}};
}

/// What a run leaves behind.
struct RunResult {
    const Model& model;
    const RunHands& hands;
    const ServoLoop& servo;
    const TickReader& reader;
    const RecordingController& controller;
    const Gpu& gpu;
    Frames frames;
    RealtimeViolations violations;
    std::optional<double> stolen; // s
    nlohmann::ordered_json sculpt;
    const PersistentTextures* textures = nullptr; ///< as the servo left them; null: none
};

nlohmann::ordered_json reportOf(const RunOptions& options, const RunResult& run) {
    const TickStatistics& first = run.reader.statistics[0];
    nlohmann::ordered_json json{{"command", "run"},
                                {"scene", options.scene.string()},
                                {"seconds", run.frames.seconds},
                                {"triangles", run.model.scene->triangleCount()}};
    json.update(run.hands.json(0));
    json.update({{"settings", settingsJson(options.settings)},
                 {"setting_warnings", settingWarnings(*run.model.haptic, options.settings)},
                 {"servo", servoJson(run.servo, first, run.frames.seconds, run.stolen)},
                 {"wake_histogram", histogramJson(first.wake())},
                 {"step", first.stepJson()},
                 {"stages", first.stagesJson()},
                 {"step_histogram", histogramJson(first.step())},
                 {"frames", framesJson(run.frames, options.size)},
                 {"allocations_in_tick", run.violations.allocations},
                 {"deallocations_in_tick", run.violations.deallocations},
                 {"locks_in_tick", realtime::locksAreCounted() ? nlohmann::ordered_json(run.violations.locks)
                                                               : nlohmann::ordered_json()},
                 {"contact", first.contactJson()},
                 {"force", first.forceJson()},
                 {"energy", first.energyJson()},
                 {"flags", first.flagsJson()}});
    if (run.hands.count() > 1)
        for (size_t hand = 0; hand < run.hands.count(); ++hand)
            json["hands"].push_back(handJson(run.hands, run.reader.statistics[hand], hand));
    if (!run.sculpt.is_null())
        json["sculpt"] = run.sculpt;
    if (run.textures != nullptr)
        json["persistent_textures"] = texturesJson(*run.model.haptic, run.textures);
    json.update({{"recording", run.controller.json()}, {"gpu", gpuJson(run.gpu)}});
    return json;
}

/// The last picture, with the last tick of hand 0 in contact: a hand in the air has no overlay.
void writeScreenshot(const RunOptions& options, const Model& model, const TickReader& reader,
                     SceneRenderer& renderer) {
    Overlay overlay;
    const TickRecord& shown = reader.lastContact.value_or(reader.last);
    drawTick(shown, options.settings, lookOf(shown, options.settings, model), overlay);
    View view = firstView(model, options.size);
    view.probe = probeShadow(shown, options.settings);
    if (model.scene->physics == nullptr) // the bodies stay where the last frame drew them
        poseAt(animationTime(options.settings, shown.time), *model.scene, renderer);
    writePicture(options.screenshot, renderStill(renderer, view, overlay, options.size.x, options.size.y));
}

void printResult(const RunResult& run) {
    const ServoLoop::Counters counters = run.servo.counters();
    std::string contact;
    for (const TickStatistics& statistics : run.reader.statistics)
        contact += (contact.empty() ? "" : " and ") + std::to_string(statistics.contactTicks());
    std::printf("%llu ticks (%llu missed) in %.1f s, %s in contact, %llu frames\n",
                static_cast<unsigned long long>(counters.ticks),
                static_cast<unsigned long long>(counters.missed), run.frames.seconds, contact.c_str(),
                static_cast<unsigned long long>(run.frames.count));
    printCoverage(*run.model.haptic, run.textures);
}

void writeReport(OutputFile& file, const RunOptions& options, const RunResult& run) {
    file.write(reportOf(options, run).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) +
               "\n");
    file.commit();
}

/// Throws where a simulated hand has not touched.
void requireTouches(const RunOptions& options, const RunResult& run) {
    for (size_t hand = 0; hand < run.hands.count(); ++hand)
        if (run.hands.simulated(hand) &&
            !(options.sculpt.wanted && hand == 0)) // it may carve away what it would touch
            requireTouch(options.scene, options.stroke, run.hands.period(hand),
                         run.frames.seconds - run.hands.wait(hand),
                         run.reader.statistics[hand].contactTicks());
}

/// Compiles the pipelines, so that no later frame has to.
void drawFirst(const RunOptions& options, const Model& model, const Gpu& gpu, SceneRenderer& renderer) {
    lightWith(options.environment, renderer);
    renderer.setScene(model.scene);
    renderer.render(firstView(model, options.size), Overlay{}, options.size.x, options.size.y);
    gpu.waitIdle();
}

void printValidation(const Gpu& gpu) {
    for (const std::string& message : gpu.validationMessages())
        std::fprintf(stderr, "touchstone: validation: %s\n", message.c_str());
}

Model modelToRun(const RunOptions& options) {
    LoadOptions loading;
    loading.iso = options.iso;
    loading.animation = options.animation;
    if (options.loose)
        loading.edits = withLoose({});
    Model model = loadModel(options.scene, Fit::Workspace, loading);
    takePart(model, partNamed(*model.scene, options.part));
    printWarnings(model);
    prepareFor(model, options.settings);
    model.haptic->buildRays(); // the report measures the proxy gap with Embree during the run
    return model;
}

} // namespace

int runCommand(const RunOptions& options) {
    catchInterrupts();
    RunHands hands(options);
    Model model = modelToRun(options);
    std::vector<DevicePort> ports = hands.connect(model);
    std::optional<RunSculpt> sculpt;
    if (options.sculpt.wanted)
        sculpt.emplace(options.sculpt, model);
    std::optional<OutputFile> report;
    if (!options.json.empty())
        report.emplace(options.json);
    TickReader reader(model, options);

    // The device is created before the servo thread.
    const std::unique_ptr<Gpu> gpu = Gpu::headless(gpuOptions(options.gpu));
    SceneRenderer renderer(*gpu);
    drawFirst(options, model, *gpu, renderer);

    Session session(std::move(ports), {.rateHz = options.rateHz, .stageTimes = true});
    RecordingController controller(session.servo(), options.recording, "run");
    session.subscribe(controller);
    session.subscribe(reader);
    if (sculpt)
        session.subscribe(*sculpt);
    session.set(options.settings);
    (void)session.touch(model.haptic, model.scene, identityOf(model, Fit::Workspace));
    if (sculpt)
        sculpt->start(session);
    realtime::resetViolations();
    const StolenTime stolenTime;
    session.start();
    const Frames frames = drawFrames(options, model, session, controller.recorder(), renderer);
    session.stop();
    const std::optional<double> stolen = stolenTime.seconds();
    const RealtimeViolations violations = realtime::violations();
    session.pump(secondsNow());
    if (sculpt)
        sculpt->finish(session);
    controller.finish();

    if (!options.screenshot.empty())
        writeScreenshot(options, model, reader, renderer);
    printValidation(*gpu);
    reader.commit();
    const RunResult run{model,
                        hands,
                        session.servo(),
                        reader,
                        controller,
                        *gpu,
                        frames,
                        violations,
                        stolen,
                        sculpt ? sculpt->json(session, frames.seconds) : nlohmann::ordered_json(),
                        controller.recorder().textures()};
    if (report)
        writeReport(*report, options, run);
    printResult(run);
    requireTouches(options, run);
    return controller.failed() ? 1 : 0;
}

} // namespace touchstone
