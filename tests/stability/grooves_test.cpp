// Where surfaces meet: grooves, pits, corners, planes that are nearly one.

#include "tests/stability/trial.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::test {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kDegree = kPi / 180.0;

/// A V along z, opening upwards by `angle` (rad), walls 60 mm high, bottom line at the origin.
assets::Shape groove(double angle) {
    const double x = 0.06 * std::sin(0.5 * angle), y = 0.06 * std::cos(0.5 * angle);
    std::vector<glm::dvec3> corners;
    addQuad(corners, {0, 0, -0.05}, {0, 0, 0.05}, {x, y, 0.05}, {x, y, -0.05});
    addQuad(corners, {-x, y, -0.05}, {-x, y, 0.05}, {0, 0, 0.05}, {0, 0, -0.05});
    return soup(corners);
}

TEST(Grooves, TheBottomOfAVHoldsThePressAndLetsGo) {
    for (const double angle : {20.0, 5.0})
        for (const Variant& v : allVariants())
            for (const double speed : allSpeeds()) {
                SCOPED_TRACE(std::to_string(angle) + " degrees " + v.name() + " at " + std::to_string(speed) +
                             " m/s");
                TouchBench bench(sceneOf(groove(angle * kDegree)), v.settings());
                Gauge gauge;
                const auto take = [&](const HapticOutput& out) { gauge.take(out); };
                bench.step({0.0, 0.08, 0.01});
                bench.moveTo({0.0005, -0.01, 0.01}, speed, take);
                // A sphere of radius r comes to rest with its centre r / sin(angle / 2) above the bottom
                // line.
                const double skin = 0.5 * kWeldTolerance * bench.scene->objects[0]->diagonal *
                                    bench.scene->objects[0]->workspaceFromObject.scale;
                const double bottom = std::max(v.radius, skin) / std::sin(0.5 * angle * kDegree);
                EXPECT_NEAR(bench.output.proxy.y, bottom, 1e-6);
                EXPECT_NEAR(bench.output.proxy.x, 0.0, 1e-6);
                EXPECT_LT(holdStill(bench, 100), 1e-9);
                // Sideways inside the walls changes nothing but the force.
                bench.moveTo({-0.002, -0.01, -0.02}, speed, take);
                EXPECT_NEAR(bench.output.proxy.y, bottom, 1e-6);
                EXPECT_NEAR(bench.output.proxy.z, -0.02, 1e-6);
                bench.moveTo({0.0, 0.08, 0.01}, speed, take);
                EXPECT_EQ(bench.output.contacts, 0u);
                EXPECT_EQ(gauge.measured().notFinite, 0);
            }
}

TEST(Grooves, AThreePlaneCornerWithFrictionHoldsStill) {
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        std::vector<glm::dvec3> corners;
        addQuad(corners, {0, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, 0});
        addQuad(corners, {0, 0, 0}, {0, 0.1, 0}, {0, 0.1, 0.1}, {0, 0, 0.1});
        addQuad(corners, {0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0});
        HapticSettings s = v.settings();
        s.friction = FrictionMode::Zilles;
        s.staticFriction = 0.5;
        s.dynamicFriction = 0.4;
        TouchBench bench(sceneOf(soup(corners)), s);
        bench.step({0.05, 0.05, 0.05});
        Gauge gauge;
        const auto take = [&](const HapticOutput& out) { gauge.take(out); };
        bench.moveTo({-0.002, -0.003, -0.004}, 0.05, take);
        const double r = std::max(v.radius, 5e-7 * 0.1 * std::sqrt(3.0));
        // Friction may hold it short of the corner, within the cone and never beyond the walls.
        const glm::dvec3 over = bench.output.proxy - glm::dvec3(r);
        EXPECT_GE(std::min({over.x, over.y, over.z}), -1e-7);
        EXPECT_LT(glm::length(over), 0.5 * bench.output.penetration + 1e-6);
        EXPECT_LT(holdStill(bench, 200), 1e-9);
        bench.moveTo({0.05, 0.05, 0.05}, 0.05, take);
        EXPECT_EQ(bench.output.contacts, 0u);
        EXPECT_EQ(gauge.measured().notFinite, 0);
    }
}

TEST(Grooves, PlanesAThousandthOfADegreeApartAreBothFelt) {
    for (const double sign : {1.0, -1.0}) // valley and ridge
        for (const Variant& v : allVariants()) {
            SCOPED_TRACE(v.name() + (sign > 0 ? " valley" : " ridge"));
            const double rise = sign * 0.05 * std::tan(0.5e-3 * kDegree);
            std::vector<glm::dvec3> corners;
            addQuad(corners, {-0.05, rise, -0.05}, {-0.05, rise, 0.05}, {0, 0, 0.05}, {0, 0, -0.05});
            addQuad(corners, {0, 0, -0.05}, {0, 0, 0.05}, {0.05, rise, 0.05}, {0.05, rise, -0.05});
            TouchBench bench(sceneOf(soup(corners)), v.settings());
            Gauge gauge;
            const auto take = [&](const HapticOutput& out) { gauge.take(out); };
            bench.step({-0.03, 0.01, 0.0});
            bench.moveTo({-0.03, -0.001, 0.0}, 0.05, take);
            gauge.restart();
            bench.moveTo({0.03, -0.001, 0.0}, 0.05, [&](const HapticOutput& out) {
                gauge.take(out);
                EXPECT_NEAR(out.proxy.x, out.hip.x, 1e-6) << "it never sticks";
            });
            // At an edge of dihedral deviation theta the proxy may jump 2 d sin(theta / 2).
            EXPECT_LT(gauge.measured().largestJump, 1000.0 * 0.0015 * 1e-3 * kDegree + 1e-6);
            EXPECT_EQ(gauge.measured().notFinite, 0);
        }
}

TEST(Grooves, PitsOfManyFacetsHoldTheProxyAtTheirBottom) {
    for (const int facets : {4, 7, 16, 32})
        for (const Variant& v : allVariants()) {
            SCOPED_TRACE(std::to_string(facets) + " facets " + v.name());
            std::vector<glm::dvec3> corners;
            for (int i = 0; i < facets; ++i) {
                const double a = 2.0 * kPi * i / facets, b = 2.0 * kPi * (i + 1) / facets;
                corners.insert(corners.end(), {{0, 0, 0},
                                               {0.04 * std::cos(b), 0.03, 0.04 * std::sin(b)},
                                               {0.04 * std::cos(a), 0.03, 0.04 * std::sin(a)}});
            }
            TouchBench bench(sceneOf(soup(corners)), v.settings());
            Gauge gauge;
            bench.step({0.004, 0.05, 0.003});
            bench.moveTo({0.0002, -0.005, -0.0001}, 0.1, [&](const HapticOutput& out) { gauge.take(out); });
            EXPECT_LT(std::hypot(bench.output.proxy.x, bench.output.proxy.z), 2e-6 + 0.1 * v.radius);
            EXPECT_LT(holdStill(bench, 200), 1e-9);
            EXPECT_EQ(gauge.measured().notFinite, 0);
            EXPECT_LT(gauge.measured().largestJump, 1e-3);
        }
}

} // namespace
} // namespace touchstone::test
