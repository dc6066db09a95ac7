// Where surfaces meet: grooves, pits, corners, planes that are nearly one.

#include "tests/stability/hard_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone::test::grooves_test {
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
    for (const double degrees : {20.0, 5.0})
        for (const Variant& v : allVariants())
            for (const double speed : allSpeeds()) {
                const double angle = degrees * kDegree;
                SCOPED_TRACE(std::to_string(degrees) + " degrees " + v.name() + " at " +
                             std::to_string(speed) + " m/s");
                HardCase run(degrees > 10.0 ? "groove 20°" : "groove 5°", sceneFor(groove(angle), v), v);
                run.side([angle](const glm::dvec3& p) { // between both walls
                    return p.y * std::sin(0.5 * angle) - std::abs(p.x) * std::cos(0.5 * angle);
                });
                run.startAt({0.0, 0.08, 0.01});
                run.moveTo({0.0005, -0.01, 0.01}, speed);
                run.hold();
                // A sphere of radius r comes to rest with its centre r / sin(angle / 2) above the bottom
                // line.
                const double bottom = run.effectiveRadius() / std::sin(0.5 * angle);
                // Vertices are floats, good to 6e-8 of the object.
                const double rounding = 6e-8 * 0.1 / std::sin(0.5 * angle);
                EXPECT_NEAR(run.bench.output.proxy.y, bottom, rounding);
                EXPECT_NEAR(run.bench.output.proxy.x, 0.0, rounding);
                // Sideways inside the walls changes nothing but the force.
                run.moveTo({-0.002, -0.01, -0.02}, speed);
                EXPECT_NEAR(run.bench.output.proxy.y, bottom, rounding);
                EXPECT_NEAR(run.bench.output.proxy.z, -0.02, 1e-9);
                run.hold();
                run.leave(speed);
            }
}

assets::Shape threePlanes() {
    std::vector<glm::dvec3> corners;
    addQuad(corners, {0, 0, 0}, {0, 0, 0.1}, {0.1, 0, 0.1}, {0.1, 0, 0});
    addQuad(corners, {0, 0, 0}, {0, 0.1, 0}, {0, 0.1, 0.1}, {0, 0, 0.1});
    addQuad(corners, {0, 0, 0}, {0.1, 0, 0}, {0.1, 0.1, 0}, {0, 0.1, 0});
    return soup(corners);
}

TEST(Grooves, AThreePlaneCornerWithFrictionHoldsStill) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds())
            // Not VelocityThreshold, which steps between mu_s N and b v by its definition
            // (closed_loop/friction_and_steps_test.cpp).
            for (const FrictionMode law :
                 {FrictionMode::Off, FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic}) {
                const bool rubs = law != FrictionMode::Off;
                HapticSettings s = v.settings();
                s.friction = law;
                SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s, friction " +
                             settingValue(s, "friction"));
                if (rubs) {
                    s.staticFriction = 0.5;
                    s.dynamicFriction = 0.4;
                }
                HardCase run(rubs ? "corner of three planes, friction" : "corner of three planes",
                             sceneFor(threePlanes(), v), v, s);
                run.side([](const glm::dvec3& p) { return std::min({p.x, p.y, p.z}); });
                run.startAt({0.05, 0.05, 0.05});
                run.moveTo({-0.002, -0.003, -0.004}, speed);
                run.hold(200);
                const glm::dvec3 over = run.bench.output.proxy - glm::dvec3(run.effectiveRadius());
                if (!rubs) {
                    EXPECT_LT(glm::length(over), 1e-9);
                }
                // Friction may hold it short of the corner, by its coefficient times the depth.
                EXPECT_LT(glm::length(over), 0.5 * run.bench.output.penetration + 1e-9);
                run.moveTo({0.003, -0.004, 0.002}, speed);
                run.hold(200);
                run.leave(speed);
            }
}

