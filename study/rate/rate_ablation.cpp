#include "study/rate/rate_ablation.h"

#include "assets/shapes.h"
#include "engine/core/float_mode.h"
#include "study/rate/closed_loop.h"
#include "study/subject/subject.h"
#include "study/timing/clock_cost.h"
#include "study/timing/interval.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace touchstone::study {

namespace {

constexpr int kSettlingTicks = 12000;
constexpr size_t kStrokedTriangles = 64'800;

const Subject& stroked() {
    static const Subject subject = [] {
        for (const ShapeKind& kind : shapeKinds())
            if (kind.name == "torus")
                return kind.make(kStrokedTriangles);
        return shapeKinds().front().make(kStrokedTriangles);
    }();
    return subject;
}

/// Lowest and highest position.
struct Range {
    double low = INFINITY, high = -INFINITY;
    void take(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
    [[nodiscard]] double width() const { return high - low; }
};

struct Stroke {
    double busy = 0.0;   ///< fraction of a processor
    double energy = 0.0; ///< J
};

/// The mean of the stretches, without those so long that another program must have taken the processor.
double undisturbedMean(std::vector<double> stretches) {
    constexpr double kDisturbed = 4.0; // medians; the work varies by less from stretch to stretch
    const auto middle = stretches.begin() + static_cast<std::ptrdiff_t>(stretches.size() / 2);
    std::nth_element(stretches.begin(), middle, stretches.end());
    const double most = kDisturbed * *middle;
    double sum = 0.0, count = 0.0;
    for (const double ns : stretches)
        if (ns <= most) {
            sum += ns;
            count += 1.0;
        }
    return sum / count;
}

Stroke strokeAt(double rateHz, double seconds) {
    constexpr int kStretch = 25; // ticks
    const PlantParameters phantom;
    ClosedLoop loop(*stroked().bench.haptic, {}, phantom, rateHz, limitsOf(phantom));
    loop.intention = [](double time) { return stroked().hand(time); };
    Stroke stroke;
    std::vector<double> stretches;
    const auto clock = static_cast<double>(clockCostNs());
    for (double tick = 0.0; tick < seconds * rateHz; tick += kStretch) {
        double ns = 0.0;
        for (int i = 0; i < kStretch; ++i) {
            (void)loop.tick();
            ns += static_cast<double>(loop.stepNs) - clock;
            stroke.energy = std::max(stroke.energy, loop.plant().motorWork() - loop.plant().coulombLoss());
        }
        stretches.push_back(ns);
    }
    stroke.busy = 1e-9 * rateHz * undisturbedMean(std::move(stretches)) / kStretch;
    return stroke;
}

} // namespace

HapticSettings frictionlessWall(double stiffness) {
    HapticSettings settings;
    settings.forceShading = ShadingMode::Off;
    settings.texture = TextureMode::Off;
    settings.friction = FrictionMode::Off;
    settings.stiffness = stiffness;
    settings.damping = 0.0;
    return settings;
}

const HapticScene& pressedPlane() {
    static const BenchScene scene = shapeScene("plane", assets::plane(0.2, 0.2), {});
    return *scene.haptic;
}

PlantParameters pressingDevice() {
    PlantParameters device;
    device.viscousFriction = 1.0;
    device.coulombFriction = device.resolution = 0.0;
    device.maxForce = 1000.0;
    device.handMass = device.handDamping = device.handStiffness = 0.0;
    return device;
}

double stiffnessBound(const PlantParameters& device, double rateHz) {
    return 2.0 * device.viscousFriction * rateHz;
}

bool pressedWallSettles(const PlantParameters& device, const HapticSettings& wall, double rateHz, int ticks) {
    constexpr double kDepth = 1e-3, kPush = 1e-4; // m
    ClosedLoop loop(pressedPlane(), wall, device, rateHz, noLimits());
    loop.weight = {0, -wall.stiffness * kDepth, 0};
    const glm::dvec3 rest{0.013, -kDepth, 0.017};
    loop.intention = [rest](double) { return rest; };
    loop.hold(rest + glm::dvec3(0, 2.0 * kDepth, 0), rest);
    loop.release(rest - glm::dvec3(0, kPush, 0), glm::dvec3(0.0));
    Range early, late;
    for (int i = 0; i < ticks; ++i) {
        const double y = loop.tick().hip.y;
        if (!(std::abs(y + kDepth) < 0.9 * kDepth))
            return false; // has left the wall, or is about to
        if (i >= 3 * (ticks / 4))
            late.take(y);
        else if (i >= ticks / 4 && i < ticks / 2)
            early.take(y);
    }
    // The residual of a decayed oscillation is rounding.
    return late.width() < std::max(early.width(), 1e-12);
}

double stiffestStable(const PlantParameters& device, double rateHz) {
    const auto stable = [&](double stiffness) {
        return pressedWallSettles(device, frictionlessWall(stiffness), rateHz, kSettlingTicks);
    };
    constexpr double kStep = 2.0;
    double low = stiffnessBound(device, rateHz) / 64.0;
    if (!stable(low))
        return 0.0;
    double high = kStep * low;
    while (stable(high)) {
        low = high;
        high *= kStep;
    }
    while (high - low > 1e-4 * low) {
        const double middle = std::sqrt(low * high);
        (stable(middle) ? low : high) = middle;
    }
    return low;
}

std::vector<RateResult> studyRates(std::span<const double> rates, const RateOptions& options,
                                   const std::function<void(double)>& progress) {
    enterFloatMode();
    std::vector<RateResult> results;
    std::vector<std::vector<double>> busy(rates.size());
    for (const double rate : rates) {
        const PlantParameters device = pressingDevice();
        RateResult& result = results.emplace_back();
        result.rateHz = rate;
        result.stiffestStable = stiffestStable(device, rate);
        result.bound = stiffnessBound(device, rate);
        progress(0.5 * static_cast<double>(results.size()) / static_cast<double>(rates.size()));
    }
    for (int round = 0; round < options.rounds; ++round) {
        for (size_t i = 0; i < rates.size(); ++i) {
            const Stroke stroke = strokeAt(rates[i], options.seconds);
            busy[i].push_back(stroke.busy);
            results[i].energyCreated = std::max(results[i].energyCreated, stroke.energy);
        }
        progress(0.5 + 0.5 * (round + 1) / options.rounds);
    }
    for (size_t i = 0; i < rates.size(); ++i)
        results[i].busy = medianOf(busy[i]);
    return results;
}

} // namespace touchstone::study
