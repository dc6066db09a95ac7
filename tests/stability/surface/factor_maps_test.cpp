// Steps in maps of stiffness, damping and friction: cliffs of one texel under a hand at any speed. Every tick
// is held to the law with the map evaluated here, and with it what a tick may change.

#include "tests/stability/surface/touched_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone::test::factor_maps_test {
namespace {

constexpr int kTexels = 128;
constexpr double kTexel = kSide / kTexels; // m, 0.78 mm
constexpr double kAliased = 0.5 * kTexel;  // m: strokes longer than this read coarser levels
constexpr std::array kLaws{FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic};

/// A plane whose map of cliffs is bound to `field`.
Scene factorPlane(HapticMaterial::Field<FactorMap> HapticMaterial::*field, double least, double most) {
    Scene scene;
    scene.materials.emplace_back();
    scene.images.push_back(cliffImage(kTexels));
    FactorMap map;
    map.texture = texture(0);
    map.min = static_cast<float>(least);
    map.max = static_cast<float>(most);
    scene.materials[0].haptic.*field = {map, HapticSource::Touchstone};
    place(scene, quadMesh(0.5 * kSide, 4), 0);
    return scene;
}

/// The factor under the hand.
double factorAt(const glm::dvec3& hip, double least, double most) {
    const glm::dvec2 uv = uvOn(hip);
    return least + (most - least) * cliffValue(kTexels, uv.x, uv.y);
}

/// What the factor changes by at most along a step: by its whole range from texel to texel, in both
/// directions.
double factorChange(double step, double least, double most) {
    return (most - least) * std::min(1.0, std::sqrt(2.0) * step / kTexel);
}

TEST(FactorMaps, CliffsInStiffnessAreFeltAsTheLawHasThem) {
    constexpr double kMin = 0.3, kMax = 1.0;
    for (const double radius : {0.0, 0.5e-3})
        for (const double speed : {0.005, 0.02, 0.1, 0.38, 1.0})
            for (const double depth : {2e-4, 1e-3}) {
                SCOPED_TRACE("r " + std::to_string(radius) + " at " + std::to_string(speed) + " m/s, depth " +
                             std::to_string(depth));
                TouchBench bench(factorPlane(&HapticMaterial::stiffnessMap, kMin, kMax),
                                 felt(TextureMode::Law, radius));
                const double s = speed * bench.dt;
                bench.step({-0.045, 0.003, 0.01});
                bench.moveTo({-0.045, 0.003, -depth}, 0.05);
                bench.moveTo({-0.025, 0.007, -depth}, speed); // the filter settles
                glm::dvec3 last = bench.output.force;
                double largest = 0.0;
                bench.moveTo({0.04, 0.02, -depth}, speed, [&](const HapticOutput& out) {
                    const double d = out.penetration,
                                 share = s < kAliased ? factorAt(out.hip, kMin, kMax) : 0.5 * (kMin + kMax);
                    EXPECT_NEAR(out.force.z, kStiffness * share * d, 1e-4 * kStiffness * d) << out.hip.x;
                    const double change = glm::distance(out.force, last);
                    EXPECT_LE(change, kStiffness * (s + d * factorChange(s, kMin, kMax)));
                    largest = std::max(largest, change);
                    last = out.force;
                });
                EXPECT_EQ(held(bench), 0.0);
                if (s < kAliased) {
                    EXPECT_GT(largest, 0.3 * kStiffness * depth * factorChange(s, kMin, kMax));
                } else {
                    EXPECT_LT(largest, 1e-3 * kStiffness * depth) << "what would alias is left out";
                }
            }
}

TEST(FactorMaps, CliffsInDampingAreFeltAsTheLawHasThem) {
    constexpr double kMin = 0.0, kMax = 2.0, kDamping = 1.5; // N·s/m
    for (const double speed : {0.005, 0.1, 1.0}) {
        Scene scene = factorPlane(&HapticMaterial::dampingMap, kMin, kMax);
        scene.materials[0].haptic.damping = {static_cast<float>(kDamping), HapticSource::Touchstone};
        TouchBench bench(scene, felt(TextureMode::Law));
        const double s = speed * bench.dt;
        bench.step({-0.045, 0.003, 0.01});
        bench.moveTo({-0.045, 0.003, -1e-3}, 0.05);
        HapticOutput last = bench.output;
        const int ticks = static_cast<int>(0.06 / s);
        int damped = 0;
        for (int i = 0; i < ticks; ++i) { // strokes, and rocks in and out
            bench.step({-0.045 + s * i, 0.003, -1e-3 - 4e-4 * std::sin(0.2 * i)});
            const HapticOutput& out = bench.output;
            const double v = out.hipVelocity.z, d = out.penetration;
            const double share = s < kAliased ? factorAt(out.hip, kMin, kMax) : 0.5 * (kMin + kMax);
            const double expected = std::max(kStiffness * d - kDamping * share * v, 0.0);
            if (i > 30) { // the filtered speed has settled, and with it the level
                EXPECT_NEAR(out.force.z, expected, 1e-4) << out.hip.x;
                const double allowed = kStiffness * glm::distance(out.hip, last.hip) +
                                       kDamping * (kMax * std::abs(v - last.hipVelocity.z) +
                                                   std::abs(v) * factorChange(s, kMin, kMax));
                EXPECT_LE(glm::distance(out.force, last.force), allowed * (1.0 + 1e-6) + 1e-9);
                damped += std::abs(out.force.z - kStiffness * d) > 0.05 ? 1 : 0;
            }
            last = out;
        }
        EXPECT_GT(damped, 10);
        EXPECT_EQ(held(bench), 0.0);
    }
}

/// Strokes askew over the map. In every tick the friction force is in the cone of the map under the hand; it
/// grows and falls by what the hand moves and by what lies between the largest force that could hold and the
/// least that slides.
void strokeFriction(FrictionMode law, double least, double most, double speed) {
    constexpr double kStatic = 1.0, kDynamic = 0.6, kDepth = 5e-4;
    Scene scene = factorPlane(&HapticMaterial::friction, least, most);
    scene.materials[0].haptic.staticFriction = {static_cast<float>(kStatic), HapticSource::Touchstone};
    scene.materials[0].haptic.dynamicFriction = {static_cast<float>(kDynamic), HapticSource::Touchstone};
    HapticSettings s = felt(TextureMode::Law);
    s.friction = law;
    TouchBench bench(scene, s);
    SCOPED_TRACE(settingValue(s, "friction") + " " + std::to_string(least) + " to " + std::to_string(most) +
                 " at " + std::to_string(speed) + " m/s");
    bench.step({-0.045, 0.003, 0.01});
    bench.moveTo({-0.045, 0.003, -kDepth}, 0.05);
    bench.moveTo({-0.025, 0.007, -kDepth}, speed);
    const double normal = bench.output.force.z, step = speed * bench.dt;
    HapticOutput last = bench.output;
    double holds = 0.0, largest = 0.0;
    const auto share = [&](const HapticOutput& out) {
        return step < kAliased ? factorAt(out.hip, least, most) : 0.5 * (least + most);
    };
    bench.moveTo({0.04, 0.02, -kDepth}, speed, [&](const HapticOutput& out) {
        ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z));
        EXPECT_NEAR(out.force.z, normal, 1e-6);
        const double along = std::hypot(out.force.x, out.force.y);
        const double mu = share(out), before = share(last);
        EXPECT_LE(along, kStatic * mu * normal * (1.0 + 1e-4) + 1e-6) << out.hip.x;
        const double between = (kStatic * std::max(mu, before) - kDynamic * std::min(mu, before)) * normal;
        const double change = glm::distance(out.force, last.force);
        EXPECT_LE(change, kStiffness * step + between + 1e-6) << out.hip.x;
        largest = std::max(largest, change);
        holds = std::max(holds, along);
        last = out;
    });
    EXPECT_EQ(held(bench), 0.0);
    EXPECT_GT(holds, 0.3 * kDynamic * std::min(most, 1.0) * normal);
    if (step > kAliased && law != FrictionMode::Zilles) { // which sticks and slips by itself
        EXPECT_LT(largest, 1e-3 * normal) << "what would alias is left out";
    }
}

