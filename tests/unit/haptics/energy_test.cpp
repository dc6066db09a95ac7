// The work that each effect does on the hand over closed paths, against what its law says.

#include "haptics/force/work_meter.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace touchstone::test::energy_test {
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

/// A float image of one row: `channels` numbers for each u in 0..1.
Image rowImage(int channels, const std::function<glm::dvec3(double u)>& value) {
    constexpr int kTexels = 4096;
    Image image;
    image.decoded = true;
    image.pixels.width = kTexels;
    image.pixels.height = 1;
    image.pixels.channels = channels;
    image.pixels.type = ComponentType::F32;
    for (int x = 0; x < kTexels; ++x) {
        const glm::dvec3 v = value((x + 0.5) / kTexels);
        for (int c = 0; c < channels; ++c) {
            const auto texel = static_cast<float>(v[c]);
            const auto* bytes = reinterpret_cast<const std::byte*>(&texel);
            image.pixels.bytes.insert(image.pixels.bytes.end(), bytes, bytes + sizeof texel);
        }
    }
    return image;
}

/// A plane of 0.2 m at y = 0 whose material has a map along u: `value` of u in 0..1.
Scene planeWithMap(const std::function<double(double u)>& value) {
    Scene scene = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    scene.images.push_back(rowImage(1, [&](double u) { return glm::dvec3(value(u)); }));
    return scene;
}

