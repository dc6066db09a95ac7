// Offline and deterministic: reads a path of the hand and writes every tick, as fast as possible.

#include "devices/plant/hand_impedance.h"
#include "devices/simulated/replay_device.h"
#include "devices/simulated/told_hand.h"
#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/output_file.h"
#include "engine/core/realtime_guard.h"
#include "haptics/body/body_world.h"
#include "haptics/body/joint_settings.h"
#include "haptics/comparison/comparison_solver.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/query/ray_floor.h"
#include "haptics/recording/recording_writer.h"
#include "haptics/scene/scene_programs.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/servo/servo_loop.h"
#include "haptics/tick/stepped_hand.h"
#include "study/timing/clock_cost.h"
#include "workbench/commands/stroke_outcome.h"
#include "workbench/commands/touch_sculpt.h"
#include "workbench/editor/texture_saving.h"
#include "workbench/figures/settings_json.h"
#include "workbench/figures/texture_figures.h"
#include "workbench/figures/tick_csv.h"
#include "workbench/figures/tick_statistics.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"
#include "workbench/sound/sounding_hand.h"
#include "workbench/sound/written_sound.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

namespace {

constexpr size_t kBlock =
    4096; // ticks computed before they are written, which keeps disk access out of the step's time

struct PlannedTick {
    double time = 0.0; // s, as in the path
    double dt = 0.0;   // s
    glm::dvec3 hip{0.0};
};

struct OfflineTick {
    uint64_t number = 0;
    double time = 0.0, dt = 0.0;
    DeviceSample sample;
    StageTrace trace;
    HapticOutput output;
    uint32_t poses = 0; // WorldState::poseHash
    uint32_t found = 0; // WorldState::foundContacts
    int64_t stepNs = 0;
    Similarity touched;  // workspaceFromObject of the touched object
    double gap = 0.0;    // m, of the proxy; in contact, if a report was requested
    uint32_t scene = 0;  // its number in a recording
    double impact = 0.0; // N s, of bodies that met
    HapticSettings settings;
    std::vector<BrushStroke> strokes;
};

/// A stroke over the model as a path: one period, or the given duration.
HipPath pathOf(const StrokePath& stroke, const TouchOptions& options) {
    const double rate = options.rateHz > 0.0 ? options.rateHz : 1000.0;
    const double seconds = options.seconds > 0.0 ? options.seconds : stroke.period();
    HipPath path;
    const auto count = static_cast<size_t>(std::floor(seconds * rate * (1.0 + 1e-12))) + 1;
    for (size_t i = 0; i < count; ++i) {
        path.times.push_back(static_cast<double>(i) / rate);
        path.positions.push_back(stroke.positionIn(path.times.back(), path.times.back()));
    }
    return path;
}

/// Rows a second of a path: of the median interval. 0 for a single row.
double rateOf(const HipPath& path) {
    std::vector<double> intervals;
    for (size_t i = 1; i < path.times.size(); ++i)
        intervals.push_back(path.times[i] - path.times[i - 1]);
    if (intervals.empty())
        return 0.0;
    const auto middle = intervals.begin() + static_cast<ptrdiff_t>(intervals.size() / 2);
    std::ranges::nth_element(intervals, middle);
    return 1.0 / *middle;
}

/// Largest step from row to row, m, and largest change of velocity at a row, m/s.
struct RowJumps {
    double place = 0.0, velocity = 0.0;
};
RowJumps jumpsOf(const HipPath& path) {
    RowJumps jumps;
    glm::dvec3 before(0.0);
    for (size_t i = 1; i < path.times.size(); ++i) {
        const glm::dvec3 way = path.positions[i] - path.positions[i - 1];
        const glm::dvec3 velocity = way / (path.times[i] - path.times[i - 1]);
        jumps.place = std::max(jumps.place, glm::length(way));
        jumps.velocity = std::max(jumps.velocity, glm::distance(velocity, before));
        before = velocity;
    }
    return jumps;
}

/// A path with fewer rows a second than the slowest servo has ticks is no motion of a hand that a tick could
/// follow.
void warnOfSlowPath(const HipPath& path, const TouchOptions& options) {
    const double rate = rateOf(path);
    if (!(rate > 0.0) || rate >= kMinServoRate * (1.0 - 1e-9))
        return;
    const RowJumps jumps = jumpsOf(path);
    std::fprintf(stderr, "touchstone: warning: %s: has %.3g rows a second: ", options.path.c_str(), rate);
    if (options.rateHz > 0.0)
        std::fprintf(
            stderr,
            "between two rows the hand goes straight at one speed, and at each row its velocity jumps, by up "
            "to %.3g m/s\n",
            jumps.velocity);
    else
        std::fprintf(stderr,
                     "a tick lasts from row to row, %.3g ms, and the hand jumps, by up to %.3g mm at once\n",
                     1e3 / rate, 1e3 * jumps.place);
    std::fprintf(stderr, "  remedy: record the path at 1000 Hz, and at %.0f Hz at least%s\n", kMinServoRate,
                 options.rateHz > 0.0 ? "" : "; --rate 1000 puts ticks on straight lines between its rows");
}

/// The ticks of the path: one per row, or at a fixed rate with linear interpolation.
std::vector<PlannedTick> plannedTicks(const HipPath& path, double rateHz) {
    std::vector<PlannedTick> ticks;
    if (rateHz <= 0.0) {
        ticks.resize(path.times.size());
        for (size_t i = 0; i < ticks.size(); ++i) {
            ticks[i].time = path.times[i];
            ticks[i].hip = path.positions[i];
            if (i > 0)
                ticks[i].dt = path.times[i] - path.times[i - 1];
        }
        ticks[0].dt = ticks.size() > 1 ? ticks[1].dt : 1e-3;
        return ticks;
    }
    ReplayDevice replay(path);
    const auto count = static_cast<size_t>(std::floor(replay.duration() * rateHz * (1.0 + 1e-12))) + 1;
    ticks.resize(count);
    for (size_t i = 0; i < count; ++i) {
        const double since = static_cast<double>(i) / rateHz;
        ticks[i].time = path.times.front() + since;
        ticks[i].dt = 1.0 / rateHz;
        ticks[i].hip = replay.sample(since).position;
    }
    return ticks;
}

/// Sound requires a rate possible for a servo.
void requireSound(const std::filesystem::path& file, const std::vector<PlannedTick>& ticks) {
    for (const PlannedTick& tick : ticks)
        if (!(tick.dt >= WrittenSound::kShortest && tick.dt <= WrittenSound::kLongest))
            throw Error(file.string(), "",
                        "--sound needs ticks of 0.1 to 50 ms, and at t = " + std::to_string(tick.time) +
                            " s one is " + std::to_string(1e3 * tick.dt) + " ms",
                        "resample the path: --rate 1000");
}

/// `--record`: the state before the first tick, then every tick.
class OfflineRecorder {
  public:
    static constexpr uint32_t kScene = 1;

