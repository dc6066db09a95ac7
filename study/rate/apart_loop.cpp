#include "study/rate/apart_loop.h"

#include "engine/core/float_mode.h"
#include "study/rate/closed_loop.h"
#include "study/rate/rate_ablation.h"

#include <algorithm>
#include <cmath>

namespace touchstone::study {

namespace {

/// Of the depth its range, of the speed aside its largest: the wall may have been met deeper than it lies.
struct Swing {
    double low = INFINITY, high = -INFINITY, aside = 0.0;
    void take(const Plant& plant) {
        low = std::min(low, plant.position().y);
        high = std::max(high, plant.position().y);
        aside = std::max(aside, std::abs(plant.velocity().x));
    }
};

double stiffestApart(ApartOptions options) {
    const PlantParameters device = pressingDevice();
    const double bound = stiffnessBound(device, options.controlHz);
    double low = bound / 256.0, high = 2.0 * bound;
    const auto stable = [&](double stiffness) {
        options.stiffness = stiffness;
        return apartSettles(device, options, 3.0);
    };
    if (!stable(low))
        return 0.0;
    // From below: beyond the first that fails, single ones may do.
    constexpr double kStep = 1.2;
    double failing = low;
    while (failing < high && stable(failing)) {
        low = failing;
        failing *= kStep;
    }
    while (failing - low > 1e-3 * low) {
        const double middle = std::sqrt(low * failing);
        (stable(middle) ? low : failing) = middle;
    }
    return low;
}

double dragOf(ApartOptions options) {
    constexpr double kSpeed = 0.1, kDepth = 1e-3, kSeconds = 1.0;
    options.stiffness = 600.0;
    PlantParameters rail; // follows its intention whatever pulls at it
    rail.handStiffness = 1e5;
    rail.handMass = 2.0;
    rail.handDamping = 900.0;
    rail.resolution = 0.0;
    ApartLoop loop(pressedPlane(), frictionlessWall(options.stiffness), rail, options, noLimits());
    const glm::dvec3 begin{-0.05, -kDepth, 0.017};
    loop.intention = [=](double time) { return begin + glm::dvec3(kSpeed * time, 0, 0); };
    loop.hold(begin + glm::dvec3(0, 2.0 * kDepth, 0), begin);
    loop.release(begin, {kSpeed, 0, 0});
    double drag = 0.0;
    const auto ticks = static_cast<int>(kSeconds * options.controlHz);
    for (int i = 0; i < ticks; ++i) {
        loop.tick();
        drag -= loop.spring().force().x;
    }
    return drag / ticks;
}

} // namespace

ApartLoop::ApartLoop(const HapticScene& scene, const HapticSettings& settings, const PlantParameters& plant,
                     const ApartOptions& options, const DeviceLimits& limits)
    : contact_(scene), settings_(settings), options_(options), limits_(limits), spring_(options.spring),
      hand_(target_, plant) {}

/// One tick of the control loop, with contact where it is due. Returns the command.
glm::dvec3 ApartLoop::step(const glm::dvec3& position) {
    DeviceSample sample = sampleAt(position);
    sample.limits = limits_;
    const double dt = 1.0 / options_.controlHz;
    if (steps_++ % static_cast<uint64_t>(options_.controlTicks) == 0) {
        NoStopwatch none;
        const HapticOutput& felt = contact_.step(settings_, sample, dt * options_.controlTicks, none);
        const bool lost = std::generate_canonical<double, 32>(random_) < options_.lost;
        if (!lost && !underWay_) {
            underWay_ = {.touching = felt.contacts > 0,
                         .proxy = felt.proxy,
                         .stiffness = options_.stiffness,
                         .damping = options_.damping,
                         .planes = felt.planes,
                         .planeCount = options_.planes ? felt.planeCount : 0};
            arrives_ = options_.late;
        }
    }
    if (underWay_ && arrives_-- <= 0) {
        (void)spring_.hear(*underWay_);
        underWay_.reset();
    }
    return spring_.step(sample, dt, true).force();
}

void ApartLoop::hold(const glm::dvec3& outside, const glm::dvec3& position) {
    const int lead = options_.controlTicks * (2 + options_.late / options_.controlTicks);
    for (int i = 0; i < lead; ++i)
        (void)step(outside);
    // By way of a descent that every contact rate follows.
    const int ticks = static_cast<int>(std::ceil(2.0 * kForceRampInTime * options_.controlHz)) + 20 * lead;
    for (int i = 0; i < ticks; ++i)
        (void)step(glm::mix(outside, position, std::min(1.0, 2.0 * i / ticks)));
}

void ApartLoop::release(const glm::dvec3& position, const glm::dvec3& velocity) {
    (void)hand_.sample(static_cast<double>(ticks_) / options_.controlHz);
    hand_.plant().place(position, velocity);
    hand_.push(step(hand_.plant().measured()) + weight);
}

void ApartLoop::tick() {
    const double time = static_cast<double>(++ticks_) / options_.controlHz;
    hand_.push(step(hand_.sample(time).position) + weight);
}

bool apartSettles(const PlantParameters& device, const ApartOptions& options, double seconds) {
    constexpr double kDepth = 1e-3, kPush = 1e-4, kAside = 0.01; // m, m, m/s
    ApartLoop loop(pressedPlane(), frictionlessWall(options.stiffness), device, options, noLimits());
    loop.weight = {0, -options.stiffness * kDepth, 0};
    const glm::dvec3 rest{0.013, -kDepth, 0.017};
    loop.intention = [rest](double) { return rest; };
    loop.hold(rest + glm::dvec3(0, 2.0 * kDepth, 0), rest);
    loop.release(rest - glm::dvec3(0, kPush, 0), {kAside, 0, 0});
    Swing early, late;
    const auto ticks = static_cast<int>(seconds * options.controlHz);
    for (int i = 0; i < ticks; ++i) {
        loop.tick();
        if (!(std::abs(loop.plant().position().y + kDepth) < 0.9 * kDepth) ||
            !(std::abs(loop.plant().velocity().x) < 100.0 * kAside))
            return false; // has left the wall, is about to, or was thrown along it
        if (i >= 3 * (ticks / 4))
            late.take(loop.plant());
        else if (i >= ticks / 4 && i < ticks / 2)
            early.take(loop.plant());
    }
    // The residual of a decayed oscillation is rounding.
    return late.high - late.low < std::max(early.high - early.low, 1e-12) &&
           late.aside <= std::max(early.aside, 1e-9);
}

ContactRateResult studyContactRate(int controlTicks) {
    enterFloatMode();
    ApartOptions options{.controlTicks = controlTicks};
    options.spring.power = INFINITY;
    ContactRateResult result;
    result.contactHz = options.controlHz / controlTicks;
    result.together = stiffestStable(pressingDevice(), result.contactHz);
    result.apart = stiffestApart(options);
    result.drag = dragOf(options);
    ApartOptions late = options;
    late.late = controlTicks;
    result.late = stiffestApart(late);
    late.spring.power = 0.0;
    result.mended = stiffestApart(late);
    options.planes = true;
    result.planes = stiffestApart(options);
    result.dragPlanes = dragOf(options);
    return result;
}

} // namespace touchstone::study
