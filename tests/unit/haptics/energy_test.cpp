// The work that each effect does on the hand over closed paths, against what its law says.

#include "haptics/force/work_meter.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>

namespace touchstone::test {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kStiffness = 1000.0; // N/m

HapticSettings nothingOn() {
    HapticSettings s;
    s.forceShading = ShadingMode::Off;
    s.texture = TextureMode::Off;
    s.friction = FrictionMode::Off;
    s.stiffness = kStiffness;
    return s;
}

/// A hand with a meter on it.
struct MeteredBench {
    TouchBench bench;
    WorkMeter work;

    MeteredBench(const Scene& scene, const HapticSettings& settings) : bench(scene, settings) {}

    void step(const glm::dvec3& hand) {
        bench.step(hand);
        work.add(bench.output.force, bench.output.hip);
    }
    void moveTo(const glm::dvec3& to, double speed) {
        bench.moveTo(to, speed, [&](const HapticOutput& out) { work.add(out.force, out.hip); });
    }
};

/// A plane of 0.2 m at y = 0 whose material has a map along u: `value` of u in 0..1.
Scene planeWithMap(const std::function<double(double u)>& value) {
    constexpr int kTexels = 4096;
    Scene scene = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    Image image;
    image.decoded = true;
    image.pixels.width = kTexels;
    image.pixels.height = image.pixels.channels = 1;
    image.pixels.type = ComponentType::F32;
    image.pixels.bytes.resize(sizeof(float) * kTexels);
    for (size_t x = 0; x < kTexels; ++x) {
        const auto h = static_cast<float>(value((static_cast<double>(x) + 0.5) / kTexels));
        std::memcpy(&image.pixels.bytes[sizeof(float) * x], &h, sizeof h);
    }
    scene.images.push_back(image);
    return scene;
}

TEST(Energy, AFlatContactWithFrictionGivesNoMoreThanSamplingDoes) {
    HapticSettings s = nothingOn();
    s.friction = FrictionMode::Zilles;
    s.staticFriction = 0.5;
    s.dynamicFriction = 0.4;
    MeteredBench hand(sceneOf(assets::plane(0.2, 0.2, 2, 2)), s);
    hand.step({0.0, 0.005, 0.0});
    // Presses, strokes and rocks in closed rounds: what the hand put into the spring comes back, no more.
    for (int round = 0; round < 5; ++round) {
        hand.moveTo({0.0, -2e-3, 0.0}, 0.05);
        hand.moveTo({0.02, -2e-3, 0.01}, 0.1);
        for (int i = 0; i < 200; ++i) {
            const double a = 2.0 * kPi * i / 50;
            hand.step({0.02 + 3e-4 * std::sin(a), -2e-3 - 5e-4 * std::sin(0.7 * a), 0.01});
        }
        hand.moveTo({-0.02, -1e-3, 0.01}, 0.2);
        hand.moveTo({0.0, 0.005, 0.0}, 0.1);
    }
    std::printf("friction: given %.4g J, law %.4g J, sampling bound %.4g J\n", hand.work.given(),
                hand.work.law(), kStiffness * hand.work.samplingBound());
    EXPECT_LT(hand.work.law(), 0.0) << "friction takes";
    EXPECT_LE(hand.work.given(), kStiffness * hand.work.samplingBound());

    // Without a stroke there is nothing that friction could take: only the bound is left.
    HapticSettings stuck = s;
    stuck.staticFriction = stuck.dynamicFriction = 10.0;
    MeteredBench held(sceneOf(assets::plane(0.2, 0.2, 2, 2)), stuck);
    held.step({0.0, 0.005, 0.0});
    for (int round = 0; round < 20; ++round) {
        held.moveTo({0.0, -2e-3, 0.0}, 0.05);
        held.moveTo({1e-3, -2e-3, 1e-3}, 0.05);
        held.moveTo({-1e-3, -3e-3, 1e-3}, 0.05);
        held.moveTo({0.0, -2e-3, 0.0}, 0.05);
        held.moveTo({0.0, 0.005, 0.0}, 0.05);
    }
    std::printf("sticking: given %.4g J, law %.4g J, sampling bound %.4g J\n", held.work.given(),
                held.work.law(), kStiffness * held.work.samplingBound());
    EXPECT_GT(held.work.given(), 0.0);
    EXPECT_LE(held.work.given(), kStiffness * held.work.samplingBound());
    EXPECT_LT(std::abs(held.work.law()), 0.05 * kStiffness * held.work.samplingBound());
}

TEST(Energy, ShadingGivesWhatTheShapeOfThePrismSays) {
    // Into the middle of a facet, along the circle of 0.85 R to a corner, out there. Shaded, the force is
    // radial with the stretch P(a) - rho, P the prism's own radius: the arc is free, and the way out is
    // longer than the way in. k/2 [(R - rho)^2 - (R cos 18 - rho)^2] are given to the hand.
    constexpr double kR = 0.05, kRho = 0.85 * kR;
    HapticSettings s = nothingOn();
    s.forceShading = ShadingMode::TwoPass;
    MeteredBench hand(sceneOf(assets::prism(10, kR, 0.2, true)), s);
    const auto at = [](double rho, double a) {
        return glm::dvec3(rho * std::cos(a), 0.0, rho * std::sin(a));
    };
    const double middle = 0.0, corner = kPi / 10.0; // as the prism lies
    hand.step(at(0.055, middle));
    for (double rho = 0.055; rho > kRho; rho -= 2e-5)
        hand.step(at(rho, middle));
    for (int i = 0; i <= 2000; ++i)
        hand.step(at(kRho, middle + (corner - middle) * i / 2000));
    for (double rho = kRho; rho < 0.055; rho += 2e-5)
        hand.step(at(rho, corner));
    const double out = kR - kRho, in = kR * std::cos(kPi / 10.0) - kRho;
    const double expected = 0.5 * kStiffness * (out * out - in * in);
    std::printf("shading: given %.6f J, law %.6f J, predicted %.6f J\n", hand.work.given(), hand.work.law(),
                expected);
    EXPECT_NEAR(hand.work.law(), expected, 0.01 * expected);
    EXPECT_LE(hand.work.given() - hand.work.law(), 1.01 * kStiffness * hand.work.samplingBound());
}

TEST(Energy, AHeightMapGivesWhatItsForceLawSays) {
    constexpr double kScale = 4e-4, kDepth = 1e-3;
    constexpr int kWaves = 5;
    Scene scene = planeWithMap([](double u) { return 0.5 + 0.5 * std::sin(2.0 * kPi * kWaves * u); });
    HeightMap map;
    map.texture.image = 0;
    map.scale = static_cast<float>(kScale);
    scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
    HapticSettings s = nothingOn();
    s.texture = TextureMode::Law;
    s.textureTiltLimit = kPi / 2.0;
    MeteredBench hand(scene, s);
    // In over a trough, along at one depth to a crest one wave and a half away, out there.
    const double trough = 0.2 * (0.75 / kWaves - 0.5), crest = 0.2 * (2.25 / kWaves - 0.5);
    hand.step({trough, 1e-3, 0.0});
    hand.moveTo({trough, -kDepth, 0.0}, 0.005);
    hand.moveTo({crest, -kDepth, 0.0}, 0.01);
    hand.moveTo({crest, 1e-3, 0.0}, 0.005);

    // The law, k [(d - H) n + H m] while d >= H, else k d m, integrated along the same way.
    const auto height = [&](double x) {
        return kScale * (0.5 + 0.5 * std::sin(2.0 * kPi * kWaves * (x / 0.2 + 0.5)));
    };
    const auto slope = [&](double x) {
        return kScale * kPi * kWaves / 0.2 * std::cos(2.0 * kPi * kWaves * (x / 0.2 + 0.5));
    };
    const auto law = [&](double x, double d) {
        const glm::dvec2 m = glm::normalize(glm::dvec2(-slope(x), 1.0));
        const double h = height(x);
        return kStiffness * (d >= h ? glm::dvec2(0.0, d - h) + h * m : d * m);
    };
    double expected = 0.0;
    constexpr int kParts = 20000;
    for (int i = 0; i < kParts; ++i) {
        const double t = (i + 0.5) / kParts;
        expected += -law(trough, t * kDepth).y * kDepth / kParts;
        expected += law(trough + t * (crest - trough), kDepth).x * (crest - trough) / kParts;
        expected += law(crest, t * kDepth).y * kDepth / kParts;
    }
    std::printf("height map: law %.4g J, predicted %.4g J\n", hand.work.law(), expected);
    EXPECT_GT(std::abs(expected), 5e-5);
    EXPECT_NEAR(hand.work.law(), expected, 0.01 * std::abs(expected));
}

TEST(Energy, AStiffnessMapGivesTheDifferenceOfItsSprings) {
    constexpr double kDepth = 1e-3;
    Scene scene = planeWithMap([](double u) { return u; });
    FactorMap map;
    map.texture.image = 0;
    map.min = 0.5f;
    map.max = 1.5f;
    scene.materials[0].haptic.stiffnessMap = {map, HapticSource::Touchstone};
    MeteredBench hand(scene, nothingOn());
    const auto stiffness = [](double x) { return kStiffness * (0.5 + x / 0.2 + 0.5); };
    constexpr double kSoft = -0.08, kHard = 0.08;
    for (const auto& [from, to] : {std::pair(kSoft, kHard), std::pair(kHard, kSoft)}) {
        WorkMeter& work = hand.work = WorkMeter{};
        hand.bench.state[0].forgetTouch();
        hand.bench.tick = 0;
        hand.bench.output = {};
        hand.step({from, 1e-3, 0.0});
        hand.moveTo({from, -kDepth, 0.0}, 0.005);
        hand.moveTo({to, -kDepth, 0.0}, 0.05);
        hand.moveTo({to, 1e-3, 0.0}, 0.005);
        const double expected = 0.5 * kDepth * kDepth * (stiffness(to) - stiffness(from));
        std::printf("stiffness map: law %.4g J, predicted %.4g J\n", work.law(), expected);
        EXPECT_NEAR(work.law(), expected, 0.01 * std::abs(expected));
    }
}

} // namespace
} // namespace touchstone::test
