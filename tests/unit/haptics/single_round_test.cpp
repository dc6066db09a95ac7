// forceShading=singleRound: the two passes of [000 §4] once a tick, against their closed form and against the
// fixed point that forceShading=twoPass comes to.

#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace touchstone::test::single_round_test {
namespace {

constexpr double kPi = 3.141592653589793, kStiffness = 1000.0;

HapticSettings shadedBy(ShadingMode mode) {
    HapticSettings s;
    s.forceShading = mode;
    s.texture = TextureMode::Off;
    s.friction = FrictionMode::Off;
    s.stiffness = kStiffness;
    return s;
}

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// A facet of the ten-sided prism of [000 Fig. 6] at x = apothem, z along it, as the proxy's centre sees it.
/// Interpolation gives the normal (a, z) / |(a, z)| there: that of the circle round the prism.
struct Facet {
    double apothem; ///< m
    double skin;    ///< m, of the centre above it

    /// The second pass's place for the HIP (x, z) and the normal of the place `from`.
    [[nodiscard]] double round(double from, double x, double z) const {
        const double size = std::hypot(apothem, from), nx = apothem / size, nz = from / size;
        return z + nz * (nx * (apothem + skin - x) + nz * (from - z));
    }
    /// Where rounds end for a HIP d below it: on the ray from the axis, z a / (a - d) for a proxy of no size.
    [[nodiscard]] double fixedPoint(double x, double z) const {
        double at = z;
        for (int i = 0; i < 200; ++i)
            at = round(at, x, z);
        return at;
    }
};

/// Pressed into the middle of the facet at +x.
TouchBench onFacet(ShadingMode mode, double depth, Facet& facet) {
    facet.apothem = 0.05 * std::cos(kPi / 10.0);
    TouchBench bench(sceneOf(assets::prism(10, 0.05, 0.2, true)), shadedBy(mode));
    bench.step({0.06, 0.0, 0.0});
    bench.moveTo({facet.apothem - depth, 0.0, 0.0}, 0.1);
    facet.skin = bench.output.proxy.x - facet.apothem;
    return bench;
}

TEST(SingleRound, IsTheRecursionOfItsPaperOnAFacet) {
    for (const double depth : {1e-3, 5e-3, 0.02})
        for (const double speed : {0.0, 1e-5, 1e-4}) { // m a tick
            Facet facet{};
            TouchBench bench = onFacet(ShadingMode::SingleRound, depth, facet);
            EXPECT_GT(facet.skin, 0.0);
            EXPECT_LT(facet.skin, 1e-6);
            const double x = facet.apothem - depth;
            double at = bench.output.proxy.z, worst = 0.0;
            for (int i = 1; i <= 60; ++i) {
                const double z = 3e-3 + speed * i; // a jump to 3 mm off the middle, then as fast as said
                at = facet.round(at, x, z);
                bench.step({x, 0.0, z});
                worst = std::max(worst, std::abs(bench.output.proxy.z - at));
                ASSERT_LT(std::abs(bench.output.proxy.x - facet.apothem - facet.skin), 1e-9);
            }
            EXPECT_LT(worst, 2e-8) << "float vertices and normals; depth " << depth << ", step " << speed;
        }
}

TEST(SingleRound, AHandAtRestComesToTheFixedPointByDepthOverRadiusATick) {
    for (const double depth : {1e-3, 5e-3, 0.02}) {
        Facet facet{};
        TouchBench single = onFacet(ShadingMode::SingleRound, depth, facet);
        TouchBench both = onFacet(ShadingMode::TwoPass, depth, facet);
        const double x = facet.apothem - depth, z = 2e-3, end = facet.fixedPoint(x, z);
        both.step({x, 0.0, z});
        EXPECT_NEAR(both.output.proxy.z, end, 5e-9) << "the fixed point in one tick";
        EXPECT_NEAR(end, z * facet.apothem / (facet.apothem - depth), 1e-6);
        const double a2 = facet.apothem * facet.apothem;
        const double shrinks = (depth * facet.apothem + end * end) / (a2 + end * end);
        double before = 0.0;
        int measured = 0;
        for (int i = 0; i < 40; ++i) {
            const double error = std::abs(single.step({x, 0.0, z}).proxy.z - end);
            // The derivative of the round there.
            if (i > 0 && before < 1e-4 && before > 1e-7) {
                EXPECT_NEAR(error / before, shrinks, 0.02 * shrinks) << i;
                ++measured;
            }
            before = error;
        }
        EXPECT_LT(before, 2e-8);
        EXPECT_GE(measured, 2);
        EXPECT_LT(angleBetween(both.output.force, single.output.force), 1e-4);
    }
}

/// Mean angle of the force behind the radius of the hand, rad, on a cylinder of 400 facets.
double lagOnCylinder(ShadingMode mode, double depth, double step) {
    constexpr double kR = 0.05;
    TouchBench bench(sceneOf(assets::prism(400, kR, 0.2, true)), shadedBy(mode));
    const auto hand = [&](double angle, double lift) {
        return (kR - depth + lift) * glm::dvec3(std::cos(angle), 0.0, std::sin(angle));
    };
    for (double lift = 0.01; lift > 0.0; lift -= 1e-4)
        bench.step(hand(0.0, lift));
    double sum = 0.0;
    constexpr int kTicks = 2000, kFrom = 200;
    for (int i = 0; i < kTicks; ++i) {
        const double angle = step / (kR - depth) * i;
        const glm::dvec3 force = bench.step(hand(angle, 0.0)).force;
        if (i >= kFrom)
            sum += std::sin(angle) * force.x / glm::length(force) -
                   std::cos(angle) * force.z / glm::length(force);
    }
    return sum / (kTicks - kFrom);
}

TEST(SingleRound, OnACylinderTheForceLagsByTheTurnOfATick) {
    // The proxy at angle phi, the HIP at theta: phi' = phi + atan((1 - q) sin(theta - phi)) with q = d / R,
    // so that a steady stroke of w a tick has sin(psi) = tan(w) / (1 - q) with psi = theta - phi before the
    // round, the proxy psi - w behind the hand, and the force w / (1 - q) behind the radius.
    constexpr double kR = 0.05;
    for (const double depth : {5e-4, 1e-3, 5e-3})
        for (const double step : {2e-5, 1e-4}) {
            const double q = depth / kR, w = step / (kR - depth);
            const double behind = std::asin(std::tan(w) / (1.0 - q)) - w;
            const double lag = std::atan2(std::sin(behind), std::cos(behind) - (1.0 - q));
            EXPECT_NEAR(lag, w / (1.0 - q), 0.01 * lag);
            const double single = lagOnCylinder(ShadingMode::SingleRound, depth, step);
            const double fixed = lagOnCylinder(ShadingMode::TwoPass, depth, step);
            std::printf("depth %.1f mm, %.2f m/s: single round %.4f degrees behind, closed form %.4f, fixed "
                        "point %.5f\n",
                        1e3 * depth, 1e3 * step, single * 180.0 / kPi, lag * 180.0 / kPi,
                        fixed * 180.0 / kPi);
            EXPECT_NEAR(single, lag, 0.05 * lag);
            EXPECT_LT(std::abs(fixed), 0.05 * lag);
        }
}

TEST(SingleRound, FlatFacetsAreFeltAsWithoutShading) {
    const assets::Shape box = assets::box(glm::dvec3(0.1), 3);
    TouchBench single(sceneOf(box), shadedBy(ShadingMode::SingleRound));
    TouchBench off(sceneOf(box), shadedBy(ShadingMode::Off));
    for (TouchBench* bench : {&single, &off})
        bench->step({0.0, 0.06, 0.004});
    int contacts = 0;
    for (int i = 0; i < 1200; ++i) {
        const double a = 5e-3 * i;
        const glm::dvec3 hip(0.055 * std::sin(a), 0.0485 + 0.003 * std::cos(3.0 * a), 0.004 + 0.03 * a / 6.0);
        single.step(hip);
        off.step(hip);
        ASSERT_EQ(single.output.force, off.output.force) << i;
        contacts += off.output.contacts > 0;
    }
    EXPECT_GT(contacts, 300);
}

/// The upper half of a tube that lies along y, felt from its inside: `sides` facets, radial normals.
assets::Shape trough(double radius, int sides) {
    assets::Shape shape;
    for (int i = 0; i <= sides; ++i) {
        const double angle = kPi * (static_cast<double>(i) / sides - 0.5);
        for (const double y : {-0.05, 0.05}) {
            shape.positions.emplace_back(radius * std::cos(angle), y, radius * std::sin(angle));
            shape.normals.emplace_back(-std::cos(angle), 0.0, -std::sin(angle));
        }
    }
    for (uint32_t i = 0; i < static_cast<uint32_t>(sides); ++i)
        for (const uint32_t k : {0u, 1u, 2u, 2u, 1u, 3u})
            shape.indices.push_back(2 * i + k);
    return shape;
}

TEST(SingleRound, InAHollowPressedDeeperThanItsRadiusTheRoundsDoNotConverge) {
    // Its error is multiplied by -d / R in every tick: a hand that holds still feels the force swing.
    constexpr double kR = 5e-3;
    const auto swing = [&](ShadingMode mode, double depth) {
        TouchBench bench(sceneOf(trough(kR, 32)), shadedBy(mode));
        const double angle = 0.02;
        bench.step({0.0, 0.0, 0.0});
        bench.moveTo((kR + depth) * glm::dvec3(std::cos(angle), 0.0, std::sin(angle)), 0.1);
        const glm::dvec3 still = bench.output.hip;
        glm::dvec3 last(0.0);
        double most = 0.0;
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 force = bench.step(still).force;
            if (i >= 300)
                most = std::max(most, glm::length(force - last));
            last = force;
        }
        EXPECT_GT(bench.output.contacts, 0u);
        return most;
    };
    EXPECT_LT(swing(ShadingMode::SingleRound, 0.5 * kR), 1e-4);
    const double single = swing(ShadingMode::SingleRound, 1.3 * kR),
                 fixed = swing(ShadingMode::TwoPass, 1.3 * kR);
    std::printf("pressed 6.5 mm into a hollow of 5 mm: %.4f N to and fro, fixed point %.2e N\n", single,
                fixed);
    EXPECT_GT(single, 0.1);
    EXPECT_LT(fixed, 1e-6);
}

} // namespace
} // namespace touchstone::test::single_round_test
