// The friction laws against their formulas, through the whole tick ([000 §4.2], [001 §4.1.1]).

#include "study/truth/brute_force.h"
#include "tests/support/corner.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test::friction_test {

using namespace truth;

namespace {

constexpr double kStiffness = 1000.0, kPi = 3.141592653589793;
constexpr std::array kModels{FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic,
                             FrictionMode::VelocityThreshold};

HapticSettings rubbing(FrictionMode model, double muS, double muD) {
    HapticSettings s;
    s.forceShading = ShadingMode::Off;
    s.texture = TextureMode::Off;
    s.friction = model;
    s.stiffness = kStiffness;
    s.staticFriction = muS;
    s.dynamicFriction = muD;
    return s;
}

std::string nameOf(const TouchBench& bench) {
    return settingValue(bench.settings, "friction");
}

double along(const HapticOutput& out) {
    return std::hypot(out.force.x, out.force.z);
}

/// A hand 1 mm in a plane, just come to rest there.
TouchBench pressed(const HapticSettings& settings, double depth = 1e-3) {
    TouchBench bench(sceneOf(assets::plane(0.2, 0.2, 2, 2)), settings);
    bench.step({-0.05, 0.01, 0.003});
    bench.moveTo({-0.05, -depth, 0.003}, 0.1);
    return bench;
}

TEST(Friction, ZillesSawtoothHasTheAmplitudeAndPeriodOfItsCoefficients) {
    const double muS = 0.5, muD = 0.3;
    for (const double step : {1.07e-5, 3.1e-7}) { // m a tick; the second resolves the edge to 0.1 %
        TouchBench bench = pressed(rubbing(FrictionMode::Zilles, muS, muD));
        const double normal = bench.output.force.y;
        const int period = static_cast<int>((muS - muD) * normal / (kStiffness * step)) + 1;
        double last = 0.0;
        int slips = 0, lastSlip = 0;
        for (int i = 1; slips < 8 && i < 20 * period; ++i) {
            const double force = along(bench.step(bench.output.hip + glm::dvec3(step, 0, 0)));
            EXPECT_NEAR(bench.output.force.y, normal, 1e-9);
            ASSERT_LE(force, muS * normal * (1.0 + 1e-12));
            if (bench.output.friction == FrictionState::Sliding) {
                EXPECT_NEAR(force, muD * normal, 1e-9);
                EXPECT_GT(last, muS * normal - kStiffness * step);
                if (step < 1e-6) {
                    EXPECT_GT(last, 0.999 * muS * normal);
                }
                if (slips > 0) {
                    EXPECT_NEAR(i - lastSlip, period, 1) << "period in ticks";
                }
                lastSlip = i;
                ++slips;
            } else if (i > 1) {
                EXPECT_NEAR(force - last, kStiffness * step, 1e-9) << "the tooth rises with K";
            }
            last = force;
        }
        EXPECT_EQ(slips, 8);
    }
}

TEST(Friction, HoAndElastoplasticSlideAtExactlyTheDynamicCoefficient) {
    const double muS = 0.5, muD = 0.3;
    for (const FrictionMode model : {FrictionMode::Ho, FrictionMode::Elastoplastic})
        for (const double step : {1.07e-5, 3.1e-7}) {
            TouchBench bench = pressed(rubbing(model, muS, muD));
            SCOPED_TRACE(nameOf(bench));
            const double normal = bench.output.force.y;
            double last = 0.0;
            int sliding = 0;
            for (int i = 0; i < 20000 && sliding < 3000; ++i) {
                const double force = along(bench.step(bench.output.hip + glm::dvec3(step, 0, 0)));
                if (bench.output.friction == FrictionState::Sliding) {
                    if (sliding == 0) {
                        EXPECT_LE(last, muS * normal * (1.0 + 1e-12));
                        EXPECT_GT(last, muS * normal - kStiffness * step);
                        if (step < 1e-6) {
                            EXPECT_GT(last, 0.999 * muS * normal);
                        }
                    }
                    ++sliding;
                    ASSERT_NEAR(force, muD * normal, 1e-9) << "tick " << i;
                } else {
                    ASSERT_EQ(sliding, 0) << "no sawtooth";
                    ASSERT_LE(force - last, kStiffness * step + 1e-9);
                }
                last = force;
            }
            EXPECT_EQ(sliding, 3000);
        }
}

TEST(Friction, HoSticksAgainWithKsWhenTheHandTurnsBack) {
    const double muS = 0.5, muD = 0.3;
    TouchBench bench = pressed(rubbing(FrictionMode::Ho, muS, muD));
    const double normal = bench.output.force.y, depth = normal / kStiffness;
    bench.moveTo(bench.output.hip + glm::dvec3(0.005, 0, 0), 0.02);
    ASSERT_EQ(bench.output.friction, FrictionState::Sliding);
    const double point = bench.output.stictionPoint.x, x = bench.output.hip.x;
    EXPECT_NEAR(x - point, depth, 1e-9) << "mu N / k is the depth in both states";
    bench.step({x - 2e-5, bench.output.hip.y, 0.003});
    EXPECT_EQ(bench.output.friction, FrictionState::Sticking);
    EXPECT_NEAR(bench.output.stictionPoint.x, point, 1e-12);
    EXPECT_NEAR(-bench.output.force.x, muS * kStiffness * (depth - 2e-5), 1e-6);
}

TEST(Friction, TenMinutesOfTremorDoNotMoveTheStictionPoint) {
    for (const FrictionMode model : kModels) {
        TouchBench bench = pressed(rubbing(model, 0.5, 0.4));
        SCOPED_TRACE(nameOf(bench));
        // Stretched to a third of what holds.
        const glm::dvec3 rest = bench.moveTo(bench.output.hip + glm::dvec3(1.5e-4, 0, 0), 0.01).hip;
        const glm::dvec3 point = bench.output.stictionPoint;
        std::mt19937 random(7);
        std::uniform_real_distribution<double> tremor(-1e-5, 1e-5);
        int moved = 0;
        for (int i = 0; i < 600000; ++i) {
            bench.step(rest + glm::dvec3(tremor(random), tremor(random), tremor(random)));
            moved += bench.output.stictionPoint != point || bench.output.friction != FrictionState::Sticking;
        }
        EXPECT_EQ(moved, 0);
    }
}

TEST(Friction, TremorNearTheLimitCreepsNoFartherThanTheElasticRange) {
    const double muS = 0.5;
    TouchBench bench = pressed(rubbing(FrictionMode::Elastoplastic, muS, 0.4));
    const double depth = bench.output.force.y / kStiffness;
    const glm::dvec3 rest = bench.moveTo(bench.output.hip + glm::dvec3(0.95 * muS * depth, 0, 0), 0.01).hip;
    const glm::dvec3 point = bench.output.stictionPoint;
    std::mt19937 random(7);
    std::uniform_real_distribution<double> tremor(-1e-5, 1e-5);
    glm::dvec3 late(0.0);
    for (int i = 0; i < 200000; ++i) {
        bench.step(rest + glm::dvec3(tremor(random), 0.0, 0.0));
        if (i == 100000)
            late = bench.output.stictionPoint;
    }
    EXPECT_LT(glm::distance(bench.output.stictionPoint, point), 0.3 * muS * depth + 1e-5);
    EXPECT_LT(glm::distance(bench.output.stictionPoint, late), 2e-6) << "it comes to rest";
}

TEST(Friction, ARisingSlopeSlipsAtTheAngleOfFriction) {
    for (const double mu : {0.2, 0.5, 0.9})
        for (const FrictionMode model : kModels) {
            TouchBench bench = pressed(rubbing(model, mu, 0.8 * mu));
            SCOPED_TRACE(nameOf(bench) + " " + std::to_string(mu));
            // A weight that pulls at the proxy by K times its distance, its direction turning as the plane's
            // slope rises. Ho's spring is softer: its hand goes lower until ks holds the weight.
            const double skin = bench.output.proxy.y, weight = 1e-3;
            const bool soft = model == FrictionMode::Ho;
            double slipped = 0.0;
            const double step = 1e-4;
            for (double angle = 0.0; angle < 1.0 && slipped == 0.0; angle += step) {
                const double x = soft ? bench.output.stictionPoint.x + weight * std::sin(angle) / mu
                                      : bench.output.proxy.x + weight * std::sin(angle);
                bench.step({x, skin - weight * std::cos(angle), 0.003});
                if (bench.output.friction == FrictionState::Sliding)
                    slipped = angle;
            }
            EXPECT_NEAR(slipped, std::atan(mu), 1.01 * step);
        }
}

TEST(Friction, NoneIsNoneAndTenHoldsAndStaysInTheCone) {
    TouchBench off = pressed(rubbing(FrictionMode::Off, 0.5, 0.4));
    for (const FrictionMode model : kModels) {
        TouchBench none = pressed(rubbing(model, 0.0, 0.0)), ten = pressed(rubbing(model, 10.0, 8.0));
        SCOPED_TRACE(nameOf(none));
        EXPECT_EQ(none.output.friction, FrictionState::Free);
        EXPECT_EQ(none.output.force, off.output.force);
        double most = 0.0;
        const double normal = ten.output.force.y;
        ten.moveTo(ten.output.hip + glm::dvec3(0.06, 0, 0), 0.1, [&](const HapticOutput& out) {
            ASSERT_TRUE(std::isfinite(glm::length(out.force)));
            EXPECT_NEAR(out.force.y, normal, 1e-9);
            most = std::max(most, along(out));
            EXPECT_LE(along(out), 10.0 * normal * (1.0 + 1e-12));
        });
        EXPECT_GT(most, 10.0 * normal - kStiffness * 1e-4);
    }
}

/// Three square walls, the free space between them.
assets::Shape threeWalls() {
    assets::Shape shape;
    for (int axis = 0; axis < 3; ++axis) {
        const auto first = static_cast<uint32_t>(shape.positions.size());
        for (const glm::vec2 at :
             {glm::vec2(0, 0), glm::vec2(0.05, 0), glm::vec2(0.05, 0.05), glm::vec2(0, 0.05)}) {
            glm::vec3 p(0.0f);
            p[(axis + 1) % 3] = at.x;
            p[(axis + 2) % 3] = at.y;
            shape.positions.push_back(p);
        }
        for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u})
            shape.indices.push_back(first + k);
    }
    return shape;
}

