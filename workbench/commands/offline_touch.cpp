#include "workbench/commands/offline_touch.h"

#include "engine/core/realtime_guard.h"
#include "haptics/body/body_world.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/scene/scene_programs.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/servo/servo_loop.h"

#include <algorithm>

namespace touchstone {

OfflineTouch::OfflineTouch(const Model& model, const TouchOptions& options)
    : model_(model), settings_(options.settings), touch_(*model.haptic, model.scene),
      yielding_(path_, options.plant), hand_(options.closedLoop ? static_cast<Device&>(yielding_) : path_) {
    if (const auto& bodies = touch_.world.bodies()) {
        controls_ = body::JointSettings(*bodies);
        operate();
    }
}

void OfflineTouch::step(const PlannedTick& planned, OfflineTick& tick) {
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

void OfflineTouch::take(const HapticScene& reshaped, std::span<const int> sculpted) {
    touch_.scene = &reshaped;
    takeUpReshaped(reshaped, objects().empty() ? ObjectMotions(reshaped.restMotions) : objects(), sculpted,
                   touch_.state);
}

TouchCheckpoint OfflineTouch::checkpoint() {
    TouchCheckpoint checkpoint;
    checkpoint.scene = OfflineRecorder::kScene;
    checkpoint.previousTime = previousTime_;
    takeCheckpoint(touch_.state, checkpoint);
    return checkpoint;
}

/// What the hand moves of the scene's controls sets the settings of the next tick.
void OfflineTouch::operate() {
    poses_.clear();
    for (const body::BodyState& state : touch_.world.bodies()->states())
        poses_.push_back(state.pose);
    (void)controls_.apply(poses_, settings_);
}

OfflineRecorder::OfflineRecorder(const TouchOptions& options, const Model& model)
    : writer_(options.record, recordingOrigin("touch", options.rateHz)),
      identity_(identityOf(model, options.fit)), textures_(persistentTextures(*model.haptic)) {}

void OfflineRecorder::add(const OfflineTick& tick, const TouchCheckpoint& first,
                          const std::vector<std::byte>& bodies) {
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

uint32_t OfflineRecorder::sculpted(TouchSculpt& sculpt, uint64_t tick, TouchCheckpoint state) {
    const std::vector<SculptEntry> entries = sculpt.takeEntries();
    journal_.insert(journal_.end(), entries.begin(), entries.end());
    const uint32_t number = kScene + 1 + static_cast<uint32_t>(edits_.size());
    state.tick = tick;
    state.scene = number;
    edits_[number] = {tick, sculpt.hash(), journal_.size(), state};
    return number;
}

} // namespace touchstone