    OfflineRecorder(const TouchOptions& options, const Model& model)
        : writer_(options.record, recordingOrigin("touch", options.rateHz)),
          identity_(identityOf(model, options.fit)), textures_(persistentTextures(*model.haptic)) {}

    void add(const OfflineTick& tick, const TouchCheckpoint& first, const std::vector<std::byte>& bodies) {
        TickRecord record;
        record.tick = tick.number;
        record.time = tick.time;
        record.dt = tick.dt;
        record.stepNs = static_cast<int32_t>(std::min<int64_t>(tick.stepNs, INT32_MAX));
        const auto edit = edits_.find(tick.scene);
        const bool edited = edit != edits_.end();
        const bool begins = edited && edit->second.tick == tick.number;
        record.checkpoint = tick.number == 0 || begins;
        SculptToRecord sculpt;
        if (edited)
            sculpt = {kScene, edit->second.hash, std::span(journal_).first(edit->second.entries)};
        record.scene = tick.scene;
        record.root = kScene;
        record.poses = tick.poses;
        record.found = tick.found;
        record.sample = tick.sample;
        record.trace = tick.trace;
        record.output = tick.output;
        writer_.add({.tick = recordedTick(record),
                     .settings = tick.settings,
                     .scene = &identity_,
                     .checkpoint = begins              ? &edit->second.state
                                   : record.checkpoint ? &first
                                                       : nullptr,
                     .sculpt = edited ? &sculpt : nullptr,
                     .bodies = bodies.empty() || !record.checkpoint ? nullptr : &bodies,
                     .textures = textures_.get(),
                     .strokes = tick.strokes});
        if (textures_ != nullptr)
            textures_->apply(tick.strokes);
    }
    /// The scene that the journal makes before `tick`, with the hand's state there. Returns its number.
    uint32_t sculpted(TouchSculpt& sculpt, uint64_t tick, TouchCheckpoint state) {
        const std::vector<SculptEntry> entries = sculpt.takeEntries();
        journal_.insert(journal_.end(), entries.begin(), entries.end());
        const uint32_t number = kScene + 1 + static_cast<uint32_t>(edits_.size());
        state.tick = tick;
        state.scene = number;
        edits_[number] = {tick, sculpt.hash(), journal_.size(), state};
        return number;
    }
    void flush() { writer_.flush(); }
    void finish() { writer_.finish(); }