/// The proxy keeps its radius from every triangle, and the friction force stays within mu_s N.
void expectOnSurfaceAndInCone(const TouchBench& bench, double muS, double& clearance, double& share) {
    const HapticOutput& out = bench.output;
    if (out.contacts == 0)
        return;
    const DeviceState& state = bench.state[0];
    const Similarity& pose =
        bench.scene->restMotions[static_cast<size_t>(state.reference)].workspaceFromObject;
    const HapticObject& object = *bench.scene->objects[static_cast<size_t>(state.reference)];
    const double radius =
        std::max(bench.settings.proxyRadius / pose.scale, 0.5 * kWeldTolerance * object.diagonal);
    const auto nearest = static_cast<double>(bruteNearest(object, LVec3(state.proxy)).distance);
    clearance = std::min(clearance, (nearest - radius) * pose.scale);
    EXPECT_LT(nearest - radius, 1e-6) << "off the surface";
    if (out.friction == FrictionState::Free)
        return;
    const glm::dvec3 free = pose.point(state.frictionless);
    const double friction = glm::length(out.force - kStiffness * (free - out.hip));
    double load = glm::length(free - out.hip); // the sum of the planes' own, where there are several
    load = std::max(load, loadOf(out, free - out.hip));
    share = std::max(share, friction / (muS * kStiffness * load));
}

