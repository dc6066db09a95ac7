// Touch against closed forms: on a plane, a box, a sphere and a torus the force is stiffness times depth
// along the outward normal.

#include "haptics/settings/tick_flags.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::test::closed_forms_test {
namespace {

HapticSettings plainSettings(double radius) {
    HapticSettings s;
    s.forceShading = ShadingMode::Off;
    s.texture = TextureMode::Off;
    s.friction = FrictionMode::Off;
    s.proxyRadius = radius;
    s.stiffness = 1000.0;
    return s;
}

class ClosedForms : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(ProxyRadius, ClosedForms, testing::Values(0.0, 0.5e-3));

TEST_P(ClosedForms, PlanePushesWithStiffnessTimesDepth) {
    const double r = GetParam();
    TouchBench bench(sceneOf(assets::plane(0.2, 0.2, 7, 5)), plainSettings(r));
    const double skin = std::max(r, 0.5 * kWeldTolerance * std::sqrt(0.08));
    bench.moveTo({0.011, 0.02, 0.007}, 0.1);
    for (double depth : {0.0005, 0.001, 0.003}) {
        bench.moveTo({0.011, -depth, 0.007}, 0.1);
        EXPECT_NEAR(bench.output.force.y, 1000.0 * (depth + skin), 1e-6);
        EXPECT_NEAR(bench.output.force.x, 0.0, 1e-6);
        EXPECT_NEAR(bench.output.force.z, 0.0, 1e-6);
        EXPECT_NEAR(bench.output.proxy.y, skin, 1e-9);
    }
    // Sliding keeps the proxy over the HIP; leaving ends the force.
    bench.moveTo({-0.06, -0.001, 0.05}, 0.3, [&](const HapticOutput& out) {
        EXPECT_NEAR(out.proxy.y, skin, 1e-9);
        EXPECT_NEAR(out.proxy.x, out.hip.x, 1e-9);
        EXPECT_NEAR(out.proxy.z, out.hip.z, 1e-9);
    });
    bench.moveTo({-0.06, 0.01, 0.05}, 0.1);
    EXPECT_EQ(bench.output.contacts, 0u);
    EXPECT_EQ(glm::length(bench.output.force), 0.0);
}

TEST_P(ClosedForms, PlaneIsTouchableFromBelow) {
    TouchBench bench(sceneOf(assets::plane(0.2, 0.2, 4, 4)), plainSettings(GetParam()));
    bench.moveTo({0.01, -0.02, 0.0}, 0.1);
    bench.moveTo({0.01, 0.002, 0.0}, 0.1);
    EXPECT_LT(bench.output.proxy.y, 0.0);
    EXPECT_LT(bench.output.force.y, -2.0);
}

TEST_P(ClosedForms, BoxFacesEdgesAndCorners) {
    const double r = GetParam();
    TouchBench bench(sceneOf(assets::box({0.1, 0.1, 0.1}, 3)), plainSettings(r));
    const double skin = std::max(r, 0.5 * kWeldTolerance * 0.1 * std::sqrt(3.0));
    bench.moveTo({0.0, 0.08, 0.0}, 0.1);
    bench.moveTo({0.01, 0.049, 0.02}, 0.1);
    EXPECT_NEAR(bench.output.force.y, 1000.0 * (0.001 + skin), 1e-6);
    // Over the edge: the proxy leaves the top and ends on the side, the HIP 1 mm deep under it.
    bench.moveTo({0.06, 0.049, 0.02}, 0.1);
    EXPECT_EQ(bench.output.contacts, 0u);
    bench.moveTo({0.049, 0.0, 0.02}, 0.1);
    EXPECT_NEAR(bench.output.force.x, 1000.0 * (0.001 + skin), 1e-6);
    // Into an inner corner of two boxes' walls there is no such corner on one box; the outer corner: along
    // the diagonal the force splits evenly.
    bench.moveTo({0.08, 0.08, 0.08}, 0.1);
    bench.moveTo({0.0499, 0.0499, 0.0499}, 0.1);
    EXPECT_GT(bench.output.contacts, 0u);
}

TEST_P(ClosedForms, ThreePlaneCornerHoldsTheProxyInIt) {
    // A room seen from inside: three walls meet at the origin.
    Scene scene = sceneOf(assets::plane(0.2, 0.2, 3, 3));
    glm::dmat4 wallX(1.0), wallZ(1.0);
    wallX[0] = {0, -1, 0, 0}, wallX[1] = {1, 0, 0, 0}; // y -> x
    wallZ[1] = {0, 0, 1, 0}, wallZ[2] = {0, -1, 0, 0}; // y -> z
    addShape(scene, assets::plane(0.2, 0.2, 3, 3), wallX);
    addShape(scene, assets::plane(0.2, 0.2, 3, 3), wallZ);
    TouchBench bench(scene, plainSettings(GetParam()));
    const double skin = std::max(GetParam(), 0.5 * kWeldTolerance * std::sqrt(0.08));
    bench.moveTo({0.03, 0.03, 0.03}, 0.1);
    bench.moveTo({-0.001, -0.002, -0.003}, 0.1);
    EXPECT_EQ(bench.output.planeCount, 3u);
    EXPECT_NEAR(bench.output.force.x, 1000.0 * (0.001 + skin), 1e-5);
    EXPECT_NEAR(bench.output.force.y, 1000.0 * (0.002 + skin), 1e-5);
    EXPECT_NEAR(bench.output.force.z, 1000.0 * (0.003 + skin), 1e-5);
}

TEST_P(ClosedForms, SphereProxyStaysOnTheMeshAndForceIsStiffnessTimesPenetration) {
    const double r = GetParam();
    HapticSettings s = plainSettings(r);
    s.forceShading = ShadingMode::TwoPass;
    TouchBench bench(sceneOf(assets::sphere(0.05, 30, 30)), s);
    bench.moveTo({0.0, 0.02, 0.08}, 0.1);
    bench.moveTo({0.0, 0.01, 0.0478}, 0.1);
    int touched = 0;
    for (int i = 0; i < 2000; ++i) {
        const double a = 0.002 * i;
        const glm::dvec3 direction =
            glm::normalize(glm::dvec3(std::sin(a), 0.3 * std::sin(0.7 * a) + 0.2, std::cos(a)));
        bench.step(0.049 * direction);
        if (i < 50)
            continue;
        ASSERT_GT(bench.output.contacts, 0u);
        ++touched;
        const glm::dvec3 f = bench.output.force;
        EXPECT_NEAR(glm::length(f), 1000.0 * bench.output.penetration, 1e-6);
        // Lat-long sphere 30 x 30: facets stand up to R (1 - cos(6 deg)) = 0.27 mm inside the sphere.
        EXPECT_NEAR(glm::length(bench.output.proxy), 0.05 + r, 3.5e-4);
        const double tilt = std::acos(std::min(1.0, glm::dot(glm::normalize(f), direction)));
        EXPECT_LT(tilt, 0.02) << "tick " << i; // 1.1 degrees
    }
    EXPECT_GT(touched, 1900);
}

TEST_P(ClosedForms, TorusHoldsOnItsSaddleForMinutes) {
    TouchBench bench(sceneOf(assets::torus(0.06, 0.025, 108, 30)), plainSettings(GetParam()));
    bench.step({0.0, 0.0, 0.0}); // in the hole, outside the tube
    ASSERT_FALSE(has(bench.output.flags, TickFlag::StartedInside));
    // Press 1 mm into the inner side and run round it 40 times.
    bench.moveTo({0.036, 0.0, 0.0}, 0.1);
    for (int i = 0; i < 40000; ++i) {
        const double a = 2.0 * 3.141592653589793 * i / 1000.0;
        bench.step({0.036 * std::cos(a), 0.036 * std::sin(a), 0.004 * std::sin(0.37 * a)});
        ASSERT_LT(std::hypot(bench.output.proxy.x, bench.output.proxy.y), 0.0362)
            << "fell through at tick " << i;
        ASSERT_GT(bench.output.penetration, 1e-4);
    }
}

TEST(ClosedForm, AStartInsideFeelsNothingUntilOutside) {
    TouchBench bench(sceneOf(assets::sphere(0.05, 20, 30)), plainSettings(0.5e-3));
    bench.moveTo({0.0, 0.0, 0.0}, 0.1);
    EXPECT_TRUE(has(bench.output.flags, TickFlag::StartedInside));
    bench.moveTo({0.0, 0.045, 0.0}, 0.1,
                 [](const HapticOutput& out) { EXPECT_EQ(glm::length(out.force), 0.0); });
    bench.moveTo({0.0, 0.06, 0.0}, 0.1);
    EXPECT_FALSE(has(bench.output.flags, TickFlag::StartedInside));
    bench.moveTo({0.0, 0.048, 0.0}, 0.1);
    EXPECT_GT(bench.output.force.y, 1.0);
}

TEST(ClosedForm, FrictionHoldsBelowTheConeAndSlipsBeyondIt) {
    HapticSettings s = plainSettings(0.0);
    s.friction = FrictionMode::Zilles;
    s.staticFriction = 0.5;
    s.dynamicFriction = 0.3;
    TouchBench bench(sceneOf(assets::plane(0.2, 0.2, 3, 3)), s);
    bench.moveTo({0.0, 0.01, 0.0}, 0.1);
    bench.moveTo({0.0, -0.002, 0.0}, 0.1);
    const glm::dvec3 stuck = bench.output.proxy;
    bench.moveTo({0.0009, -0.002, 0.0}, 0.01);
    EXPECT_EQ(bench.output.proxy, stuck) << "sticking is exact to the last bit";
    EXPECT_NEAR(bench.output.force.x, -0.9, 1e-3);
    bench.moveTo({0.0015, -0.002, 0.0}, 0.01);
    EXPECT_GT(bench.output.proxy.x, stuck.x) << "beyond mu_s N it has slipped";
    EXPECT_LE(-bench.output.force.x, 0.5 * bench.output.force.y + 1e-6);
    EXPECT_GE(-bench.output.force.x, 0.3 * bench.output.force.y - 1e-3);
}

/// A wall slides over the sheet on which the proxy is held and pushes it along, for the smallest radii of a
/// wall smaller and larger than the sheet, too.
TEST(ClosedForm, AWallThatSlidesAlongASheetPushesTheProxyAlong) {
    for (const double radius : {0.0, 0.5e-3})
        for (const double side : {0.01, 0.03, 0.3}) {
            Scene scene = sceneOf(assets::plane(0.1, 0.1, 3, 3));
            glm::dmat4 aside(1.0);
            aside[3] = glm::dvec4(0.025 + 0.5 * side, 0.002, 0.001, 1.0); // its near wall at x = 0.025
            addShape(scene, assets::box(glm::dvec3(side)), aside);
            HapticSettings settings;
            settings.proxyRadius = radius;
            settings.forceShading = ShadingMode::Off;
            TouchBench bench(scene, settings);
            bench.motions = bench.scene->restMotions;
            bench.step({0.001, 0.01, 0.001});
            bench.moveTo({0.001, -0.001, 0.001}, 0.1);
            for (int i = 1; i <= 300; ++i) {
                ObjectMotion& box = bench.motions[1];
                box.before = box.workspaceFromObject;
                box.workspaceFromObject.translation.x -= 1e-4;
                bench.step({0.001, -0.001, 0.001});
                const double free = std::min(0.001, 0.025 - 1e-4 * i - radius);
                ASSERT_NEAR(bench.output.proxy.x, free, 1e-6) << radius << " " << side << " tick " << i;
                ASSERT_NEAR(bench.output.proxy.y, radius, 1e-6) << radius << " " << side << " tick " << i;
            }
        }
}

TEST(ClosedForm, ABoxThatRisesIntoAStillHipLiftsTheProxy) {
    Scene scene = sceneOf(assets::box({0.1, 0.1, 0.1}));
    glm::dmat4 away(1.0);
    away[3] = {1.0, 0.0, 0.0, 1.0};
    addShape(scene, assets::box({0.1, 0.1, 0.1}), away);
    for (const bool anchorIsOther : {false, true}) {
        TouchBench bench(scene, plainSettings(0.5e-3));
        bench.step(anchorIsOther ? glm::dvec3(0.9, 0.07, 0.0) : glm::dvec3(0.0, 0.07, 0.0));
        bench.moveTo({0.0, 0.07, 0.0}, 20.0);
        bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
        for (int i = 0; i < 300; ++i) {
            bench.motions[0].before = bench.motions[0].workspaceFromObject;
            bench.motions[0].workspaceFromObject.translation.y += 1e-4; // 0.1 m/s, 30 mm in all
            bench.step({0.0, 0.07, 0.0});
        }
        EXPECT_NEAR(bench.output.proxy.y, 0.05 + 0.03 + 0.5e-3, 1e-6);
        EXPECT_NEAR(bench.output.force.y, 1000.0 * (0.01 + 0.5e-3), 1e-3);
    }
}

TEST(ClosedForm, ATipOfMoreFacetsThanATickHoldsLetsTheHandGo) {
    for (const int facets : {1500, 6000}) {
        assets::Shape cone;
        cone.positions.push_back({0.0f, 0.0f, 0.0f});
        for (int i = 0; i < facets; ++i) {
            const double a = 2.0 * 3.141592653589793 * i / facets;
            cone.positions.emplace_back(glm::dvec3(0.03 * std::cos(a), -0.05, 0.03 * std::sin(a)));
            const auto next = static_cast<uint32_t>((i + 1) % facets);
            cone.indices.insert(cone.indices.end(), {0u, next + 1, static_cast<uint32_t>(i) + 1});
        }
        TouchBench bench(sceneOf(cone), plainSettings(0.0));
        bench.step({0.0, 0.02, 0.0});
        bench.moveTo({0.0, -0.002, 0.0}, 0.1);
        if (facets < 4096) {
            EXPECT_GT(bench.output.force.y, 1.0);
        } else {
            EXPECT_TRUE(has(bench.output.flags, TickFlag::StartedInside) ||
                        has(bench.output.flags, TickFlag::CandidatesFull));
        }
        // Out and round to the flank: touch goes on there.
        bench.moveTo({0.0, 0.02, 0.0}, 0.1);
        bench.moveTo({0.06, -0.025, 0.0}, 0.1);
        EXPECT_LT(bench.output.penetration, 1e-9);
        bench.moveTo({0.013, -0.025, 0.0}, 0.1);
        EXPECT_GT(bench.output.force.x, 0.5);
    }
}

TEST(ClosedForm, AGrooveIsNotTurnedAwayByADirectionOfOneWall) {
    assets::Shape groove;
    for (const glm::dvec3& p : {glm::dvec3(-0.05, 0.05, -0.05),
                                {-0.05, 0.05, 0.05},
                                {0, 0, 0.05},
                                {0, 0, -0.05},
                                {0.05, 0.05, 0.05},
                                {0.05, 0.05, -0.05}})
        groove.positions.emplace_back(p);
    groove.indices = {0, 1, 2, 0, 2, 3, 3, 2, 4, 3, 4, 5};
    for (const ShadingMode mode : {ShadingMode::Off, ShadingMode::Direction, ShadingMode::Projected}) {
        HapticSettings s = plainSettings(0.0);
        s.forceShading = mode;
        TouchBench bench(sceneOf(groove), s);
        bench.step({0.0, 0.02, 0.0});
        bench.moveTo({-0.001, -0.003, 0.0}, 0.1);
        EXPECT_NEAR(bench.output.force.x, 1.0, 2e-3);
        EXPECT_NEAR(bench.output.force.y, 3.0, 2e-3);
    }
}

TEST(ClosedForm, FrictionHoldsOnTheMovingObjectThatIsTouchedWhereverTheHandBegan) {
    Scene scene = sceneOf(assets::box({0.1, 0.1, 0.1}));
    glm::dmat4 away(1.0);
    away[3] = {0.3, 0.0, 0.0, 1.0};
    addShape(scene, assets::box({0.1, 0.1, 0.1}), away);
    for (const double start : {0.0, 0.3}) { // nearer to the box at rest, nearer to the belt
        HapticSettings s = plainSettings(0.0);
        s.friction = FrictionMode::Zilles;
        s.staticFriction = s.dynamicFriction = 0.5;
        TouchBench bench(scene, s);
        bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
        bench.step({start, 0.08, 0.0});
        bench.moveTo({0.3, 0.08, 0.0}, 1.0);
        bench.moveTo({0.3, 0.049, 0.0}, 0.1);
        for (int i = 0; i < 200; ++i) {
            bench.motions[1].before = bench.motions[1].workspaceFromObject;
            bench.motions[1].workspaceFromObject.translation.z +=
                5e-5; // the second box runs along at 50 mm/s
            bench.step({0.3, 0.049, 0.0});
        }
        EXPECT_NEAR(bench.output.force.z, 0.5 * bench.output.force.y, 1e-3) << "from " << start;
    }
}

TEST(ClosedForm, TheSameInputsGiveTheSameBits) {
    const Scene scene = sceneOf(assets::torus(0.06, 0.025, 60, 30));
    std::vector<HapticOutput> first;
    for (int run = 0; run < 2; ++run) {
        HapticSettings s;
        s.stiffness = 800.0;
        s.staticFriction = 0.4;
        s.dynamicFriction = 0.3;
        TouchBench bench(scene, s);
        bench.step({0.1, 0.0, 0.0});
        for (int i = 0; i < 3000; ++i) {
            const double a = 1e-3 * i;
            bench.step({0.084 * std::cos(a), 0.084 * std::sin(a), 0.003 * std::sin(7 * a)});
            if (run == 0) {
                first.push_back(bench.output);
            } else {
                const HapticOutput& other = first[static_cast<size_t>(i)];
                ASSERT_EQ(bench.output.proxy, other.proxy);
                ASSERT_EQ(bench.output.force, other.force);
                ASSERT_EQ(bench.output.command.force(), other.command.force());
            }
        }
    }
}

/// Outside an edge by less than its radius, however little, the proxy's centre is on the cylinder about the
/// edge, where the line from the edge through the hand leaves it. It gets there in the tick, in few moves:
/// one move after another along its planes gains the angle e / r alone, e the distance of the hand.
TEST(ClosedForms, AroundARoundedEdgeTheProxyGoesInOneTick) {
    constexpr double kRadius = 0.5e-3, kDegree = 3.141592653589793 / 180.0;
    constexpr double kEdge = static_cast<double>(0.05f); // as the mesh has it
    for (const double out : {5e-6, 5e-5, 2e-4})
        for (const double turn : {10.0, 30.0, 55.0, -10.0, -30.0, -55.0}) {
            TouchBench bench(sceneOf(assets::box(glm::dvec3(0.1))), plainSettings(kRadius));
            const auto at = [](double distance, double degrees) {
                return glm::dvec3(kEdge + distance * std::cos(degrees * kDegree),
                                  kEdge + distance * std::sin(degrees * kDegree), 0.0107);
            };
            const double begin = turn > 0.0 ? 15.0 : 75.0;
            bench.step(at(0.01, begin));
            bench.moveTo(at(out, begin), 0.1);
            EXPECT_LT(glm::distance(bench.output.proxy, at(kRadius, begin)), 1e-9) << out << ", " << turn;
            bench.step(at(out, begin + turn));
            EXPECT_LT(glm::distance(bench.output.proxy, at(kRadius, begin + turn)), 1e-9)
                << out << ", " << turn;
            EXPECT_FALSE(has(bench.output.flags, TickFlag::BudgetReached)) << out << ", " << turn;
            EXPECT_LE(bench.output.iterations, 10u) << out << ", " << turn;
        }
}

/// Touch begins in the frame of the object whose bounding ball is nearest: that of what it will meet first,
/// not of a small one whose middle is nearer.
TEST(ClosedForms, TouchBeginsInTheFrameOfTheNearestObject) {
    for (const bool smallFirst : {false, true}) {
        const assets::Shape large = assets::box(glm::dvec3(1.0)), small = assets::box(glm::dvec3(0.02));
        Scene scene = sceneOf(smallFirst ? small : large);
        glm::dmat4 beside(1.0);
        beside[3] = glm::dvec4(1.0, 0.0, 0.0, 1.0);
        addShape(scene, smallFirst ? large : small, beside);
        TouchBench bench(scene);
        bench.step({smallFirst ? 0.2 : 0.75, 0.0, 0.0}); // within the large one's ball, beside the small one
        EXPECT_EQ(bench.state[0].reference, smallFirst ? 1 : 0);
    }
}

/// A hand that gives way bears its press and no more, in the same direction, friction included; below it
/// nothing changes, to the last bit.
TEST(ClosedForms, AHandThatGivesWayBearsItsPressAlone) {
    HapticSettings settings = plainSettings(0.0);
    settings.friction = FrictionMode::Zilles;
    settings.staticFriction = settings.dynamicFriction = 0.5;
    const Scene plane = sceneOf(assets::plane(0.2, 0.2, 7, 5));
    TouchBench firm(plane, settings), yielding(plane, settings);
    yielding.limits.press = 1.0;
    int gaveWay = 0, bore = 0;
    for (int i = 0; i < 400; ++i) {
        const glm::dvec3 hip(2e-5 * i, 0.001 - 1e-5 * i, 0.003);
        const glm::dvec3 force = firm.step(hip).force;
        const HapticOutput& felt = yielding.step(hip);
        EXPECT_EQ(felt.proxy, firm.output.proxy) << i;
        if (glm::length(force) <= 1.0) {
            EXPECT_EQ(felt.force, force) << i;
            EXPECT_EQ(felt.borne, 1.0) << i;
            bore += glm::length(force) > 0.0 ? 1 : 0;
        } else {
            EXPECT_LT(glm::distance(felt.force, glm::normalize(force)), 1e-14) << i;
            EXPECT_LT(glm::distance(felt.force / felt.borne, force), 1e-14 * glm::length(force)) << i;
            ++gaveWay;
        }
    }
    EXPECT_GT(gaveWay, 100);
    EXPECT_GT(bore, 50);
}

} // namespace
} // namespace touchstone::test::closed_forms_test
