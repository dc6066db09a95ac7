// A tick of a replay, and what differs from the recorded one.

#include "engine/core/error.h"
#include "haptics/body/body_world.h"
#include "haptics/recording/replayer.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/texture/persistent_textures.h"

#include <algorithm>
#include <optional>
#include <string>

namespace touchstone {

/// True where the tick made the recorded strokes, so that the textures are the recorded ones.
bool Replayer::sameStrokes(const RecordedTick& tick, const PersistentTextures* textures) {
    while (nextStroke_ < strokes_.size() && strokes_[nextStroke_].tick < tick.tick)
        ++nextStroke_;
    const size_t first = nextStroke_;
    while (nextStroke_ < strokes_.size() && strokes_[nextStroke_].tick == tick.tick)
        ++nextStroke_;
    const auto recorded = std::span(strokes_).subspan(first, nextStroke_ - first);
    const std::span<const BrushStroke> made =
        textures != nullptr ? textures->strokes() : std::span<const BrushStroke>();
    return std::ranges::equal(recorded, made, [](BrushStroke a, BrushStroke b) {
        a.tick = b.tick = 0;
        return a == b;
    });
}

/// What every hand feels in the tick: outputs_ and traces_. `touched`: null where there is no scene.
Replayer::FeltTick Replayer::feel(const RecordedTick& tick, const HapticSettings& settings,
                                  Touched* touched) {
    std::ranges::fill(outputs_, HapticOutput{});
    std::ranges::fill(traces_, StageTrace{});
    if (touched == nullptr)
        return {.animated = tick.time};
    const HapticScene& scene = *touched->scene.haptic;
    // Data for the neighbourhood watch and rays became available when built, in the middle of the run.
    if (change_ || !has(tick.flags, TickFlag::NeighbourhoodMissing)) {
        if (settings.contact == ContactMethod::Neighbourhood)
            scene.buildNeighbourhoods();
        if (settings.contact == ContactMethod::Rays)
            scene.buildRays();
    }
    const std::optional<DeviceLimits>& limits = scenes_.at(rootOf(tick.scene)).identity.limits; // of format 1
    for (size_t hand = 0; hand < ticks_.size(); ++hand) {
        samples_[hand] = ticks_[hand].sample;
        if (limits)
            samples_[hand].limits = *limits;
    }
    if (touched->world.bodies() != nullptr)
        if (const auto found = found_.find(tick.tick); found != found_.end())
            touched->world.bodies()->repeat(found->second);
    putDriven(tick, *touched);
    if (touched->world.driven() != nullptr)
        touched->world.driven()->setStep(tick.dt);
    FeltTick felt{.animated = animationTime(settings, tick.time)};
    // A replay has its vertices in time: it stands still where the servo did.
    touched->world.advance(felt.animated, has(tick.flags, TickFlag::DeformationHeld));
    felt.poses = touched->world.poseHash();
    const TickInput input{.tick = tick.tick,
                          .time = tick.time,
                          .dt = tick.dt,
                          .late = tick.late,
                          .hands = samples_,
                          .tool = tool_.active ? &tool_ : nullptr};
    StageTracer tracer(devices_, traces_);
    const long long begin = monotonicNs();
    hapticStep(scene, settings, input, touched->world, devices_, outputs_, tracer);
    felt.texturesEqual = sameStrokes(tick, touched->world.textures().get());
    felt.stepNs = monotonicNs() - begin;
    report_.seconds += report_.replayed > 0 ? tick.dt : 0.0;
    return felt;
}

void Replayer::step(const RecordedTick& tick) {
    const auto settings = settings_.find(tick.settings);
    if (settings == settings_.end())
        throw Error("recording", "tick " + std::to_string(tick.tick), "has settings that are not there",
                    "the file is damaged");
    if (tick.checkpoint) // as the servo did, also where the checkpoint itself was lost
        for (DeviceState& device : devices_)
            device.candidates.invalidate();
    const FeltTick felt = feel(tick, settings->second, touched(tick.scene));
    bool locationsEqual = true;
    for (uint32_t hand = 0; hand < ticks_.size(); ++hand)
        locationsEqual &= sameLocation(hand, ticks_[hand], settings->second);
    previousTime_ = felt.animated;
    ++report_.replayed;
    if (change_) {
        if (each_ != nullptr && *each_)
            (*each_)(tick, outputs_[0], felt.stepNs, false);
        return;
    }
    const bool posesEqual = tick.poses.value_or(felt.poses) == felt.poses;
    if (!posesEqual)
        differs({.tick = tick.tick, .time = tick.time, .stage = "poses"});
    const bool equal = compare(0, tick);
    bool allEqual = equal && posesEqual && felt.texturesEqual && locationsEqual;
    for (uint32_t hand = 1; hand < ticks_.size(); ++hand)
        allEqual &= compare(hand, ticks_[hand]);
    if (!felt.texturesEqual)
        differs({.tick = tick.tick, .time = tick.time, .stage = "textures"});
    report_.differing += allEqual ? 0 : 1;
    if (each_ != nullptr && *each_)
        (*each_)(tick, outputs_[0], felt.stepNs, equal);
}

void Replayer::differs(const Difference& difference) {
    if (!report_.first)
        report_.first = difference;
}

/// Makes the tick's contact location; true where it has the recorded bits, or is none to compare.
bool Replayer::sameLocation(uint32_t hand, const RecordedTick& tick, const HapticSettings& settings) {
    const PadCommand made =
        padStep(samples_[hand], outputs_[hand], settings.forceEnabled, tick.dt, tick.pad.limits, pads_[hand]);
    if (change_ || made.location() == tick.pad.location)
        return true;
    differs({.tick = tick.tick, .time = tick.time, .hand = hand, .stage = "contact location"});
    return false;
}

/// True where every stage of the hand has the recorded bits.
bool Replayer::compare(uint32_t hand, const RecordedTick& tick) {
    const HapticOutput& output = outputs_[hand];
    const StageHashes hashes = stageHashes(traces_[hand], output);
    if (hashes == tick.hashes)
        return true;
    const auto stage = static_cast<size_t>(std::ranges::mismatch(hashes, tick.hashes).in1 - hashes.begin());
    differs({.tick = tick.tick,
             .time = tick.time,
             .hand = hand,
             .stage = std::string(kStageNames[stage]),
             .recordedProxy = tick.proxy,
             .replayedProxy = output.proxy,
             .recordedForce = tick.force,
             .replayedForce = output.force});
    return false;
}

} // namespace touchstone
