#include "haptics/servo/servo_loop.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"
#include "haptics/body/body_world.h"
#include "haptics/servo/servo_touch.h"
#include "haptics/texture/persistent_textures.h"

#include <algorithm>
#include <limits>
#include <string>
#include <utility>

namespace touchstone {

namespace {

int32_t saturated(long long nanoseconds) {
    constexpr long long kMin = std::numeric_limits<int32_t>::min(),
                        kMax = std::numeric_limits<int32_t>::max();
    return static_cast<int32_t>(std::clamp(nanoseconds, kMin, kMax));
}

/// A position older than `staleAge` is unknown. So all stages treat a device that freezes like one that is
/// unplugged: its force fades out, and where it returns after that, touch begins again once it has left the
/// model.
void refuseStale(DeviceSample& sample) noexcept {
    sample.valid = sample.valid && sample.age <= sample.limits.staleAge; // a NaN age is not fresh
}

} // namespace

ServoLoop::ServoLoop(std::vector<DevicePort> ports, const ServoConfig& config)
    : ports_(std::move(ports)), config_(config), records_(config.ringCapacity * ports_.size()),
      checkpoints_(64 * ports_.size()) {
    if (ports_.empty() || ports_.size() > kMaxHands)
        throw Error("servo", "",
                    "is given " + std::to_string(ports_.size()) + " devices; it drives 1 to " +
                        std::to_string(kMaxHands),
                    "");
    for (const DevicePort& port : ports_)
        if (port.sample == nullptr || port.apply == nullptr)
            throw Error("servo", "", "the device port is incomplete", "");
    if (!(config.rateHz >= kMinServoRate && config.rateHz <= kMaxServoRate))
        throw Error("servo", "rate", "must be 100..4000 Hz", "1000 suits most devices");
}

ServoLoop::~ServoLoop() {
    stop();
}

void ServoLoop::start() {
    if (thread_.joinable())
        return;
    stopping_.store(false, std::memory_order_relaxed);
    findsApart_ = true;
    if (newest_.bodies != nullptr)
        newest_.bodies->setFinding(body::BodyWorld::Finding::Apart);
    scheduled_.store(false, std::memory_order_relaxed);
    if (waiting_ != nullptr)
        waiting_->world.publishAhead(animationTime(offeredSettings_.back().settings, 0.0));
    waiting_.reset();
    // Kept before ticks of the last run, whose numbers come again.
    for (auto& [scene, driven] : driven_)
        driven->forgetKept();
    uint64_t tick = 0;
    for (std::vector<std::byte> bytes; popBodyState(tick, bytes);)
        continue;
    thread_ = std::thread([this] { run(); });
    scheduled_.wait(false, std::memory_order_acquire);
}

void ServoLoop::stop() {
    if (!thread_.joinable())
        return;
    stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
}

ServoLoop::Counters ServoLoop::counters() const {
    return {ticks_.load(std::memory_order_relaxed), missed_.load(std::memory_order_relaxed),
            skipped_.load(std::memory_order_relaxed), records_.dropped()};
}

ServoScheduling ServoLoop::scheduling() const {
    return scheduled_.load(std::memory_order_acquire) ? scheduling_ : ServoScheduling{};
}

/// Poses of this tick, then the sample of every hand: one that the program moves follows them.
void ServoLoop::sampleHands(Touch& touch, const TickRecord& record) noexcept {
    const ObjectMotions poses = touch.offer != nullptr
                                    ? touch.offer->world.advance(animationTime(*touch.settings, record.time))
                                    : ObjectMotions();
    for (size_t hand = 0; hand < ports_.size(); ++hand) {
        const DevicePort& port = ports_[hand];
        if (port.feel != nullptr) {
            touch.felt[hand].feedback.objects = poses;
            touch.felt[hand].feedback.animation = animationTime(*touch.settings, record.time);
            port.feel(port.context, touch.felt[hand].feedback);
        }
        touch.samples[hand] = port.sample(port.context, record.time);
        if (touch.offer != nullptr)
            refuseStale(touch.samples[hand]);
    }
}

/// One tick: read, step, write. The times are those of the step alone, as `step_ns` means everywhere.
void ServoLoop::tick(Touch& touch, uint64_t number, double dt) noexcept {
    TickRecord& record = touch.record();
    record = TickRecord{};
    record.tick = number;
    record.time = static_cast<double>(number) / config_.rateHz;
    record.dt = dt;
    record.late = touch.late;
    prepare(touch);
    sampleHands(touch, record);
    if (touch.offer == nullptr) {
        std::ranges::fill(touch.outputs, HapticOutput{});
        std::ranges::fill(touch.traces, StageTrace{});
        impact_.store(0.0, std::memory_order_relaxed);
    } else {
        const TickInput input{.tick = number,
                              .time = record.time,
                              .dt = dt,
                              .late = touch.late,
                              .hands = touch.samples,
                              .tool = touch.tool};
        WorldState& world = touch.offer->world;
        record.poses = world.poseHash();
        record.found = world.foundContacts();
        StageStopwatch clock;
        StageTracer tracer(touch.devices, touch.traces, config_.stageTimes ? &clock : nullptr);
        const long long begin = monotonicNs();
        hapticStep(*touch.offer->scene, *touch.settings, input, world, touch.devices, touch.outputs, tracer);
        record.stepNs = saturated(monotonicNs() - begin);
        std::ranges::transform(clock.nanoseconds, record.stageNs.begin(), saturated);
        touch.previousTime = animationTime(*touch.settings, record.time);
        if (touch.tool != nullptr)
            sculpt(touch, input, world.poses());
        if (world.textures() != nullptr)
            world.textures()->publishStrokes(number);
        if (world.bodies() != nullptr)
            impact_.store(world.bodies()->impact(), std::memory_order_relaxed);
        if (dented_ || touch.offer->scene->plan.deformation)
            publishDents(touch);
    }
    for (size_t hand = 0; hand < ports_.size(); ++hand) {
        if (touch.offer != nullptr)
            touch.feelFrom(hand);
        showLocation(touch, hand, dt);
        ports_[hand].apply(ports_[hand].context, touch.offer != nullptr ? touch.outputs[hand].command
                                                                        : touch.restCommand(hand, dt));
    }
}

/// A hand without a display pays a call.
void ServoLoop::showLocation(Touch& touch, size_t hand, double dt) noexcept {
    const DevicePort& port = ports_[hand];
    if (port.pad == nullptr)
        return;
    PadTick& shown = touch.shown[hand];
    LocationLimiterState& state = touch.pads[hand];
    shown = {.limits = port.pad(port.context), .before = state.last};
    // Also where there is no display: the next one begins in its middle, not where this one was.
    const PadCommand command = padStep(touch.samples[hand], touch.outputs[hand], touch.settings->forceEnabled,
                                       dt, shown.limits, state);
    shown.location = command.location();
    if (shown.limits.reach > 0.0 && port.applyPad != nullptr)
        port.applyPad(port.context, command);
}

/// Also when the scene has become another one, in which nothing gives way.
void ServoLoop::publishDents(const Touch& touch) noexcept {
    HandDents dents{};
    dented_ = false;
    for (size_t hand = 0; hand < touch.devices.size(); ++hand) {
        dents[hand] = touch.devices[hand].dents;
        dented_ = dented_ || dents[hand].any();
    }
    dents_.write(dents);
}

/// What the hands make with their tool, into the journal's ring.
void ServoLoop::sculpt(Touch& touch, const TickInput& input, ObjectMotions poses) noexcept {
    const HapticScene& scene = *touch.offer->scene;
    std::array<SculptEntry, ToolPath::kMost> made;
    for (size_t hand = 0; hand < ports_.size(); ++hand) {
        const bool pressed = touch.tool->held || (touch.samples[hand].buttons & kSculptButton) != 0;
        const size_t count = touch.paths[hand].advance(
            *touch.tool, pressed, scene, poses.empty() ? ObjectMotions(scene.restMotions) : poses, input,
            touch.outputs[hand], made);
        for (size_t i = 0; i < count; ++i) {
            made[i].root = touch.root;
            edits_.push(made[i]);
        }
    }
}

/// The records of the tick to the owner thread.
void ServoLoop::publish(Touch& touch) noexcept {
    TickRecord& record = touch.record();
    record.step = ticks_.fetch_add(1, std::memory_order_relaxed);
    const size_t count = touch.records.size();
    for (size_t i = 0; i < count; ++i) {
        const size_t hand = count - 1 - i;
        TickRecord& own = touch.records[i];
        if (hand > 0)
            own = record;
        own.hand = static_cast<uint32_t>(hand);
        own.sample = touch.samples[hand];
        own.trace = touch.traces[hand];
        own.output = touch.outputs[hand];
        own.pad = touch.shown[hand];
    }
    records_.push(touch.records);
    snapshot_.write(record);
}

TickRecord ServoLoop::step(uint64_t number) {
    if (stepped_ == nullptr)
        stepped_ = std::make_unique<Touch>(ports_.size());
    const uint64_t elapsed = number > lastStepped_ ? number - lastStepped_ : 1;
    lastStepped_ = number;
    tick(*stepped_, number, static_cast<double>(elapsed) / config_.rateHz);
    publish(*stepped_);
    return stepped_->record();
}

void ServoLoop::run() noexcept {
    enterFloatMode();
    if (config_.wantRealtime)
        scheduling_ = enterRealtime();
    else
        scheduling_ = {"normal", false, -1};
    scheduled_.store(true, std::memory_order_release);
    scheduled_.notify_all();

    const auto period = static_cast<long long>(1e9 / config_.rateHz + 0.5);
    const long long start = monotonicNs() + period;
    startedNs_.store(start, std::memory_order_relaxed);
    Touch touch(ports_.size());
    uint64_t number = 0, previous = 0;
    while (!stopping_.load(std::memory_order_relaxed)) {
        const long long deadline = start + static_cast<long long>(number) * period;
        sleepUntil(deadline);
        const long long awake = monotonicNs();
        const uint64_t elapsed = number == 0 ? 1 : number - previous;
        previous = number;
        {
            const realtime::TickScope scope;
            tick(touch, number, static_cast<double>(elapsed) / config_.rateHz);
            const long long done = monotonicNs();
            TickRecord& record = touch.record();
            record.wakeLatencyNs = saturated(awake - deadline);
            record.missed = touch.late = done > deadline + period;
            if (record.missed)
                missed_.fetch_add(1, std::memory_order_relaxed);
            publish(touch);

            // The next deadline still ahead: late ticks are dropped, never made up in a burst.
            const auto passed = static_cast<uint64_t>(std::max(0LL, (done - deadline) / period));
            if (passed > 0)
                skipped_.fetch_add(passed, std::memory_order_relaxed);
            number += 1 + passed;
        }
    }
    for (const DevicePort& port : ports_)
        port.apply(port.context, DeviceCommand{});
}

} // namespace touchstone
