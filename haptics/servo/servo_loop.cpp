#include "haptics/servo/servo_loop.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"

#include <algorithm>
#include <limits>
#include <string>

namespace touchstone {

namespace {

int32_t saturated(long long nanoseconds) {
    constexpr long long kLeast = std::numeric_limits<int32_t>::min(),
                        kMost = std::numeric_limits<int32_t>::max();
    return static_cast<int32_t>(std::clamp(nanoseconds, kLeast, kMost));
}

} // namespace

struct ServoLoop::Touch {
    const Offer* offer = nullptr;
    WorldState world;
    DeviceState device;
    bool late = false; // the previous tick ended after its next deadline
};

ServoLoop::ServoLoop(DevicePort port, const ServoConfig& config)
    : port_(port), config_(config), records_(config.ringCapacity) {
    if (port.sample == nullptr || port.apply == nullptr)
        throw Error("servo", "", "the device port is incomplete", "");
    if (!(config.rateHz >= kLeastServoRate && config.rateHz <= kMostServoRate))
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

void ServoLoop::offerScene(std::shared_ptr<const HapticScene> scene, ScenePtr source) {
    if (scene == nullptr) {
        scene_.offer(nullptr);
        return;
    }
    MovingObjects moving = source != nullptr ? MovingObjects(std::move(source), *scene) : MovingObjects();
    scene_.offer(std::make_shared<const Offer>(std::move(scene), std::move(moving)));
}

ServoLoop::Counters ServoLoop::counters() const {
    return {ticks_.load(std::memory_order_relaxed), missed_.load(std::memory_order_relaxed),
            skipped_.load(std::memory_order_relaxed), records_.dropped()};
}

ServoScheduling ServoLoop::scheduling() const {
    return scheduled_.load(std::memory_order_acquire) ? scheduling_ : ServoScheduling{};
}

/// One tick's work: read, step, write. Times are of the step alone, which is what `step_ns` means everywhere.
TickRecord ServoLoop::tick(Touch& touch, uint64_t number, double dt) noexcept {
    TickRecord record;
    record.tick = number;
    record.time = static_cast<double>(number) / config_.rateHz;
    settings_.update();
    const Offer* offer = scene_.adopt();
    if (offer != touch.offer) {
        // A new world: forget the proxy, fade the force in, but remember what the device still holds.
        touch.offer = offer;
        touch.world = WorldState{};
        touch.device.forgetTouch();
        ForceLimiter::restartRamp(touch.device.limiter);
    }
    const DeviceSample sample = port_.sample(port_.context, record.time);
    if (offer != nullptr) {
        TickInput input;
        input.tick = number;
        input.time = record.time;
        input.dt = dt;
        input.late = touch.late;
        input.devices = {&sample, 1};
        input.objects = offer->moving.at(record.time);
        NoStopwatch none;
        const long long begin = monotonicNs();
        hapticStep(*offer->scene, settings_.value(), input, touch.world, {&touch.device, 1},
                   {&record.output, 1}, none);
        record.stepNs = saturated(monotonicNs() - begin);
    }
    port_.apply(port_.context, record.output.command);
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

            // The next deadline that is still ahead: late ticks are dropped, never made up for in a bunch.
            const auto passed = static_cast<uint64_t>(std::max(0LL, (done - deadline) / period));
            if (passed > 0)
                skipped_.fetch_add(passed, std::memory_order_relaxed);
            number += 1 + passed;
        }
    }
    port_.apply(port_.context, DeviceCommand{});
}

} // namespace touchstone
