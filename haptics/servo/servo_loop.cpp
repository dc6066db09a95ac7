#include "haptics/servo/servo_loop.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

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
void refuseStale(DeviceSample& sample, double staleAge) noexcept {
    sample.valid = sample.valid && sample.age <= staleAge; // a NaN age is not fresh
}

} // namespace

struct ServoLoop::Touch {
    const Offer* offer = nullptr;
    uint32_t geometry = 0;                    // of the offer; 0: none
    const HapticSettings* settings = nullptr; // of this tick
    DeviceLimits limits;                      // of the newest offer with a scene
    WorldState world;
    DeviceState device;
    TouchFeedback felt; // of the preceding tick
    std::array<glm::dvec3, 3> planes{};
    bool late = false; // the previous tick ended after its next deadline
    uint64_t nextCheckpoint = 0;
    double previousTime = std::numeric_limits<double>::quiet_NaN(); // of the preceding tick in this scene
    TouchCheckpoint checkpoint;

    void feelFrom(const HapticOutput& output) noexcept {
        planes = output.planes;
        felt = {.touching = output.contacts > 0,
                .hip = output.hip,
                .proxy = output.proxy,
                .force = output.force,
                .planes = {planes.data(), output.planeCount},
                .object = output.object};
    }

    /// The command without contact: the force that the device still holds goes to zero within its limits.
    DeviceCommand restCommand(double dt) noexcept {
        uint32_t flags = 0;
        return ForceLimiter::limit(glm::dvec3(0.0), glm::dvec3(0.0), {.limits = limits, .dt = dt}, {},
                                   device.limiter, flags);
    }
};

ServoLoop::ServoLoop(DevicePort port, const ServoConfig& config)
    : port_(port), config_(config), records_(config.ringCapacity) {
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
    scheduled_.store(false, std::memory_order_relaxed);
    thread_ = std::thread([this] { run(); });
    scheduled_.wait(false, std::memory_order_acquire);
}

void ServoLoop::stop() {
    if (!thread_.joinable())
        return;
    stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
}

uint32_t ServoLoop::offerScene(std::shared_ptr<const HapticScene> scene, ScenePtr source, SceneSwap swap) {
    if (swap == SceneSwap::Anew)
        ++offeredGeometry_;
    if (scene == nullptr) {
        scene_.offer(nullptr);
        return 0;
    }
    MovingObjects moving = source != nullptr ? MovingObjects(std::move(source), *scene) : MovingObjects();
    scene_.offer(std::make_shared<const Offer>(std::move(scene), std::move(moving), ++offeredScenes_,
                                               offeredGeometry_));
    return offeredScenes_;
}

void ServoLoop::setSettings(const HapticSettings& settings) {
    HapticSettings withoutForce = settings;
    withoutForce.forceEnabled = false;
    offeredSettings_.push_back({offeredSettings_.back().number + 1, settings, withoutForce});
    settings_.write(offeredSettings_.back());
}

const HapticSettings& ServoLoop::settingsOf(uint32_t number) const {
    const auto found = std::lower_bound(
        offeredSettings_.begin(), offeredSettings_.end(), number & ~kWithoutForce,
        [](const NumberedSettings& offered, uint32_t wanted) { return offered.number < wanted; });
    const NumberedSettings& offered = found != offeredSettings_.end() ? *found : offeredSettings_.back();
    return (number & kWithoutForce) != 0 ? offered.withoutForce : offered.settings;
}

bool ServoLoop::popRecord(TickRecord& record) {
    if (!records_.pop(record))
        return false;
    while (offeredSettings_.front().number < (record.settings & ~kWithoutForce))
        offeredSettings_.pop_front();
    return true;
}

ServoLoop::Counters ServoLoop::counters() const {
    return {ticks_.load(std::memory_order_relaxed), missed_.load(std::memory_order_relaxed),
            skipped_.load(std::memory_order_relaxed), records_.dropped()};
}

ServoScheduling ServoLoop::scheduling() const {
    return scheduled_.load(std::memory_order_acquire) ? scheduling_ : ServoScheduling{};
}

/// Switches to another scene. The checkpoint taken then drops the candidates, which point into the previous
/// one.
void ServoLoop::adopt(Touch& touch, const Offer* offer) noexcept {
    const uint32_t geometry = offer != nullptr ? offer->geometry : 0;
    const bool goesOn = geometry != 0 && geometry == touch.geometry;
    touch.offer = offer;
    touch.geometry = geometry;
    if (offer != nullptr) {
        offer->moving.forget();
        touch.limits = offer->scene->limits;
    }
    if (goesOn) {
        // As in a replay that resumes here: the objects have their previous poses.
        if (std::isfinite(touch.previousTime))
            (void)offer->moving.at(touch.previousTime);
        return;
    }
    // A new world: forget the proxy, fade the force in, but keep the command that the device still holds.
    touch.world = WorldState{};
    touch.device.forgetTouch();
    touch.device.mustLeave = true;
    touch.felt = TouchFeedback{};
    ForceLimiter::restartRamp(touch.device.limiter);
    touch.previousTime = std::numeric_limits<double>::quiet_NaN();
}

