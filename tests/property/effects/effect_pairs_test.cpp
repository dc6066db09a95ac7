// Every two effects together, on every body under every stroke: the proxy is on the surface, and the command
// within its limits. The full product is effect_sweep.cpp.

#include "tests/property/effects/effect_checks.h"
#include "tests/support/shared_files.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace touchstone::test {
namespace {

class EffectPairs : public testing::TestWithParam<EffectBody> {};

TEST_P(EffectPairs, LeaveTheProxyOnTheSurface) {
    const EffectBody body = GetParam();
    if (effectWorld(body) == nullptr)
        GTEST_SKIP() << kNoModels;
    std::printf("%s\n", effectHead().c_str());
    EffectFigures all;
    unsigned seed = 1000 * static_cast<unsigned>(body);
    for (const EffectStroke stroke : kEffectStrokes) {
        EffectFigures sum;
        for (const EffectCase& c : effectPairs(body, stroke, seed))
            sum += checkEffects(c, ++seed, 100);
        sum.name = strokeName(body, stroke);
        std::printf("%s\n", effectLine(sum).c_str());
        all += sum;
    }
    expectFewLate(all);
}

/// Points, made to be compared with: their proxy may be off the surface, and is where the walk or the rays
/// miss something. What they command keeps the limits all the same.
TEST_P(EffectPairs, OfTheComparisonMethodsKeepTheLimits) {
    const EffectBody body = GetParam();
    if (effectWorld(body) == nullptr)
        GTEST_SKIP() << kNoModels;
    std::printf("%s\n", effectHead().c_str());
    for (const ContactMethod method : {ContactMethod::Neighbourhood, ContactMethod::Rays})
        for (const EffectStroke stroke : kEffectStrokes) {
            EffectFigures sum;
            unsigned seed = 100 * static_cast<unsigned>(stroke);
            for (const EffectCase& c : effectPairs(body, stroke, seed)) {
                const EffectFigures f = runEffects(c, ++seed, 60, method);
                EXPECT_EQ(f.limits, 0) << f.name << ", seed " << seed;
                sum += f;
            }
            EXPECT_GT(sum.contact, 500);
            sum.name = strokeName(body, stroke) +
                       (method == ContactMethod::Rays ? " by rays" : " by the neighbourhood watch");
            std::printf("%s\n", effectLine(sum).c_str());
        }
}

INSTANTIATE_TEST_SUITE_P(On, EffectPairs, testing::ValuesIn(kEffectBodies),
                         [](const auto& param) { return bodyName(param.param, true); });

TEST(Effects, AHandThatCirclesNearTheCentreOfASphereHoldsTheProxyOnIt) {
    constexpr double kR = 0.05, kDepth = 0.95;
    std::printf("%s\n", effectHead().c_str());
    for (const uint32_t segments : {30u, 96u})
        for (const FrictionMode friction : {FrictionMode::Ho, FrictionMode::Zilles,
                                            FrictionMode::Elastoplastic, FrictionMode::VelocityThreshold})
            for (const double speed : {0.1, 0.5}) {
                const EffectCase c{.body = segments == 30 ? EffectBody::Sphere : EffectBody::FineSphere,
                                   .stroke = EffectStroke::Deep,
                                   .shading = ShadingMode::TwoPass,
                                   .friction = friction};
                std::vector<glm::dvec3> path;
                for (double x = 0.06; x > kR * (1.0 - kDepth); x -= speed * 1e-3)
                    path.emplace_back(x, 0.0, 1e-4);
                for (int i = 0; i < 2000; ++i) {
                    const double r = kR * (1.0 - kDepth), a = i * speed * 1e-3 / r;
                    path.emplace_back(r * std::cos(a), 0.9 * r * std::sin(a), 0.43 * r * std::sin(a));
                }
                const EffectFigures f = followEffects(c, 0, path);
                std::printf("%s\n", effectLine(f).c_str());
                EXPECT_GT(f.contact, 2000);
                expectOnSurface(f, 0);
                EXPECT_EQ(f.late, 0) << f.name;
            }
}

TEST(Effects, AProxyThatSticksComesDownWhenItsRadiusShrinksAndIsLiftedWhenItGrows) {
    for (const FrictionMode friction : {FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic,
                                        FrictionMode::VelocityThreshold}) {
        HapticSettings settings;
        settings.friction = friction;
        settings.staticFriction = 0.8;
        settings.dynamicFriction = 0.6;
        settings.proxyRadius = 0.5e-3;
        TouchBench bench(sceneOf(assets::plane(0.2, 0.2, 8, 8)), settings);
        bench.step({0.0, 0.01, 0.003});
        bench.moveTo({0.0, -1e-3, 0.003}, 0.1);
        bench.moveTo({2e-4, -1e-3, 0.003}, 0.1);
        ASSERT_EQ(bench.output.friction, FrictionState::Sticking);
        for (const double radius : {0.1e-3, 0.7e-3}) {
            bench.settings.proxyRadius = radius;
            bench.step(bench.output.hip);
            EXPECT_NEAR(bench.output.proxy.y, radius, 1e-9) << settingValue(settings, "friction");
            EXPECT_EQ(bench.output.friction, FrictionState::Sticking);
        }
    }
}

TEST(Effects, OfTheCoveringArrayHaveEveryPair) {
    const std::vector<EffectCase> product = effectProduct(EffectBody::Box, EffectStroke::Fast);
    EXPECT_EQ(product.size(), 5u * 5 * 5 * 3 * 2 * 2);
    const auto levels = [](const EffectCase& c) {
        return std::array{static_cast<int>(c.shading),  static_cast<int>(c.friction),
                          static_cast<int>(c.texture),  static_cast<int>(1e6 * c.radius),
                          static_cast<int>(c.oneSided), static_cast<int>(c.moving)};
    };
    const std::vector<EffectCase> pairs = effectPairs(EffectBody::Box, EffectStroke::Fast, 3);
    EXPECT_LE(pairs.size(), 40u);
    for (const EffectCase& wanted : product)
        for (size_t a = 0; a < 6; ++a)
            for (size_t b = a + 1; b < 6; ++b) {
                bool found = false;
                for (const EffectCase& c : pairs)
                    found |= levels(c)[a] == levels(wanted)[a] && levels(c)[b] == levels(wanted)[b];
                EXPECT_TRUE(found) << wanted.name();
            }
}

} // namespace
} // namespace touchstone::test