TEST(Friction, OnACurvedSurfaceAndInACornerTheProxyStaysOnItAndInTheCone) {
    const double muS = 0.6, muD = 0.5;
    for (const FrictionMode model : kModels)
        for (const double radius : {0.0, 0.0005})
            for (const double speed : {0.1, 1.0}) {
                HapticSettings s = rubbing(model, muS, muD);
                s.proxyRadius = radius;
                double clearance = 1.0, share = 0.0;
                TouchBench torus(sceneOf(assets::torus(0.06, 0.025, 40, 20)), s);
                SCOPED_TRACE(nameOf(torus) + " r " + std::to_string(radius) + " at " + std::to_string(speed));
                torus.step({0.1, 0.0, 0.0});
                int contact = 0;
                const int ticks = 1000;
                for (int i = 0; i < ticks; ++i) {
                    // Over the outside, round the tube, through the hole where it is hollow.
                    const double a = speed * 1e-3 / 0.085 * i + 0.5, v = 2.7 * a;
                    const double r = 0.0242 - 0.0008 * std::sin(5.0 * a);
                    const double ring = 0.06 + r * std::cos(v);
                    torus.step({ring * std::cos(a), ring * std::sin(a), r * std::sin(v)});
                    contact += torus.output.contacts > 0;
                    if (i % 5 == 0) // brute force is slow
                        expectOnSurfaceAndInCone(torus, muS, clearance, share);
                }
                EXPECT_GT(contact, ticks / 2);

                // Over edges and corners that stand out, and into a corner of three walls.
                TouchBench box(sceneOf(assets::box({0.1, 0.1, 0.1}, 2)), s);
                box.step({0.0, 0.08, 0.0});
                box.moveTo({0.0, 0.049, 0.0}, speed);
                for (const glm::dvec3 to : {glm::dvec3(0.049, 0.049, 0.01), glm::dvec3(0.0495, 0.02, 0.0495),
                                            glm::dvec3(0.0497, 0.0496, 0.0495), glm::dvec3(0.0, 0.049, 0.0)})
                    box.moveTo(to, speed, [&](const HapticOutput&) {
                        expectOnSurfaceAndInCone(box, muS, clearance, share);
                    });
                TouchBench walls(sceneOf(threeWalls()), s);
                uint32_t most = 0;
                walls.step({0.01, 0.01, 0.01});
                for (const glm::dvec3 to :
                     {glm::dvec3(0.01, -0.001, 0.01), glm::dvec3(-0.002, -0.001, 0.01),
                      glm::dvec3(-0.001, -0.002, -0.001), glm::dvec3(0.004, -0.002, -0.003),
                      glm::dvec3(-0.003, -0.001, 0.002), glm::dvec3(0.002, 0.012, -0.001)})
                    walls.moveTo(to, speed, [&](const HapticOutput& out) {
                        most = std::max(most, out.planeCount);
                        expectOnSurfaceAndInCone(walls, muS, clearance, share);
                    });
                EXPECT_EQ(most, 3u);
                EXPECT_GE(clearance, 0.0);
                EXPECT_LE(share, 1.0 + 1e-9);
            }
}