  private:
    RecordingWriter writer_;
    struct Edit {
        uint64_t tick = 0; // its first
        uint64_t hash = 0;
        size_t entries = 0; // of the journal
        TouchCheckpoint state;
    };
    SceneIdentity identity_;
    std::shared_ptr<PersistentTextures> textures_; // before the next tick
    std::vector<SculptEntry> journal_;
    std::map<uint32_t, Edit> edits_; // by the scene's number
};

/// State of an offline run.
class OfflineTouch {
  public:
    OfflineTouch(const Model& model, const TouchOptions& options)
        : model_(model), settings_(options.settings), touch_(*model.haptic, model.scene),
          yielding_(path_, options.plant),
          hand_(options.closedLoop ? static_cast<Device&>(yielding_) : path_) {
        if (const auto& bodies = touch_.world.bodies()) {
            controls_ = body::JointSettings(*bodies);
            operate();
        }
    }

    void step(const PlannedTick& planned, OfflineTick& tick) {
        path_.next.position = planned.hip;
        path_.next.valid = true;
        touch_.advance(planned.time, settings_);
        tick.sample = sampleWithLimits(hand_, planned.time);
        tick.number = touch_.number;
        tick.settings = settings_;
        tick.time = planned.time;
        tick.dt = planned.dt;
        tick.poses = touch_.world.poseHash();
        tick.found = touch_.world.foundContacts();
        StageTracer tracer(touch_.state, tick.trace);
        const realtime::TickScope scope;
        const long long begin = monotonicNs();
        (void)touch_.step(settings_, tick.sample, planned.dt, tracer);
        tick.stepNs = monotonicNs() - begin;
        previousTime_ = planned.time;
        if (const auto& bodies = touch_.world.bodies())
            tick.impact = bodies->impact();
        if (!controls_.empty())
            operate();
        tick.output = touch_.output;
        hand_.apply(tick.output.command);
        if (tick.output.object >= 0)
            tick.touched = (objects().empty() ? ObjectMotions(model_.haptic->restMotions)
                                              : objects())[static_cast<size_t>(tick.output.object)]
                               .workspaceFromObject;
    }
    /// Between two ticks: the same objects, some of which have been sculpted. The scene outlives it.
    void take(const HapticScene& reshaped, std::span<const int> sculpted) {
        touch_.scene = &reshaped;
        takeUpReshaped(reshaped, objects().empty() ? ObjectMotions(reshaped.restMotions) : objects(),
                       sculpted, touch_.state);
    }
    [[nodiscard]] bool moving() const { return touch_.world.moving(); }
    /// Between two steps at which the triangles near the hand were dropped.
    [[nodiscard]] TouchCheckpoint checkpoint() {
        TouchCheckpoint checkpoint;
        checkpoint.scene = OfflineRecorder::kScene;
        checkpoint.previousTime = previousTime_;
        takeCheckpoint(touch_.state, checkpoint);
        return checkpoint;
    }
    /// Before the first step: the state of the bodies; empty where there are none.
    [[nodiscard]] std::vector<std::byte> bodies() const { return touch_.world.bodyState(); }
    /// After the last step.
    [[nodiscard]] ObjectMotions objects() const { return touch_.world.poses(); }
    [[nodiscard]] const HapticScene& scene() const { return touch_.world.touched(*model_.haptic); }
    [[nodiscard]] const Plant& plant() const { return yielding_.plant(); }
    /// Null: the scene has none.
    [[nodiscard]] const PersistentTextures* textures() const { return touch_.world.textures().get(); }

