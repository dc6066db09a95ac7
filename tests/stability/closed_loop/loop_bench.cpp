#include "tests/stability/closed_loop/loop_bench.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test {

DeviceLimits noLimits() {
    DeviceLimits limits;
    limits.maxForce = 1e9;
    limits.maxForceRate = 1e15;
    limits.positionResolution = 0.0;
    limits.coulombFriction = 0.0;
    return limits;
}

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
    : bench(scene, settings, fit), rate_(rateHz), wish_(*this), hand_(wish_, plant) {
    bench.scene = compileHapticScene(scene, workspaceFromScene(scene, fit), limits);
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
    const HapticOutput& output = bench.step(hand_.sample(time()).position);
    hand_.push(output.command.force() + weight);
    return output;
}

bool pressedWallSettles(const PlantParameters& plant, const HapticSettings& wall, double rateHz, int ticks) {
    static const Scene plane = sceneOf(assets::plane(0.2, 0.2));
    constexpr double kDepth = 1e-3, kPush = 1e-4;
    LoopBench loop(plane, wall, plant, rateHz);
    loop.weight = {0, -wall.stiffness * kDepth, 0};
    const glm::dvec3 rest{0.013, -kDepth, 0.017};
    loop.intention = [rest](double) { return rest; };
    loop.hold(rest + glm::dvec3(0, 2.0 * kDepth, 0), rest);
    loop.release(rest - glm::dvec3(0, kPush, 0), glm::dvec3(0.0));
    double early[2]{1.0, -1.0}, late[2]{1.0, -1.0}; // lowest and highest
    for (int i = 0; i < ticks; ++i) {
        const double y = loop.tick().hip.y;
        if (!(std::abs(y + kDepth) < 0.9 * kDepth))
            return false; // has left the wall, or is about to
        double* range = i >= 3 * (ticks / 4) ? late : i >= ticks / 4 && i < ticks / 2 ? early : nullptr;
        if (range != nullptr) {
            range[0] = std::min(range[0], y);
            range[1] = std::max(range[1], y);
        }
    }
    // What is left of a swing that has died is rounding.
    return late[1] - late[0] < std::max(early[1] - early[0], 1e-12);
}

double largestStable(double low, double high, const std::function<bool(double)>& stable) {
    while (high - low > 1e-4 * low) {
        const double middle = std::sqrt(low * high);
        (stable(middle) ? low : high) = middle;
    }
    return low;
}

} // namespace touchstone::test
