#include "session/control_loop.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/servo/servo_loop.h"

#include <algorithm>

namespace touchstone {

ControlLoop::ControlLoop(Device& device, const ControlConfig& config)
    : device_(device), config_(config), stiffness_(device.limits().recommendedStiffness),
      spring_({.power = config.contactPower, .passivity = config.passivity}) {
    if (!(config.rateHz >= kMinServoRate && config.rateHz <= kMaxServoRate))
        throw Error("control loop", "rate", "must be 100..4000 Hz", "4000 suits most devices");
    seen_.limits = device.limits();
}

ControlLoop::~ControlLoop() {
    stop();
}

void ControlLoop::start() {
    if (thread_.joinable())
        return;
    // A stop sent zero: the force of before, its place and its goals are gone, and what comes fades in.
    followed_ = followed();
    spring_ = ProxySpring({.power = follows() == GoalSource::Servo ? config_.contactPower : config_.goalPower,
                           .passivity = config_.passivity});
    (void)fromServo_.update();
    (void)fromCaller_.update();
    late_ = false;
    stopping_.store(false, std::memory_order_relaxed);
    thread_ = std::thread([this] { run(); });
}

void ControlLoop::stop() {
    if (!thread_.joinable())
        return;
    stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
}

const char* ControlLoop::hear(const ContactGoal& goal) noexcept {
    const char* problem = problemOf(goal);
    if (problem == nullptr)
        fromCaller_.write({goal, followed()});
    return problem;
}

void ControlLoop::follow(GoalSource source) noexcept {
    if (source == follows())
        return;
    // One bit more than the last one: the source alternates.
    follow_.store(followed() + 1, std::memory_order_relaxed);
}

const ControlLoop::State& ControlLoop::state() noexcept {
    states_.update();
    return states_.value();
}

DeviceSample ControlLoop::sample(double) noexcept {
    taken_.update();
    const Taken& taken = taken_.value();
    if (taken.atNs == 0)
        return seen_; // not valid
    seen_ = taken.sample;
    seen_.age += 1e-9 * static_cast<double>(std::max(0LL, monotonicNs() - taken.atNs));
    seen_.begins = taken.begun != begun_; // also where that sample was never seen here
    begun_ = taken.begun;
    return seen_;
}

void ControlLoop::apply(const DeviceCommand& command) noexcept {
    ContactGoal goal;
    goal.stiffness = std::max(1.0, seen_.limits.recommendedStiffness);
    goal.touching = seen_.valid && command.force() != glm::dvec3(0.0);
    goal.proxy = seen_.mapping.workspaceFromDevice.point(seen_.position + command.force() / goal.stiffness);
    fromServo_.write(goal);
}

/// Whom the spring follows, and its newest goal.
void ControlLoop::hearNewest(const DeviceSample& sample) noexcept {
    // The goal first: with it comes whatever `follow` said before it.
    const bool fresh = fromCaller_.update();
    if (const uint32_t now = followed(); now != followed_) {
        followed_ = now;
        spring_.forget(sourceOf(now) == GoalSource::Servo ? config_.contactPower : config_.goalPower);
    }
    const bool caller = sourceOf(followed_) == GoalSource::Caller;
    if (caller ? !fresh || fromCaller_.value().followed != followed_ : !fromServo_.update())
        return;
    ContactGoal goal = caller ? fromCaller_.value().goal : fromServo_.value();
    goal.stiffness = std::min(goal.stiffness, sample.limits.maxStiffness);
    (void)spring_.hear(goal);
}

void ControlLoop::tick(uint64_t number, double dt) noexcept {
    DeviceSample sample = sampleWithLimits(device_, static_cast<double>(number) / config_.rateHz);
    now_.sample = sample;
    now_.atNs = monotonicNs();
    now_.begun += sample.begins ? 1 : 0;
    taken_.write(now_);

    hearNewest(sample);
    if (sourceOf(followed_) == GoalSource::Servo)
        sample.mapping.coupling = 1.0; // the servo has weakened its force by it
    const DeviceCommand command = spring_.step(sample, dt, forceOn_.load(std::memory_order_relaxed), late_);
    device_.apply(command);

    const Similarity& map = sample.mapping.workspaceFromDevice;
    states_.write({.ticks = number + 1,
                   .missed = missed_.load(std::memory_order_relaxed),
                   .holds = spring_.holds(),
                   .hip = sample.inWorkspace(),
                   .end = map.point(spring_.end()),
                   .force = map.rotation * spring_.force(),
                   .command = map.rotation * command.force(),
                   .flags = spring_.flags(),
                   .source = static_cast<int>(sourceOf(followed_))});
}

void ControlLoop::run() noexcept {
    enterFloatMode();
    (void)enterRealtime();
    const auto period = static_cast<long long>(1e9 / config_.rateHz + 0.5);
    const long long start = monotonicNs() + period;
    uint64_t number = 0, previous = 0;
    while (!stopping_.load(std::memory_order_relaxed)) {
        const long long deadline = start + static_cast<long long>(number) * period;
        sleepUntil(deadline);
        const uint64_t elapsed = number == 0 ? 1 : number - previous;
        previous = number;
        const realtime::TickScope scope;
        tick(number, static_cast<double>(elapsed) / config_.rateHz);
        const long long done = monotonicNs();
        late_ = done > deadline + period;
        if (late_)
            missed_.fetch_add(1, std::memory_order_relaxed);
        number += 1 + static_cast<uint64_t>(std::max(0LL, (done - deadline) / period)); // no bursts
    }
    device_.apply(DeviceCommand{});
}

} // namespace touchstone