TEST(FactorMaps, CliffsInFrictionStayInTheConeUnderTheHand) {
    for (const FrictionMode law : kLaws)
        for (const auto& [least, most] : {std::pair(0.2, 0.8), std::pair(0.0, 1.0), std::pair(0.0, 10.0)})
            for (const double speed : {0.005, 0.02, 0.1, 1.0})
                strokeFriction(law, least, most, speed);
}

TEST(FactorMaps, AllThreeAtOnceStandStillWithTheHand) {
    for (const FrictionMode law : kLaws) {
        Scene scene = factorPlane(&HapticMaterial::friction, 0.1, 1.0);
        HapticMaterial& haptic = scene.materials[0].haptic;
        FactorMap map = *haptic.friction.value;
        haptic.stiffnessMap = {map, HapticSource::Touchstone};
        haptic.dampingMap = {map, HapticSource::Touchstone};
        haptic.staticFriction = {0.9f, HapticSource::Touchstone};
        haptic.dynamicFriction = {0.5f, HapticSource::Touchstone};
        haptic.damping = {2.0f, HapticSource::Touchstone};
        HapticSettings s = felt(TextureMode::Law);
        s.friction = law;
        TouchBench bench(scene, s);
        bench.step({-0.02, 0.003, 0.01});
        bench.moveTo({-0.02, 0.003, -5e-4}, 0.05);
        for (int stop = 1; stop < 40; ++stop) { // all over the cliffs, 0.7 texels apart
            bench.moveTo({-0.02 + 0.7 * kTexel * stop, 0.003, -5e-4}, 0.02);
            EXPECT_EQ(held(bench), 0.0) << settingValue(s, "friction") << " at " << bench.output.hip.x;
        }
    }
}

} // namespace
} // namespace touchstone::test::factor_maps_test
