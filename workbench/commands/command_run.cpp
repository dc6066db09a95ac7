// The window's loops without a window: the simulated hand strokes the model in real time.

#include "devices/device/mapped_device.h"
#include "devices/plant/hand_impedance.h"
#include "devices/simulated/simulated_hand.h"
#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "engine/core/realtime_guard.h"
#include "haptics/servo/servo_loop.h"
#include "renderer/draw_quality.h"
#include "renderer/png.h"
#include "renderer/scene_renderer.h"
#include "workbench/commands/device_test.h"
#include "workbench/commands/stroke_outcome.h"
#include "workbench/figures/settings_json.h"
#include "workbench/figures/stolen_time.h"
#include "workbench/figures/tick_csv.h"
#include "workbench/figures/tick_statistics.h"
#include "workbench/files/recording_controller.h"
#include "workbench/guards/interrupt.h"
#include "workbench/hand/device_menu.h"
#include "workbench/hand/device_port.h"
#include "workbench/model/animate.h"
#include "workbench/model/environment_light.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"
#include "workbench/options/gpu_options.h"
#include "workbench/screen/overlays.h"

#include <chrono>
#include <cstdio>
#include <optional>
#include <thread>

namespace touchstone {

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kFrameRate = 30.0;

/// A view from slightly above and to the right, to show depth.
View frontView(const Model& model, const glm::ivec2& size) {
    const double aspect = static_cast<double>(size.x) / size.y;
    OrbitCamera camera;
    camera.yaw = 0.45;
    camera.pitch = 0.35;
    camera.frame(workspaceBounds(model), aspect);
    return viewOf(camera, model.workspaceFromScene, aspect);
}

/// Takes every tick since the last call.
class TickReader {
  public:
    TickReader(const Model& model, const RunOptions& options)
        : model_(model), options_(options), moving_(model.scene, *model.haptic) {
        if (!options.recordTicks.empty()) {
            csv_.emplace(options.recordTicks);
            csv_->write(kTickCsvHeader);
        }
    }

    void drain(ServoLoop& servo, RecordingController& controller) {
        TickRecord record;
        rows_.clear();
        while (servo.popRecord(record)) {
            statistics.addLive(record);
            controller.recorder().take(record);
            if (record.output.contacts > 0) {
                statistics.addProxyGap(
                    proxyGap(*model_.haptic, moving_.at(record.time), record.output, options_.settings));
                lastContact = record;
            }
            last = record;
            if (csv_)
                appendTickRow(rows_, record.time, record.output, record.stepNs);
        }
        if (csv_)
            csv_->write(rows_);
        controller.update();
    }
    void commit() {
        if (csv_)
            csv_->commit();
    }

    TickStatistics statistics;
    TickRecord last;
    std::optional<TickRecord> lastContact;