/// Start of a tick: the newest scene and settings, and a checkpoint where one is due.
void ServoLoop::prepare(Touch& touch, TickRecord& record) noexcept {
    settings_.update();
    touch.settings = &settings_.value().settings;
    record.settings = settings_.value().number;
    if (forceSwitch_.off()) {
        touch.settings = &settings_.value().withoutForce;
        record.settings |= kWithoutForce;
    }
    const Offer* offer = scene_.adopt();
    bool due = record.tick >= touch.nextCheckpoint;
    if (offer != touch.offer) {
        adopt(touch, offer);
        due = true;
    }
    record.scene = offer != nullptr ? offer->number : 0;
    record.checkpoint = due || checkpointWanted_.load(std::memory_order_relaxed);
    if (!record.checkpoint)
        return;
    checkpointWanted_.store(false, std::memory_order_relaxed);
    touch.nextCheckpoint =
        record.tick + static_cast<uint64_t>(std::max(1.0, config_.checkpointSeconds * config_.rateHz));
    touch.checkpoint.tick = record.tick;
    touch.checkpoint.scene = record.scene;
    touch.checkpoint.previousTime = touch.previousTime;
    takeCheckpoint(touch.device, touch.checkpoint);
    checkpoints_.push(touch.checkpoint);
}

/// One tick: read, step, write. The times are those of the step alone, as `step_ns` means everywhere.
TickRecord ServoLoop::tick(Touch& touch, uint64_t number, double dt) noexcept {
    TickRecord record;
    record.tick = number;
    record.time = static_cast<double>(number) / config_.rateHz;
    record.dt = dt;
    record.late = touch.late;
    prepare(touch, record);
    const ObjectMotions objects =
        touch.offer != nullptr ? touch.offer->moving.at(record.time) : ObjectMotions();
    if (port_.feel != nullptr) {
        touch.felt.objects = objects;
        port_.feel(port_.context, touch.felt);
    }
    record.sample = port_.sample(port_.context, record.time);
    if (touch.offer != nullptr) {
        refuseStale(record.sample, touch.limits.staleAge);
        TickInput input;
        input.tick = number;
        input.time = record.time;
        input.dt = dt;
        input.late = touch.late;
        input.devices = {&record.sample, 1};
        input.objects = objects;
        StageStopwatch clock;
        StageTracer tracer(touch.device, record.trace, config_.stageTimes ? &clock : nullptr);
        const long long begin = monotonicNs();
        hapticStep(*touch.offer->scene, *touch.settings, input, touch.world, {&touch.device, 1},
                   {&record.output, 1}, tracer);
        record.stepNs = saturated(monotonicNs() - begin);
        std::ranges::transform(clock.nanoseconds, record.stageNs.begin(), saturated);
        touch.previousTime = record.time;
        touch.feelFrom(record.output);
    }
    port_.apply(port_.context, touch.offer != nullptr ? record.output.command : touch.restCommand(dt));
    return record;
}

TickRecord ServoLoop::step(uint64_t number) {
    if (stepped_ == nullptr)
        stepped_ = std::make_unique<Touch>();
    const uint64_t elapsed = number > lastStepped_ ? number - lastStepped_ : 1;
    lastStepped_ = number;
    TickRecord record = tick(*stepped_, number, static_cast<double>(elapsed) / config_.rateHz);
    record.step = ticks_.fetch_add(1, std::memory_order_relaxed);
    records_.push(record);
    snapshot_.write(record);
    return record;
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
    Touch touch;
    uint64_t number = 0, previous = 0;
    while (!stopping_.load(std::memory_order_relaxed)) {
        const long long deadline = start + static_cast<long long>(number) * period;
        sleepUntil(deadline);
        const long long awake = monotonicNs();
        const uint64_t elapsed = number == 0 ? 1 : number - previous;
        previous = number;
        {
            const realtime::TickScope scope;
            TickRecord record = tick(touch, number, static_cast<double>(elapsed) / config_.rateHz);
            const long long done = monotonicNs();
            record.wakeLatencyNs = saturated(awake - deadline);
            record.missed = touch.late = done > deadline + period;
            record.step = ticks_.fetch_add(1, std::memory_order_relaxed);
            if (record.missed)
                missed_.fetch_add(1, std::memory_order_relaxed);
            records_.push(record);
            snapshot_.write(record);

            // The next deadline still ahead: late ticks are dropped, never made up in a burst.
            const auto passed = static_cast<uint64_t>(std::max(0LL, (done - deadline) / period));
            if (passed > 0)
                skipped_.fetch_add(passed, std::memory_order_relaxed);
            number += 1 + passed;
        }
    }
    port_.apply(port_.context, DeviceCommand{});
}

} // namespace touchstone
