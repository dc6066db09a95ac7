// Offline and deterministic: reads a path of the hand and writes every tick, as fast as possible.

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/output_file.h"
#include "engine/core/realtime_guard.h"
#include "haptics/comparison/comparison_solver.h"
#include "haptics/query/ray_floor.h"
#include "haptics/servo/realtime_thread.h"
#include "study/timing/clock_cost.h"
#include "workbench/commands/offline_touch.h"
#include "workbench/commands/stroke_outcome.h"
#include "workbench/editor/texture_saving.h"
#include "workbench/figures/settings_json.h"
#include "workbench/figures/texture_figures.h"
#include "workbench/figures/tick_csv.h"
#include "workbench/figures/tick_statistics.h"
#include "workbench/sound/sounding_hand.h"
#include "workbench/sound/written_sound.h"

#include <algorithm>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

namespace {

constexpr size_t kBlock =
    4096; // ticks computed before they are written, which keeps disk access out of the step's time

/// Sound requires a rate possible for a servo.
void requireSound(const std::filesystem::path& file, const std::vector<PlannedTick>& ticks) {
    for (const PlannedTick& tick : ticks)
        if (!(tick.dt >= WrittenSound::kShortest && tick.dt <= WrittenSound::kLongest))
            throw Error(file.string(), "",
                        "--sound needs ticks of 0.1 to 50 ms, and at t = " + std::to_string(tick.time) +
                            " s one is " + std::to_string(1e3 * tick.dt) + " ms",
                        "resample the path: --rate 1000");
}

/// The ray from proxy to HIP in every contact tick, each timed like the step.
void timeFloorRays(const HapticScene& scene, std::span<const OfflineTick> ticks, Samples& rays) {
    float sum = 0.0f;
    for (const OfflineTick& tick : ticks) {
        if (tick.output.contacts == 0 || tick.output.object < 0)
            continue;
        const long long begin = monotonicNs();
        sum += castFloorRay(scene, tick.output.object, tick.touched, tick.output.proxy, tick.output.hip);
        rays.add(monotonicNs() - begin);
    }
    [[maybe_unused]] static volatile float sink;
    sink = sum; // keeps the compiler from removing the rays
}

/// Breakdown of the time from the program's start to the first tick.
nlohmann::ordered_json loadJson(const std::vector<StageTime>& stages, uint64_t peak) {
    nlohmann::ordered_json json{
        {"s", 0.0}, {"cpu_s", 0.0}, {"peak_bytes", peak}, {"stages", nlohmann::ordered_json::array()}};
    double wall = 0.0, cpu = 0.0;
    for (const StageTime& stage : stages) {
        json["stages"].push_back({{"stage", stage.what}, {"s", stage.wall}, {"cpu_s", stage.cpu}});
        wall += stage.wall;
        cpu += stage.cpu;
    }
    json["s"] = wall;
    json["cpu_s"] = cpu;
    return json;
}

/// Nulls without contact.
nlohmann::ordered_json floorJson(const Samples& rays) {
    nlohmann::ordered_json json{{"count", rays.count()}, {"p50_ns", nullptr}, {"p99_ns", nullptr}};
    if (!rays.empty()) {
        json["p50_ns"] = rays.percentile(0.5);
        json["p99_ns"] = rays.percentile(0.99);
    }
    return json;
}
/// A run of the command: what it touches, the ticks, and what it writes of them.
class TouchRun {
  public:
    /// Loads, and opens what is written to.
    explicit TouchRun(const TouchOptions& options);
    TouchRun(const TouchRun&) = delete;
    TouchRun& operator=(const TouchRun&) = delete;

    void touchAll();
    void report();
    void finish();

  private:
    void load();
    void open();
    void touchBlock(size_t begin, std::span<OfflineTick> block);
    void writeBlock(std::span<const OfflineTick> block);