TEST(Friction, MovingObjectsCarryTheStictionPoint) {
    for (const FrictionMode model : kModels) {
        TouchBench bench(sceneOf(assets::box({0.1, 0.02, 0.1}, 2)), rubbing(model, 0.5, 0.4));
        SCOPED_TRACE(nameOf(bench));
        bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
        bench.step({0.0, 0.02, 0.0});
        bench.moveTo({0.0, 0.009, 0.0}, 0.05);
        bench.moveTo({0.0002, 0.009, 0.0}, 0.05); // stretched, and sticking
        ObjectMotion& motion = bench.motions[0];
        const glm::dvec3 inHand = glm::conjugate(motion.workspaceFromObject.rotation) * bench.output.force;
        const glm::dvec3 point = motion.workspaceFromObject.inversePoint(bench.output.stictionPoint);
        const glm::dvec3 hand = motion.workspaceFromObject.inversePoint(bench.output.hip);
        for (int i = 1; i <= 500; ++i) {
            motion.before = motion.workspaceFromObject;
            motion.workspaceFromObject.rotation = glm::angleAxis(2e-3 * i, glm::dvec3(0, 0, 1));
            motion.workspaceFromObject.translation = {2e-5 * i, 1e-5 * i, 0.0};
            bench.step(motion.workspaceFromObject.point(hand));
            ASSERT_EQ(bench.output.friction, FrictionState::Sticking);
            ASSERT_LT(
                glm::distance(motion.workspaceFromObject.inversePoint(bench.output.stictionPoint), point),
                1e-12);
            ASSERT_LT(glm::distance(glm::conjugate(motion.workspaceFromObject.rotation) * bench.output.force,
                                    inHand),
                      1e-7);
        }
    }
}

} // namespace
} // namespace touchstone::test::friction_test
