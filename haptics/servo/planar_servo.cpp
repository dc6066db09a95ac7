#include "haptics/servo/planar_servo.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"
#include "haptics/safety/force_limiter.h"
#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

bool finite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The turn of the hand's x axis in the plane, rad. An axis that points out of the plane has none.
double pitchOf(const glm::dquat& orientation) {
    const glm::dvec3 axis = orientation * glm::dvec3(1.0, 0.0, 0.0);
    return std::hypot(axis.x, axis.y) > 1e-6 ? std::atan2(axis.y, axis.x) : 0.0;
}

} // namespace

PlanarServo::PlanarServo(DevicePort port, const ServoConfig& config) : port_(port), config_(config) {
    if (port.sample == nullptr || port.apply == nullptr)
        throw Error("servo", "", "the device port is incomplete", "");
    if (!(config.rateHz >= kMinServoRate && config.rateHz <= kMaxServoRate))
        throw Error("servo", "rate", "must be 100..4000 Hz", "1000 suits most devices");
}

PlanarServo::~PlanarServo() {
    stop();
}

void PlanarServo::start() {
    if (thread_.joinable())
        return;
    stopping_.store(false, std::memory_order_relaxed);
    thread_ = std::thread([this] { run(); });
}

void PlanarServo::stop() {
    if (!thread_.joinable())
        return;
    stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
}

uint32_t PlanarServo::offer(std::shared_ptr<const PlanarScene> scene) {
    auto held = std::make_shared<Held>();
    if (scene != nullptr)
        held->offer = std::make_unique<const Offer>(std::move(scene), ++offered_);
    const uint32_t number = held->offer != nullptr ? held->offer->number : 0;
    scene_.offer(std::move(held));
    return number;
}

/// Touch, in the plane and with it.
void PlanarServo::feel(const Offer& offer, const DeviceSample& sample) noexcept {
    const glm::dvec3 hand = sample.inWorkspace();
    now_.pose = {.pad = glm::dvec2(hand),
                 .pitch = pitchOf(sample.mapping.workspaceFromDevice.rotation * sample.orientation)};
    now_.felt = offer.touch.step(now_.pose);
    if (mustLeave_ && !now_.felt.touching)
        mustLeave_ = false;
    if (mustLeave_) {
        now_.felt.touching = false;
        now_.felt.force = glm::dvec2(0.0);
        now_.felt.location = 0.0;
    }
    const double lock = std::clamp(-kPlaneStiffness * hand.z, -kPlaneForce, kPlaneForce);
    now_.force = glm::dvec3(now_.felt.force, lock);
    plane_ = glm::dvec3(now_.felt.normal, 0.0);
    const glm::dvec3 curve(now_.felt.force, 0.0);
    felt_ = {.touching = now_.felt.touching,
             .hip = hand,
             .proxy =
                 hand + (now_.felt.touching ? curve / offer.scene->rendering.stiffness : glm::dvec3(0.0)),
             .force = curve,
             .planes = {&plane_, now_.felt.touching ? size_t{1} : size_t{0}},
             .object = -1,
             .objects = {}};
}

void PlanarServo::makeTick(double dt, bool late) noexcept {
    const uint64_t number = now_.tick + 1;
    now_ = PlanarTick{};
    now_.tick = number;
    now_.dt = dt;
    const Held* const held = scene_.adopt();
    const Offer* const offer = held != nullptr ? held->offer.get() : nullptr;
    now_.scene = offer != nullptr ? offer->number : 0;
    if (now_.scene != adopted_) {
        adopted_ = now_.scene;
        mustLeave_ = true;
        ForceLimiter::restartRamp(limiter_);
    }
    if (port_.feel != nullptr)
        port_.feel(port_.context, felt_);
    DeviceSample sample = port_.sample(port_.context, static_cast<double>(number) / config_.rateHz);
    sample.valid = sample.valid && sample.age <= sample.limits.staleAge && finite(sample.position) &&
                   finite(sample.inWorkspace());
    felt_ = TouchFeedback{};
    // A hand that was away for as long as a full force takes to fade may come back anywhere.
    unsampled_ = sample.valid ? 0.0 : std::min(kForceRampOutTime, unsampled_ + dt);
    if (sample.begins || unsampled_ >= kForceRampOutTime) {
        mustLeave_ = true;
        if (offer != nullptr)
            offer->touch.forget();
    }
    now_.sampled = sample.valid;
    if (offer != nullptr && sample.valid)
        feel(*offer, sample);
    now_.command = ForceLimiter::limit(now_.force, glm::dvec3(0.0),
                                       {.limits = sample.limits,
                                        .dt = dt,
                                        .inputValid = sample.valid,
                                        .sampleAge = sample.age,
                                        .forceEnabled = !forceSwitch_.off(),
                                        .late = late,
                                        .position = sample.position,
                                        .springLength = now_.felt.touching ? now_.felt.depth : 0.0,
                                        .coupling = sample.mapping.coupling},
                                       sample.mapping.workspaceFromDevice, limiter_, now_.flags);
    if (port_.pad != nullptr) {
        const PadLimits limits = port_.pad(port_.context);
        // The pitch alone moves it along; across, the plane has nothing.
        now_.location =
            LocationLimiter::limit({.wanted = {now_.felt.location, 0.0},
                                    .touching = now_.felt.touching,
                                    .forceFelt = isForceFelt(!forceSwitch_.off(), sample.valid, now_.flags),
                                    .limits = limits,
                                    .dt = dt},
                                   location_);
        if (limits.reach > 0.0 && port_.applyPad != nullptr)
            port_.applyPad(port_.context, now_.location);
    }
    port_.apply(port_.context, now_.command);
}

PlanarTick PlanarServo::step() {
    makeTick(1.0 / config_.rateHz, false);
    snapshot_.write(now_);
    return now_;
}

void PlanarServo::run() noexcept {
    enterFloatMode();
    if (config_.wantRealtime)
        (void)enterRealtime();
    const auto period = static_cast<long long>(1e9 / config_.rateHz + 0.5);
    long long deadline = monotonicNs() + period, before = deadline - period;
    bool late = false;
    while (!stopping_.load(std::memory_order_relaxed)) {
        sleepUntil(deadline);
        {
            const realtime::TickScope scope;
            makeTick(1e-9 * static_cast<double>(deadline - before), late);
        }
        before = deadline;
        deadline += period;
        const long long end = monotonicNs();
        late = end > deadline;
        now_.missed = late;
        ticks_.fetch_add(1, std::memory_order_relaxed);
        if (late) {
            missed_.fetch_add(1, std::memory_order_relaxed);
            deadline += (end - deadline) / period * period + period; // no burst
        }
        snapshot_.write(now_);
    }
    port_.apply(port_.context, DeviceCommand{});
}

} // namespace touchstone