    const TouchOptions& options_;
    std::optional<HipPath> path_;
    std::optional<StrokePath> stroke_; ///< without a path of the user's
    Model model_;
    std::shared_ptr<const HapticScene> felt_; ///< as the file has it, before anything was sculpted
    std::optional<TouchSculpt> sculpt_;
    std::vector<StageTime> stages_; ///< of loading
    uint64_t peak_ = 0;             ///< bytes, after it

    std::optional<OutputFile> out_, report_;
    std::optional<OfflineRecorder> recorder_;
    std::optional<WrittenSound> sound_;
    std::vector<PlannedTick> planned_;

    std::optional<OfflineTouch> touch_;
    TouchCheckpoint first_;         ///< before the first tick
    std::vector<std::byte> bodies_; ///< likewise
    bool changes_ = false;          ///< what is touched is not the same in all ticks
    uint32_t scene_ = OfflineRecorder::kScene;
    TickStatistics statistics_;
    Samples rays_;
    std::string rows_;
};

TouchRun::TouchRun(const TouchOptions& options) : options_(options) {
    load();
    open();
    touch_.emplace(model_, options_);
    changes_ = touch_->moving() || (sculpt_ && sculpt_->waits());
    first_ = touch_->checkpoint();
    if (recorder_ && sculpt_ && model_.haptic != felt_)
        scene_ = recorder_->sculpted(*sculpt_, 0, first_);
    bodies_ = touch_->bodies();
}

void TouchRun::load() {
    if (!options_.path.empty())
        path_ = readHipPath(options_.path);
    if (path_)
        warnOfSlowPath(*path_, options_);
    StageClock clock;
    model_ = loadModelToTouch(options_.scene, options_.fit, &clock, options_.iso, options_.animation,
                              options_.loose);
    takePart(model_, partNamed(*model_.scene, options_.part));
    printWarnings(model_);
    felt_ = model_.haptic;
    if (!options_.sculpt.empty()) {
        clock.at("sculpting");
        sculpt_.emplace(options_.sculpt, model_.haptic);
        model_.haptic = sculpt_->scene();
    }
    clock.at("preparing for the settings");
    prepareFor(model_, options_.settings);
    clock.at("laying the stroke");
    if (!path_) {
        stroke_ = layStroke(*sceneOf(model_.scene, model_.part), model_.workspaceFromScene, options_.stroke);
        path_ = pathOf(*stroke_, options_);
    }
    stages_ = clock.take();
    peak_ = peakMemory();
}

void TouchRun::open() {
    if (!options_.json.empty())
        model_.haptic->buildRays(); // for the ray floor and the proxy's gap
    out_.emplace(options_.out);
    if (!options_.json.empty())
        report_.emplace(options_.json);
    out_->write(tickCsvHeader(options_.pad));
    if (!options_.record.empty()) {
        Model whole = model_;
        whole.haptic = felt_;
        recorder_.emplace(options_, whole);
    }
    enterFloatMode();
    planned_ = plannedTicks(*path_, options_.path.empty() ? 0.0 : options_.rateHz);
    if (!options_.sound.empty()) {
        requireSound(options_.sound, planned_);
        sound_.emplace(options_.sound);
    }
}

void TouchRun::touchAll() {
    std::vector<OfflineTick> ticks(std::min(kBlock, planned_.size()));
    realtime::resetViolations();
    for (size_t begin = 0; begin < planned_.size(); begin += kBlock) {
        const std::span<OfflineTick> block(ticks.data(), std::min(kBlock, planned_.size() - begin));
        touchBlock(begin, block);
        writeBlock(block);
    }
    if (recorder_)
        recorder_->finish();
}

void TouchRun::touchBlock(size_t begin, std::span<OfflineTick> block) {
    for (size_t i = 0; i < block.size(); ++i) {
        if (sculpt_ && sculpt_->applyUntil(planned_[begin + i].time)) {
            touch_->take(*(model_.haptic = sculpt_->scene()), sculpt_->sculpted());
            if (recorder_)
                scene_ = recorder_->sculpted(*sculpt_, begin + i, touch_->checkpoint());
        }
        OfflineTick& tick = block[i];
        touch_->step(planned_[begin + i], tick);
        tick.scene = scene_;
        if (touch_->textures() != nullptr)
            tick.strokes.assign(touch_->textures()->strokes().begin(), touch_->textures()->strokes().end());
        if (changes_ && report_ && tick.output.contacts > 0)
            tick.gap = proxyGap(touch_->scene(), touch_->objects(), tick.output, options_.settings);
    }
}

void TouchRun::writeBlock(std::span<const OfflineTick> block) {
    if (report_)
        timeFloorRays(*model_.haptic, block, rays_);
    rows_.clear();
    for (const OfflineTick& tick : block) {
        appendTickRow(rows_, tick.time, tick.output, tick.stepNs);
        if (options_.pad)
            appendPadPlace(rows_, tick.sample, tick.output);
        statistics_.add(tick.output, tick.stepNs);
        if (recorder_)
            recorder_->add(tick, first_, bodies_);
        if (sound_)
            sound_->add(soundTick(tick.dt, tick.sample, tick.output.command, tick.impact));
        if (report_ && tick.output.contacts > 0)
            statistics_.addProxyGap(changes_ ? tick.gap
                                             : proxyGap(*model_.haptic, {}, tick.output, options_.settings));
    }
    out_->write(rows_);
    if (recorder_)
        recorder_->flush();
}

void TouchRun::report() {
    if (!report_)
        return;
    const RealtimeViolations violations = realtime::violations();
    const nlohmann::ordered_json json{
        {"command", "touch"},
        {"scene", options_.scene.string()},
        {"path", options_.path.string()},
        {"path_rate_hz", rateOf(*path_)},
        {"stroke",
         options_.path.empty() ? nlohmann::ordered_json(options_.stroke.name) : nlohmann::ordered_json()},
        {"fit", options_.fit == Fit::None ? "none" : "workspace"},
        {"loop", options_.closedLoop ? plantJson(touch_->plant()) : nlohmann::ordered_json("open")},
        {"settings", settingsJson(options_.settings)},
        {"setting_warnings", settingWarnings(*model_.haptic, options_.settings)},
        {"load", loadJson(stages_, peak_)},
        {"ticks", planned_.size()},
        {"step", statistics_.stepJson()},
        {"ray_floor", floorJson(rays_)},
        {"clock_ns", clockCostNs()},
        {"contact", statistics_.contactJson()},
        {"force", statistics_.forceJson()},
        {"energy", statistics_.energyJson()},
        {"flags", statistics_.flagsJson()},
        {"sculpt", sculpt_ ? sculpt_->json() : nlohmann::ordered_json()},
        {"persistent_textures", texturesJson(touch_->scene(), touch_->textures())},
        {"allocations_in_tick", violations.allocations},
        {"deallocations_in_tick", violations.deallocations},
    };
    report_->write(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
    report_->commit();
}

void TouchRun::finish() {
    if (sound_)
        sound_->commit();
    out_->commit();
    if (sculpt_)
        sculpt_->finish(options_.sculpted);
    if (!options_.brushed.empty())
        (void)saveMaterials(
            options_.scene, model_.scene->file,
            withTextures({}, texturesToSave(*model_.scene, touch_->scene(), touch_->textures())),
            options_.brushed);
    std::printf("%zu ticks, %llu in contact, written to %s\n", planned_.size(),
                static_cast<unsigned long long>(statistics_.contactTicks()), options_.out.c_str());
    printCoverage(touch_->scene(), touch_->textures());
    if (stroke_) // a user's path may stay in the air
        requireTouch(options_.scene, options_.stroke, stroke_->period(),
                     path_->times.back() - path_->times.front() + planned_.front().dt,
                     statistics_.contactTicks());
}

} // namespace

int touchCommand(const TouchOptions& options) {
    TouchRun run(options);
    run.touchAll();
    run.report();
    run.finish();
    return 0;
}

} // namespace touchstone
