#include "haptics/recording/replayer.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "haptics/servo/realtime_thread.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

ReplayReport Replayer::replay(RecordingReader& reader, const Each& each) {
    begin(each);
    while (const std::optional<RecordingReader::Item> item = reader.next())
        take(*item);
    report_.damage = reader.damage();
    report_.cutOff = reader.cutOff();
    if (report_.ticks > 0 && report_.replayed == 0 && report_.gaps == 0)
        throw Error("recording", "", "no tick can be replayed: no state to begin with fits this build",
                    "use the build that recorded it (" + report_.origin.version + ", " +
                        report_.origin.build + ")");
    return std::move(report_);
}

void Replayer::begin(const Each& each) {
    enterFloatMode();
    report_ = ReplayReport{};
    each_ = &each;
    lose();
}

void Replayer::take(const RecordingReader::Item& item) {
    if (item.damageBefore) {
        ++report_.gaps;
        lose();
    }
    std::visit([this](const auto& value) { take(value); }, item.item);
}

void Replayer::take(const RecordingOrigin& origin) {
    if (report_.origin.version.empty())
        report_.origin = origin;
}

void Replayer::take(const RecordedScene& scene) {
    scenes_[scene.number] = scene;
}

void Replayer::take(const RecordedSettings& settings) {
    settings_[settings.number] = settings.settings;
}

void Replayer::take(const TouchCheckpoint& checkpoint) {
    checkpoint_ = checkpoint;
}

void Replayer::take(const RecordedLoss& loss) {
    report_.lost += loss.ticks;
    ++report_.gaps;
    lose();
}

void Replayer::take(const RecordedNote& note) {
    report_.notes.push_back(note);
}

void Replayer::take(const RecordedTicks& ticks) {
    for (const RecordedTick& tick : ticks.ticks) {
        ++report_.ticks;
        if (checkpoint_ && checkpoint_->tick == tick.tick && checkpoint_->scene == tick.scene)
            resume(tick);
        else if (tick.scene != scene_)
            lose();
        checkpoint_.reset();
        if (known_)
            step(tick);
    }
}

/// The state is unknown from here to the next checkpoint.
void Replayer::lose() {
    known_ = false;
    checkpoint_.reset();
}

/// The scene with this number, loaded on first use; null for none.
Replayer::Touched* Replayer::touched(uint32_t number) {
    if (number == 0)
        return nullptr;
    std::unique_ptr<Touched>& entry = loaded_[number];
    if (entry == nullptr) {
        const auto scene = scenes_.find(number);
        if (scene == scenes_.end())
            throw Error("recording", "", "touches a scene that it does not name", "the file is damaged");
        entry = std::make_unique<Touched>();
        entry->scene = load_(scene->second);
        if (entry->scene.source != nullptr)
            entry->moving = MovingObjects(entry->scene.source, *entry->scene.haptic);
    }
    return entry.get();
}

/// Restores the state of the checkpoint before `tick`.
void Replayer::resume(const RecordedTick& tick) {
    Touched* const touched = this->touched(tick.scene);
    const HapticScene* const scene = touched != nullptr ? touched->scene.haptic.get() : nullptr;
    const double came = checkpoint_->previousTime;
    // Without a gap before it, it must equal the state after the preceding ticks.
    const bool goesOn = known_ && scene_ == tick.scene && came == previousTime_;
    if (goesOn) {
        TouchCheckpoint own;
        takeCheckpoint(device_, own);
        if (!report_.first && !std::ranges::equal(own.state(), checkpoint_->state()))
            report_.first = Difference{.tick = tick.tick, .time = tick.time, .stage = "state"};
    }
    known_ = restoreCheckpoint(checkpoint_->state(), scene, device_);
    scene_ = tick.scene;
    if (!known_ || touched == nullptr)
        return;
    if (device_.watch.touching)
        scene->buildNeighbourhoods();
    if (goesOn)
        return;
    touched->moving.forget();
    if (std::isfinite(came))
        (void)touched->moving.at(came);
}

void Replayer::step(const RecordedTick& tick) {
    const auto settings = settings_.find(tick.settings);
    if (settings == settings_.end())
        throw Error("recording", "tick " + std::to_string(tick.tick), "has settings that are not there",
                    "the file is damaged");
    if (tick.checkpoint)
        device_.candidates.invalidate(); // as the servo did, also where the checkpoint itself was lost
    HapticOutput output;
    StageTrace trace;
    int64_t stepNs = 0;
    if (Touched* const touched = this->touched(tick.scene)) {
        const HapticScene& scene = *touched->scene.haptic;
        // Data for the neighbourhood watch and rays became available when built, in the middle of the run.
        if (!has(tick.flags, TickFlag::NeighbourhoodMissing)) {
            if (settings->second.contact == ContactMethod::Neighbourhood)
                scene.buildNeighbourhoods();
            if (settings->second.contact == ContactMethod::Rays)
                scene.buildRays();
        }
        TickInput input;
        input.tick = tick.tick;
        input.time = tick.time;
        input.dt = tick.dt;
        input.late = tick.late;
        input.devices = {&tick.sample, 1};
        input.objects = touched->moving.at(tick.time);
        StageTracer tracer(device_, trace);
        const long long begin = monotonicNs();
        hapticStep(scene, settings->second, input, world_, {&device_, 1}, {&output, 1}, tracer);
        stepNs = monotonicNs() - begin;
        report_.seconds += report_.replayed > 0 ? tick.dt : 0.0;
    }
    previousTime_ = tick.time;
    compare(tick, trace, output, stepNs);
}

void Replayer::compare(const RecordedTick& tick, const StageTrace& trace, const HapticOutput& output,
                       int64_t stepNs) {
    ++report_.replayed;
    const StageHashes hashes = stageHashes(trace, output);
    const bool equal = hashes == tick.hashes;
    if (!equal) {
        ++report_.differing;
        const auto stage =
            static_cast<size_t>(std::ranges::mismatch(hashes, tick.hashes).in1 - hashes.begin());
        if (!report_.first)
            report_.first = Difference{.tick = tick.tick,
                                       .time = tick.time,
                                       .stage = std::string(kStageNames[stage]),
                                       .recordedProxy = tick.proxy,
                                       .replayedProxy = output.proxy,
                                       .recordedForce = tick.force,
                                       .replayedForce = output.force};
    }
    if (each_ != nullptr && *each_)
        (*each_)(tick, output, stepNs, equal);
}

} // namespace touchstone