  private:
    /// What the hand moves of the scene's controls sets the settings of the next tick.
    void operate() {
        poses_.clear();
        for (const body::BodyState& state : touch_.world.bodies()->states())
            poses_.push_back(state.pose);
        (void)controls_.apply(poses_, settings_);
    }

    const Model& model_;
    HapticSettings settings_;
    SteppedHand touch_;
    body::JointSettings controls_;
    std::vector<body::Pose> poses_;                                  // of `operate`
    double previousTime_ = std::numeric_limits<double>::quiet_NaN(); // s, of the last step
    ToldHand path_;                                                  // the path's place in the next tick
    HandImpedance yielding_;                                         // in the closed loop
    Device& hand_;
};

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

} // namespace

int touchCommand(const TouchOptions& options) {
    std::optional<HipPath> path;
    if (!options.path.empty())
        path = readHipPath(options.path);
    if (path)
        warnOfSlowPath(*path, options);
    StageClock clock;
    Model model =
        loadModelToTouch(options.scene, options.fit, &clock, options.iso, options.animation, options.loose);
    takePart(model, partNamed(*model.scene, options.part));
    printWarnings(model);
    const std::shared_ptr<const HapticScene> felt = model.haptic;
    std::optional<TouchSculpt> sculpt;
    if (!options.sculpt.empty()) {
        clock.at("sculpting");
        sculpt.emplace(options.sculpt, model.haptic);
        model.haptic = sculpt->scene();
    }
    clock.at("preparing for the settings");
    prepareFor(model, options.settings);
    clock.at("laying the stroke");
    std::optional<StrokePath> stroke;
    if (!path) {
        stroke = layStroke(*sceneOf(model.scene, model.part), model.workspaceFromScene, options.stroke);
        path = pathOf(*stroke, options);
    }
    const std::vector<StageTime> stages = clock.take();
    const uint64_t peak = peakMemory();
    if (!options.json.empty())
        model.haptic->buildRays(); // for the ray floor and the proxy's gap
    OutputFile out(options.out);
    std::optional<OutputFile> report;
    if (!options.json.empty())
        report.emplace(options.json);
    out.write(tickCsvHeader(options.pad));
    std::optional<OfflineRecorder> recorder;
    if (!options.record.empty()) {
        Model whole = model; // as its file is, before anything was sculpted
        whole.haptic = felt;
        recorder.emplace(options, whole);
    }
    enterFloatMode();
    const std::vector<PlannedTick> planned = plannedTicks(*path, options.path.empty() ? 0.0 : options.rateHz);
    std::optional<WrittenSound> sound;
    if (!options.sound.empty()) {
        requireSound(options.sound, planned);
        sound.emplace(options.sound);
    }

    OfflineTouch touch(model, options);
    const bool changes = touch.moving() || (sculpt && sculpt->waits());
    const TouchCheckpoint first = touch.checkpoint();
    uint32_t scene = OfflineRecorder::kScene;
    if (recorder && sculpt && model.haptic != felt)
        scene = recorder->sculpted(*sculpt, 0, first);
    const std::vector<std::byte> bodies = touch.bodies();
    TickStatistics statistics;
    Samples rays;
    std::string rows;
    std::vector<OfflineTick> ticks(std::min(kBlock, planned.size()));
    realtime::resetViolations();
    for (size_t begin = 0; begin < planned.size(); begin += kBlock) {
        const std::span<OfflineTick> block(ticks.data(), std::min(kBlock, planned.size() - begin));
        for (size_t i = 0; i < block.size(); ++i) {
            if (sculpt && sculpt->applyUntil(planned[begin + i].time)) {
                touch.take(*(model.haptic = sculpt->scene()), sculpt->sculpted());
                if (recorder)
                    scene = recorder->sculpted(*sculpt, begin + i, touch.checkpoint());
            }
            touch.step(planned[begin + i], block[i]);
            block[i].scene = scene;
            if (touch.textures() != nullptr)
                block[i].strokes.assign(touch.textures()->strokes().begin(),
                                        touch.textures()->strokes().end());
            if (changes && report && block[i].output.contacts > 0)
                block[i].gap = proxyGap(touch.scene(), touch.objects(), block[i].output, options.settings);
        }
        if (report)
            timeFloorRays(*model.haptic, block, rays);
        rows.clear();
        for (const OfflineTick& tick : block) {
            appendTickRow(rows, tick.time, tick.output, tick.stepNs);
            if (options.pad)
                appendPadPlace(rows, tick.sample, tick.output);
            statistics.add(tick.output, tick.stepNs);
            if (recorder)
                recorder->add(tick, first, bodies);
            if (sound)
                sound->add(soundTick(tick.dt, tick.sample, tick.output.command, tick.impact));
            if (report && tick.output.contacts > 0)
                statistics.addProxyGap(changes ? tick.gap
                                               : proxyGap(*model.haptic, {}, tick.output, options.settings));
        }
        out.write(rows);
        if (recorder)
            recorder->flush();
    }
    if (recorder)
        recorder->finish();

    if (report) {
        const RealtimeViolations violations = realtime::violations();
        const nlohmann::ordered_json json{
            {"command", "touch"},
            {"scene", options.scene.string()},
            {"path", options.path.string()},
            {"path_rate_hz", rateOf(*path)},
            {"stroke",
             options.path.empty() ? nlohmann::ordered_json(options.stroke.name) : nlohmann::ordered_json()},
            {"fit", options.fit == Fit::None ? "none" : "workspace"},
            {"loop", options.closedLoop ? plantJson(touch.plant()) : nlohmann::ordered_json("open")},
            {"settings", settingsJson(options.settings)},
            {"setting_warnings", settingWarnings(*model.haptic, options.settings)},
            {"load", loadJson(stages, peak)},
            {"ticks", planned.size()},
            {"step", statistics.stepJson()},
            {"ray_floor", floorJson(rays)},
            {"clock_ns", clockCostNs()},
            {"contact", statistics.contactJson()},
            {"force", statistics.forceJson()},
            {"energy", statistics.energyJson()},
            {"flags", statistics.flagsJson()},
            {"sculpt", sculpt ? sculpt->json() : nlohmann::ordered_json()},
            {"persistent_textures", texturesJson(touch.scene(), touch.textures())},
            {"allocations_in_tick", violations.allocations},
            {"deallocations_in_tick", violations.deallocations},
        };
        report->write(json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
        report->commit();
    }
    if (sound)
        sound->commit();
    out.commit();
    if (sculpt)
        sculpt->finish(options.sculpted);
    if (!options.brushed.empty())
        (void)saveMaterials(options.scene, model.scene->file,
                            withTextures({}, texturesToSave(*model.scene, touch.scene(), touch.textures())),
                            options.brushed);
    std::printf("%zu ticks, %llu in contact, written to %s\n", planned.size(),
                static_cast<unsigned long long>(statistics.contactTicks()), options.out.c_str());
    printCoverage(touch.scene(), touch.textures());
    if (stroke) // a user's path may stay in the air
        requireTouch(options.scene, options.stroke, stroke->period(),
                     path->times.back() - path->times.front() + planned.front().dt,
                     statistics.contactTicks());
    return 0;
}

} // namespace touchstone
