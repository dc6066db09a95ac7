#include "tests/stability/closed_loop/tilted_hold.h"

#include "assets/shapes.h"
#include "study/rate/closed_loop.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::test {

namespace {

constexpr double kPi = std::numbers::pi, kWave = 1e-3; // m
constexpr double kRadius = 0.05;                       // m, of the prism's corners

} // namespace

BenchScene tiltedWaves() {
    constexpr double kSide = 0.05, kSteepest = 1.0, kHeight = kSteepest * kWave / kPi; // m, 45 degrees, m
    return reliefScene("waves", assets::plane(kSide, kSide), {}, 1024, kHeight,
                       [](double u, double) { return 0.5 + 0.5 * std::cos(2.0 * kPi * u * kSide / kWave); });
}

TiltedPlace onWaves(int place) {
    return {{kWave * (place + 0.5) / kTiltedPlaces, 0.0, 3e-4}, {0, 1, 0}};
}

BenchScene tiltedPrism() {
    return shapeScene("prism", assets::prism(4, kRadius, 0.15, true), {});
}

TiltedPlace onPrism(int place) {
    const double fromMiddle = 0.25 * kPi * (place + 0.5) / kTiltedPlaces, angle = 0.25 * kPi + fromMiddle;
    const glm::dvec3 normal(std::sin(angle), 0.0, std::cos(angle));
    return {kRadius * std::cos(0.25 * kPi) / std::cos(fromMiddle) * normal, normal};
}

TiltedHold holdStill(const HapticScene& scene, const HapticSettings& settings, const TiltedPlace& place,
                     double push) {
    constexpr double kRate = 1000.0, kComesDown = 0.5, kAbove = 0.01; // Hz, s, m
    constexpr int kTicks = 4000, kLate = 3000;
    const PlantParameters phantom;
    study::ClosedLoop loop(scene, settings, phantom, kRate, limitsOf(phantom));
    const double depth = push / settings.stiffness + push / phantom.handStiffness;
    loop.intention = [=](double time) {
        const double left = std::max(0.0, 1.0 - time / kComesDown);
        return place.point + (left * (kAbove + depth) - depth) * place.normal;
    };
    glm::dvec3 low(INFINITY), high(-INFINITY);
    double before = 0.0, net = 0.0;
    for (int i = 0; i < kTicks; ++i) {
        (void)loop.tick();
        net = loop.plant().motorWork() - loop.plant().coulombLoss();
        if (i < kLate) {
            before = net;
            continue;
        }
        low = glm::min(low, loop.plant().position());
        high = glm::max(high, loop.plant().position());
    }
    return {glm::length(high - low), std::max(0.0, (net - before) * kRate / (kTicks - kLate))};
}

} // namespace touchstone::test