TEST(Energy, WhatAGapHidesIsCountedAsAGapAndNotAsWork) {
    WorkMeter whole, gapped, parts[2];
    const auto force = [](int i) { return glm::dvec3(std::sin(0.3 * i), 2.0, 0.1 * i); };
    const auto hand = [](int i) { return glm::dvec3(1e-3 * i, 1e-4 * i * i, std::cos(0.2 * i)); };
    for (int i = 0; i < 40; ++i) {
        whole.add(force(i), hand(i));
        if (i >= 15 && i < 25)
            continue; // lost
        if (i == 25)
            gapped.gap();
        gapped.add(force(i), hand(i));
        parts[i < 20 ? 0 : 1].add(force(i), hand(i));
    }
    EXPECT_EQ(gapped.gaps(), 1u);
    EXPECT_NEAR(gapped.given(), parts[0].given() + parts[1].given(), 1e-15);
    EXPECT_NEAR(gapped.law(), parts[0].law() + parts[1].law(), 1e-15);
    EXPECT_NEAR(gapped.samplingBound(), parts[0].samplingBound() + parts[1].samplingBound(), 1e-15);
    EXPECT_GT(std::abs(whole.given() - gapped.given()), 0.1);
    WorkMeter fresh;
    fresh.gap();
    EXPECT_EQ(fresh.gaps(), 0u) << "before the first tick there is nothing to lose";
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

/// A bump height of waves along x on the plane, and what each law makes of it, evaluated here.
struct Waves {
    static constexpr double kScale = 4e-4; // m
    static constexpr int kCount = 5;
    static double phase(double u) { return 2.0 * kPi * kCount * u; }
    static double height(double x) { return kScale * (0.5 + 0.5 * std::sin(phase(x / 0.2 + 0.5))); }
    static double slope(double x) { return kScale * kPi * kCount / 0.2 * std::cos(phase(x / 0.2 + 0.5)); }
    static glm::dvec2 force(TextureMode mode, bool hasHeight, double x, double d) { // along x and the normal
        const glm::dvec2 m = glm::normalize(glm::dvec2(-slope(x), 1.0));
        if (mode == TextureMode::Minsky && hasHeight)
            return kStiffness * d * glm::dvec2(-slope(x), 1.0);
        if (mode == TextureMode::Law && hasHeight && d >= height(x))
            return kStiffness * (glm::dvec2(0.0, d - height(x)) + height(x) * m);
        return kStiffness * d * m;
    }
};

/// In over a trough, along at one depth to a crest one wave and a half away, out there: what was given, and
/// what the law gives along the same way.
void expectWaveWork(const Scene& scene, TextureMode mode, bool hasHeight) {
    constexpr double kDepth = 1e-3;
    HapticSettings s = nothingOn();
    s.texture = mode;
    s.textureTiltLimit = kPi / 2.0;
    MeteredBench hand(scene, s);
    const double trough = 0.2 * (0.75 / Waves::kCount - 0.5), crest = 0.2 * (2.25 / Waves::kCount - 0.5);
    hand.step({trough, 1e-3, 0.0});
    hand.moveTo({trough, -kDepth, 0.0}, 0.005);
    hand.moveTo({crest, -kDepth, 0.0}, 0.01);
    hand.moveTo({crest, 1e-3, 0.0}, 0.005);
    double expected = 0.0;
    constexpr int kParts = 20000;
    for (int i = 0; i < kParts; ++i) {
        const double t = (i + 0.5) / kParts;
        expected += -Waves::force(mode, hasHeight, trough, t * kDepth).y * kDepth / kParts;
        expected += Waves::force(mode, hasHeight, trough + t * (crest - trough), kDepth).x *
                    (crest - trough) / kParts;
        expected += Waves::force(mode, hasHeight, crest, t * kDepth).y * kDepth / kParts;
    }
    std::printf("texture=%s, %s: law %.5g J, predicted %.5g J\n", settingValue(s, "texture").c_str(),
                hasHeight ? "height map" : "normal map", hand.work.law(), expected);
    EXPECT_GT(std::abs(expected), 5e-5);
    EXPECT_NEAR(hand.work.law(), expected, 0.01 * std::abs(expected));
}

TEST(Energy, AHeightMapGivesWhatItsForceLawSays) {
    Scene scene = planeWithMap([](double u) { return 0.5 + 0.5 * std::sin(Waves::phase(u)); });
    HeightMap map;
    map.texture.image = 0;
    map.scale = static_cast<float>(Waves::kScale);
    scene.materials[0].haptic.height = {map, HapticSource::Touchstone};
    for (const TextureMode mode : {TextureMode::Law, TextureMode::Blinn, TextureMode::Minsky})
        expectWaveWork(scene, mode, true);
}

TEST(Energy, ANormalMapGivesWhatItsForceLawSays) {
    Scene scene = sceneOf(assets::plane(0.2, 0.2, 2, 2));
    scene.images.push_back(rowImage(3, [](double u) {
        return 0.5 + 0.5 * glm::normalize(glm::dvec3(-Waves::slope(0.2 * (u - 0.5)), 0.0, 1.0));
    }));
    scene.materials[0].normalTexture.image = 0;
    expectWaveWork(scene, TextureMode::Law, false);
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

TEST(Energy, ADampingMapTakesWhatItsCoefficientsSay) {
    // In askew over the map at one speed, a rest, straight out where it is thickest. The spring gives back
    // what it took; the dampers take b v along the normal way of each, less
    //  - on the way out what the velocity's filter leaves out while it rises, (1 + q) / (2 (1 - q)) ticks,
    //  - near the surface what a wall would have to pull for: (b v)² / 2k.
    // The surface is met in the middle of a tick, as the trapezium rule has it.
    constexpr double kDepth = 1.01e-3, kAbove = 0.99e-3, kSpeed = 0.02, kMax = 3.0, kTick = 1e-3;
    Scene scene = planeWithMap([](double u) { return u; });
    FactorMap map;
    map.texture.image = 0;
    map.min = 0.0f;
    map.max = 2.0f;
    scene.materials[0].haptic.dampingMap = {map, HapticSource::Touchstone};
    scene.materials[0].haptic.damping = {static_cast<float>(0.5 * kMax), HapticSource::Touchstone};
    const auto damping = [](double x) { return kMax * (x / 0.2 + 0.5); };
    constexpr double kFrom = -0.08, kTo = 0.08;
    for (const double side : {1.0, -1.0}) {
        MeteredBench hand(scene, nothingOn());
        const auto go = [&](const glm::dvec3& from, const glm::dvec3& to, int ticks) {
            for (int i = 1; i <= ticks; ++i)
                hand.step(from + (to - from) * (static_cast<double>(i) / ticks));
        };
        const glm::dvec3 above(side * kFrom, kAbove, 0.0), below(side * kTo, -kDepth, 0.0),
            out(side * kTo, kAbove, 0.0);
        const int ticks = static_cast<int>(std::lround((kAbove + kDepth) / (kSpeed * kTick)));
        hand.step(above);
        go(above, below, ticks);
        go(below, below, 100);
        go(below, out, ticks);
        const double q = std::exp(-2.0 * kPi * 80.0 * kTick); // of the 80 Hz low-pass, in a tick
        const double late = (1.0 + q) / (2.0 * (1.0 - q)) * kTick * kSpeed;
        const double touched = side * (kFrom + (kTo - kFrom) * kAbove / (kAbove + kDepth));
        const double onTheWay = 0.5 * (damping(touched) + damping(side * kTo));
        const double pull = damping(side * kTo) * kSpeed;
        const double expected =
            -kSpeed * onTheWay * kDepth - pull * (kDepth - late) + 0.5 * pull * pull / kStiffness;
        std::printf("damping map: law %.5g J, predicted %.5g J\n", hand.work.law(), expected);
        EXPECT_LT(expected, -1.5e-5);
        EXPECT_NEAR(hand.work.law(), expected, 0.01 * std::abs(expected));
    }
}

} // namespace
} // namespace touchstone::test::energy_test