  private:
    const Model& model_;
    const RunOptions& options_;
    MovingObjects moving_;
    std::optional<OutputFile> csv_;
    std::string rows_;
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
Frames drawFrames(const RunOptions& options, const Model& model, ServoLoop& servo, SceneRenderer& renderer,
                  TickReader& reader, RecordingController& controller) {
    View view = frontView(model, options.size);
    const auto period =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(1.0 / kFrameRate));
    const auto length =
        std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(options.seconds));
    const Clock::time_point start = Clock::now();
    Clock::time_point next = start;
    Frames frames{.smallest = options.size};
    DrawQuality resolution({.largestPixels = options.size.x * options.size.y});
    Overlay overlay;
    while (Clock::now() - start < length && !interrupted()) {
        const Clock::time_point begin = Clock::now();
        servo.updateSnapshot();
        reader.drain(servo, controller);
        overlay.clear();
        drawTick(servo.snapshot(), options.settings, lookOf(servo.snapshot(), options.settings, model),
                 overlay);
        view.probe = probeShadow(servo.snapshot(), options.settings);
        poseAt(servo.snapshot().time, *model.scene, renderer);
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

} // namespace

int runCommand(const RunOptions& options) {
    catchInterrupts();
    const std::unique_ptr<LinkedDevice> device = openDeviceOrHand(options.device);
    const DeviceLimits simulatedLimits = options.openLoop ? DeviceLimits{} : limitsOf(options.plant);
    const Model model =
        loadModel(options.scene, Fit::Workspace, device != nullptr ? device->limits() : simulatedLimits);
    printWarnings(model);
    prepareFor(model, options.settings);
    model.haptic->buildRays(); // the report measures the proxy gap with Embree during the run
    SimulatedHand path(
        std::make_shared<StrokePath>(layStroke(*model.scene, model.workspaceFromScene, options.stroke)));
    HandImpedance yielding(path, options.plant);
    Device& simulated = options.openLoop ? static_cast<Device&>(path) : yielding;
    MappedDevice hand(device != nullptr ? *device : simulated, options.zoom,
                      device != nullptr ? glm::dvec3(0.0) : path.path().place());
    std::optional<OutputFile> report;
    if (!options.json.empty())
        report.emplace(options.json);
    TickReader reader(model, options);

    // The device is created before the servo thread; the first frame compiles the pipelines.
    const std::unique_ptr<Gpu> gpu = Gpu::headless(gpuOptions(options.gpu));
    SceneRenderer renderer(*gpu);
    lightWith(options.environment, renderer);
    renderer.setScene(model.scene);
    renderer.render(frontView(model, options.size), Overlay{}, options.size.x, options.size.y);
    gpu->waitIdle();

    ServoLoop servo(portOf(hand), {.rateHz = options.rateHz, .stageTimes = true});
    servo.setSettings(options.settings);
    RecordingController controller(servo, options.recording, "run");
    controller.recorder().sceneOffered(servo.offerScene(model.haptic, model.scene),
                                       identify(*model.haptic, *model.scene, Fit::Workspace));
    realtime::resetViolations();
    const StolenTime stolenTime;
    servo.start();
    const Frames frames = drawFrames(options, model, servo, renderer, reader, controller);
    servo.stop();
    const std::optional<double> stolen = stolenTime.seconds();
    const RealtimeViolations violations = realtime::violations();
    reader.drain(servo, controller);
    controller.finish();

    if (!options.screenshot.empty()) {
        Overlay overlay; // of the last tick in contact: a hand in the air has none
        const TickRecord& shown = reader.lastContact.value_or(reader.last);
        drawTick(shown, options.settings, lookOf(shown, options.settings, model), overlay);
        View view = frontView(model, options.size);
        view.probe = probeShadow(shown, options.settings);
        poseAt(shown.time, *model.scene, renderer);
        writePng(options.screenshot, renderStill(renderer, view, overlay, options.size.x, options.size.y));
    }
    for (const std::string& message : gpu->validationMessages())
        std::fprintf(stderr, "touchstone: validation: %s\n", message.c_str());
    reader.commit();
    if (report) {
        const double fps = static_cast<double>(frames.count) / frames.seconds;
        const nlohmann::ordered_json json{
            {"command", "run"},
            {"scene", options.scene.string()},
            {"seconds", frames.seconds},
            {"triangles", model.scene->triangleCount()},
            {"device", hand.name()},
            {"link", device != nullptr ? linkJson(device->report()) : nlohmann::ordered_json()},
            {"stroke",
             device != nullptr ? nlohmann::ordered_json() : nlohmann::ordered_json(options.stroke.name)},
            {"workspace_scale", options.zoom},
            {"loop", options.openLoop || device != nullptr ? nlohmann::ordered_json("open")
                                                           : plantJson(yielding.plant())},
            {"settings", settingsJson(options.settings)},
            {"setting_warnings", settingWarnings(options.settings)},
            {"servo", servoJson(servo, reader.statistics, frames.seconds, stolen)},
            {"wake_histogram", histogramJson(reader.statistics.wake())},
            {"step", reader.statistics.stepJson()},
            {"stages", reader.statistics.stagesJson()},
            {"step_histogram", histogramJson(reader.statistics.step())},
            {"frames",
             {{"count", frames.count},
              {"fps", fps},
              {"late", frames.late},
              {"width", options.size.x},
              {"height", options.size.y},
              {"smallest_width", frames.smallest.x},
              {"smallest_height", frames.smallest.y}}},
            {"allocations_in_tick", violations.allocations},
            {"deallocations_in_tick", violations.deallocations},
            {"locks_in_tick", realtime::locksAreCounted() ? nlohmann::ordered_json(violations.locks)
                                                          : nlohmann::ordered_json()},
            {"contact", reader.statistics.contactJson()},
            {"force", reader.statistics.forceJson()},
            {"energy", reader.statistics.energyJson()},
            {"flags", reader.statistics.flagsJson()},
            {"recording", controller.json()},
            {"gpu",
             {{"name", gpu->name()},
              {"description", gpu->description()},
              {"validation_active", gpu->validationActive()},
              {"validation_messages", gpu->validationMessages().size()}}},
        };
        report->write(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
        report->commit();
    }
    const ServoLoop::Counters counters = servo.counters();
    std::printf("%llu ticks (%llu missed) in %.1f s, %llu in contact, %llu frames\n",
                static_cast<unsigned long long>(counters.ticks),
                static_cast<unsigned long long>(counters.missed), frames.seconds,
                static_cast<unsigned long long>(reader.statistics.contactTicks()),
                static_cast<unsigned long long>(frames.count));
    if (device == nullptr)
        requireTouch(options.scene, options.stroke, path.path().period(), frames.seconds,
                     reader.statistics.contactTicks());
    return controller.failed() ? 1 : 0;
}

} // namespace touchstone
