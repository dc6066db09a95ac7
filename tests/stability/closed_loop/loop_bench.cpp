#include "tests/stability/closed_loop/loop_bench.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test {

PlantParameters bareDevice(double mass, double viscous) {
    PlantParameters p;
    p.mass = mass;
    p.viscousFriction = viscous;
    p.coulombFriction = p.resolution = 0.0;
    p.maxForce = 1000.0;
    p.handMass = p.handDamping = p.handStiffness = 0.0;
    return p;
}

HapticSettings plainWall(double stiffness, double damping) {
    HapticSettings settings;
    settings.forceShading = ShadingMode::Off;
    settings.texture = TextureMode::Off;
    settings.friction = FrictionMode::Off;
    settings.stiffness = stiffness;
    settings.damping = damping;
    return settings;
}

LoopBench::LoopBench(const Scene& scene, const HapticSettings& settings, const PlantParameters& plant,
                     double rateHz, const DeviceLimits& limits, Fit fit)
    : bench(scene, settings, fit), rate_(rateHz), target_(intention), hand_(target_, plant) {
    bench.limits = limits;
    bench.dt = 1.0 / rateHz;
}

void LoopBench::hold(const glm::dvec3& outside, const glm::dvec3& position) {
    (void)bench.step(outside);
    const int ticks = static_cast<int>(std::ceil(1.1 * kForceRampInTime * rate_));
    for (int i = 0; i < ticks; ++i)
        (void)bench.step(position);
}

void LoopBench::release(const glm::dvec3& position, const glm::dvec3& velocity) {
    (void)hand_.sample(time());
    hand_.plant().place(position, velocity);
    const HapticOutput& output = bench.step(hand_.plant().measured());
    hand_.push(output.command.force() + weight);
}

const HapticOutput& LoopBench::tick() {
    ++ticks_;
    DeviceSample sample = hand_.sample(time());
    if (map) {
        map(sample);
        bench.mapping = sample.mapping;
    }
    const HapticOutput& output = bench.step(sample.position);
    hand_.push(output.command.force() + weight);
    return output;
}

Aftermath meetWall(const PlantParameters& plant, const HapticSettings& wall, double rateHz,
                   const Start& start, double seconds) {
    static const Scene plane = sceneOf(assets::plane(0.2, 0.2));
    LoopBench loop(plane, wall, plant, rateHz);
    constexpr double kPress = 0.7; // N
    const glm::dvec3 place{0.0131, 0.0, 0.0172};
    if (plant.handStiffness > 0.0) {
        const double depth = kPress / plant.handStiffness + kPress / wall.stiffness;
        loop.intention = [=](double) { return place - glm::dvec3(0, depth, 0); };
    } else {
        loop.weight = {0, -kPress, 0};
    }
    const glm::dvec3 begin = place + glm::dvec3(0, start.height, 0);
    loop.hold(place + glm::dvec3(0, 0.003, 0), begin);
    loop.release(begin, {0, -start.speed, 0});
    constexpr double kRest = 0.05; // s
    double resting = 0.0, lowest = INFINITY, highest = -INFINITY;
    for (double tick = 0.0; tick < seconds * rateHz; tick += 1.0) {
        (void)loop.tick();
        resting = loop.plant().velocity() == glm::dvec3(0.0) ? resting + 1.0 : 0.0;
        if (resting > kRest * rateHz)
            return {.rests = true};
        if (tick > 0.75 * seconds * rateHz) {
            lowest = std::min(lowest, loop.plant().position().y);
            highest = std::max(highest, loop.plant().position().y);
        }
    }
    return {.rests = false, .swing = highest - lowest};
}

double largestStable(double low, double high, const std::function<bool(double)>& stable) {
    while (high - low > 1e-4 * low) {
        const double middle = std::sqrt(low * high);
        (stable(middle) ? low : high) = middle;
    }
    return low;
}

} // namespace touchstone::test