TEST(Grooves, PlanesAThousandthOfADegreeApartAreBothFelt) {
    for (const double sign : {1.0, -1.0}) // valley and ridge
        for (const Variant& v : allVariants())
            for (const double speed : allSpeeds()) {
                SCOPED_TRACE(v.name() + (sign > 0 ? " valley" : " ridge") + " at " + std::to_string(speed));
                const double rise = sign * 0.05 * std::tan(0.5e-3 * kDegree);
                std::vector<glm::dvec3> corners;
                addQuad(corners, {-0.05, rise, -0.05}, {-0.05, rise, 0.05}, {0, 0, 0.05}, {0, 0, -0.05});
                addQuad(corners, {0, 0, -0.05}, {0, 0, 0.05}, {0.05, rise, 0.05}, {0.05, rise, -0.05});
                HardCase run("planes 0.001° apart", sceneFor(soup(corners), v), v);
                run.side([rise](const glm::dvec3& p) { return p.y - rise * std::abs(p.x) / 0.05; });
                run.startAt({-0.03, 0.01, 0.0});
                run.moveTo({-0.03, -0.001, 0.0}, speed);
                run.moveTo({0.0, -0.001, 0.0}, speed);
                run.hold();
                run.moveTo({0.03, -0.001, 0.01}, speed);
                EXPECT_NEAR(run.bench.output.proxy.x, 0.03, 0.0015 * 1e-3 * kDegree) << "it never sticks";
                run.leave(speed);
            }
}

/// A pit of `facets` triangles that meet in its bottom at the origin, 30 mm deep, 80 mm wide.
assets::Shape pit(int facets) {
    std::vector<glm::dvec3> corners;
    for (int i = 0; i < facets; ++i) {
        const double a = 2.0 * kPi * i / facets, b = 2.0 * kPi * (i + 1) / facets;
        corners.insert(corners.end(), {{0, 0, 0},
                                       {0.04 * std::cos(b), 0.03, 0.04 * std::sin(b)},
                                       {0.04 * std::cos(a), 0.03, 0.04 * std::sin(a)}});
    }
    return soup(corners);
}

TEST(Grooves, AHandThatCreepsInAPitOfManyFacetsAndThenLeavesIsLetGo) {
    // More facets round the bottom than the solver likes to keep at hand: the ball of those that it gathers
    // shrinks with the creeping hand, and must grow again with the leaving one.
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        HardCase run("pit of 48 facets, creep then leave", sceneFor(pit(48), v), v);
        run.startAt({0.0, 0.05, 0.0});
        run.moveTo({0.0, -0.001, 0.0}, 0.5);
        for (int i = 1; i <= 4; ++i)
            run.moveTo({i % 2 == 0 ? 0.0 : 2e-5, -0.001, 1e-5 * i}, 1e-4);
        run.leave(5.0);
    }
}

TEST(Grooves, PitsOfManyFacetsHoldTheProxyAtTheirBottom) {
    for (const int facets : {4, 7, 16, 32})
        for (const Variant& v : allVariants())
            for (const double speed : allSpeeds()) {
                SCOPED_TRACE(std::to_string(facets) + " facets " + v.name() + " at " + std::to_string(speed) +
                             " m/s");
                HardCase run("pits of 4 to 32 facets", sceneFor(pit(facets), v), v);
                const double apothem = 0.04 * std::cos(kPi / facets);
                run.side([=](const glm::dvec3& p) { // above every facet
                    double least = INFINITY;
                    for (int i = 0; i < facets; ++i) {
                        const double m = 2.0 * kPi * (i + 0.5) / facets;
                        least =
                            std::min(least, p.y - 0.03 / apothem * (p.x * std::cos(m) + p.z * std::sin(m)));
                    }
                    return least;
                });
                run.startAt({0.004, 0.05, 0.003});
                run.moveTo({0.0002, -0.005, -0.0001}, speed);
                run.hold(200);
                // A sphere rests on all of them; its centre stands over the bottom.
                EXPECT_LT(std::hypot(run.bench.output.proxy.x, run.bench.output.proxy.z), 1e-8);
                run.moveTo({0.001, -0.004, 0.002}, speed);
                run.hold();
                run.leave(speed);
            }
}

} // namespace
} // namespace touchstone::test::grooves_test
