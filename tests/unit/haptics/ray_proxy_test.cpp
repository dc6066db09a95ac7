// The third contact method, the god-object moved by rays, in both precisions: beside the sweep, on what is
// hard, and at its limits (the table in docs/architecture.md).

#include "engine/math/few_planes.h"
#include "haptics/comparison/ray_path.h"
#include "study/truth/brute_force.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/strokes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace touchstone::test::ray_proxy_test {

using namespace truth;

namespace {

constexpr double kPi = 3.141592653589793;

HapticSettings bare(ContactMethod method, Precision precision = Precision::Double) {
    HapticSettings settings;
    settings.contact = method;
    settings.precision = precision;
    settings.forceShading = ShadingMode::Off;
    settings.friction = FrictionMode::Off;
    settings.texture = TextureMode::Off;
    settings.stiffness = 1000.0;
    return settings;
}

class RayProxyIn : public ::testing::TestWithParam<Precision> {
  protected:
    [[nodiscard]] HapticSettings rays() const { return bare(ContactMethod::Rays, GetParam()); }
    /// m that it keeps from a surface of an object of this size, at most, with the rounding of its precision.
    [[nodiscard]] double near(double size) const {
        return size * (GetParam() == Precision::Single ? 2.6e-6 : 5.1e-7);
    }
};

TEST_P(RayProxyIn, AnOpenSheetIsTouchedFromBothSidesAndLeftOverItsBorder) {
    for (const double side : {1.0, -1.0}) {
        TouchBench bench(sceneOf(assets::plane(0.1, 0.1, 5, 5)), rays());
        bench.moveTo({0.013, side * 0.01, 0.007}, 0.5);
        bench.moveTo({0.013, -side * 0.002, 0.007}, 0.5);
        EXPECT_NEAR(bench.output.force.y, side * 2.0, 1e3 * near(0.1));
        EXPECT_EQ(bench.output.planeCount, 1u);
        bench.moveTo({0.049, -side * 0.002, 0.007}, 0.5);
        EXPECT_NEAR(bench.output.proxy.x, 0.049, near(0.1));
        EXPECT_NEAR(bench.output.proxy.y, 0.0, near(0.1));
        bench.moveTo({0.0501, -side * 0.002, 0.007}, 0.5);
        EXPECT_EQ(bench.output.contacts, 0u) << "past the border";
        bench.moveTo({0.0401, -side * 0.002, 0.007}, 0.5);
        EXPECT_EQ(bench.output.contacts, 0u) << "underneath";
        bench.moveTo({0.0401, side * 0.002, 0.007}, 0.5);
        EXPECT_NEAR(bench.output.force.y, -side * 2.0, 1e3 * near(0.1)) << "against it from there";
    }
}

TEST_P(RayProxyIn, AThinPlateHoldsHoweverFastAndDeepItIsPressed) {
    for (const double speed : {0.05, 1.0, 5.0, 50.0}) {
        TouchBench bench(sceneOf(assets::box({0.1, 0.001, 0.1}, 8)), rays());
        bench.step({0.011, 0.02, 0.003});
        bench.moveTo({0.011, -0.003, 0.003}, speed);
        for (int i = 0; i < 10; ++i)
            bench.step({0.011, -0.003, 0.003});
        EXPECT_NEAR(bench.output.proxy.y, 0.0005, near(0.1)) << speed;
    }
}

TEST_P(RayProxyIn, ATripOfMetresIsHeldWhereItBegan) {
    TouchBench bench(sceneOf(assets::sphere(0.05, 30, 30)), rays());
    std::mt19937 random(4);
    std::normal_distribution<double> direction;
    for (int i = 0; i < 300; ++i) {
        const glm::dvec3 d =
            glm::normalize(glm::dvec3(direction(random), direction(random), direction(random)));
        bench.state[0].forgetTouch();
        bench.step(200.0 * d);
        bench.step(-0.02 * d); // 200 m in a tick, to a place inside
        ASSERT_EQ(bench.output.planeCount > 0, true) << i;
        EXPECT_GT(glm::dot(bench.output.proxy, d), 0.04) << i;
        EXPECT_LT(glm::length(bench.output.proxy), 0.0501) << i;
    }
}

/// An inner corner of three squares of 0.1 m.
assets::Shape innerCorner() {
    assets::Shape corner;
    corner.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    for (glm::vec3& p : corner.positions)
        p *= 0.1f;
    corner.indices = {0, 1, 2, 0, 2, 3, 0, 5, 1, 0, 4, 5, 0, 3, 6, 0, 6, 4};
    return corner;
}

TEST_P(RayProxyIn, OneTwoAndThreePlanesHoldTheHip) {
    TouchBench ray(sceneOf(innerCorner()), rays()), sweep(sceneOf(innerCorner()), bare(ContactMethod::Sweep));
    struct Station {
        glm::dvec3 to;
        uint32_t planes;
    };
    for (const Station& s : {Station{{0.05, 0.05, 0.05}, 0},
                             {{0.05, 0.05, -0.003}, 1},
                             {{-0.002, 0.05, -0.003}, 2},
                             {{-0.002, -0.004, -0.003}, 3},
                             {{0.05, -0.004, -0.003}, 2},
                             {{0.05, 0.05, 0.05}, 0}}) {
        for (TouchBench* bench : {&ray, &sweep}) {
            bench->moveTo(s.to, 0.2);
            bench->step(s.to);
        }
        EXPECT_LT(glm::length(ray.output.proxy - sweep.output.proxy), 2.0 * near(0.1));
        EXPECT_EQ(ray.output.planeCount, s.planes);
    }
}

TEST_P(RayProxyIn, GroovesHoldItAsTheyHoldTheSweep) {
    for (const double degrees : {90.0, 20.0, 5.0}) {
        const double half = 0.5 * degrees * kPi / 180.0;
        assets::Shape groove;
        for (const double side : {-1.0, 0.0, 1.0})
            for (const double z : {-0.05, 0.05})
                groove.positions.emplace_back(0.05 * side * std::sin(half),
                                              0.05 * std::abs(side) * std::cos(half), z);
        groove.indices = {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4};
        TouchBench ray(sceneOf(groove), rays()), sweep(sceneOf(groove), bare(ContactMethod::Sweep));
        ray.step({0.0, 0.04, 0.001});
        sweep.step({0.0, 0.04, 0.001});
        for (const glm::dvec2& to : {glm::dvec2{0.0, 0.02},
                                     {0.0, -0.002},
                                     {0.001, -0.001},
                                     {-0.002, -0.0005},
                                     {0.0, -0.003},
                                     {0.0, 0.03}}) {
            for (TouchBench* bench : {&ray, &sweep}) {
                bench->moveTo({to, 0.001}, 0.1);
                bench->step({to, 0.001});
            }
            EXPECT_LT(glm::length(ray.output.proxy - sweep.output.proxy), 2.0 * near(0.1) / std::sin(half))
                << degrees;
            EXPECT_EQ(ray.output.contacts > 0, sweep.output.contacts > 0) << degrees;
        }
    }
}

TEST_P(RayProxyIn, TheTorusHoldsOnItsSaddleForAMinute) {
    TouchBench bench(sceneOf(assets::torus(0.06, 0.025, 90, 60)), rays());
    int flagged = 0;
    for (int i = 0; i < 60000; ++i) {
        const double a = 1e-4 * i / 0.0846 * 3.0, v = 0.37 * a, r = 0.023 + 1e-4 * std::max(0, 200 - i);
        const double ring = 0.06 + r * std::cos(v);
        bench.step({ring * std::cos(a), ring * std::sin(a), r * std::sin(v)});
        flagged += has(bench.output.flags, TickFlag::BudgetReached) ? 1 : 0;
        if (i > 250) {
            ASSERT_GT(bench.output.contacts, 0u) << "fell through at tick " << i;
            ASSERT_LT(bench.output.penetration, 2.1e-3) << i;
        }
    }
    EXPECT_LT(flagged, 60) << "crept round a vertex, held all the while";
}

/// A hand that wanders at random through and over a closed body for minutes is never let in.
TEST_P(RayProxyIn, NoWanderingLeadsInside) {
    for (const auto& shape : {assets::sphere(0.05, 40, 40), assets::torus(0.06, 0.025, 60, 40),
                              assets::boxWithSharedCorners({0.08, 0.09, 0.1})}) {
        TouchBench bench(sceneOf(shape), rays());
        const HapticObject& object = *bench.scene->objects.front();
        std::mt19937 random(17);
        std::normal_distribution<double> step(0.0, 1.0);
        glm::dvec3 hip(0.1, 0.01, 0.0), velocity(0.0);
        int touching = 0;
        for (int i = 0; i < 20000; ++i) {
            velocity = 0.98 * velocity + 2e-4 * glm::dvec3(step(random), step(random), step(random));
            hip = 0.998 * (hip + 0.2 * velocity);
            bench.step(hip);
            touching += bench.output.contacts > 0 ? 1 : 0;
            ASSERT_FALSE(i % 7 == 0 && insideObject(object, bench.state[0].proxy)) << i;
        }
        EXPECT_GT(touching, 4000);
    }
}

TEST_P(RayProxyIn, MixedWindingsChangeNothing) {
    const assets::Shape sphere = assets::sphere(0.05, 24, 24);
    assets::Shape mixed = sphere;
    std::mt19937 random(3);
    for (size_t t = 0; t < mixed.triangleCount(); ++t)
        if (random() % 2 == 0)
            std::swap(mixed.indices[3 * t + 1], mixed.indices[3 * t + 2]);
    TouchBench plain(sceneOf(sphere), rays()), turned(sceneOf(mixed), rays());
    int touching = 0;
    for (int i = 0; i < 2000; ++i) {
        const double a = 1e-3 * i / 0.5, r = 0.0495 + 2e-3 * std::cos(0.02 * i);
        const glm::dvec3 hip(r * std::cos(a), 0.3 * r, r * std::sin(a) * 0.9);
        plain.step(hip);
        turned.step(hip);
        ASSERT_LT(glm::length(plain.output.proxy - turned.output.proxy), near(0.1)) << i;
        touching += turned.output.contacts > 0 ? 1 : 0;
    }
    EXPECT_GT(touching, 300);
}

TEST_P(RayProxyIn, OneSidedSheetsAreThereFromTheirFront) {
    Scene scene = sceneOf(assets::plane(0.1, 0.1, 3, 3));
    scene.materials[0].haptic.sides = SideChoice::Front;
    TouchBench bench(scene, rays());
    bench.step({0.004, -0.01, 0.003});
    bench.moveTo({0.004, 0.01, 0.003}, 0.1);
    EXPECT_EQ(bench.output.contacts, 0u) << "from behind";
    EXPECT_EQ(bench.output.penetration < 1e-6, true);
    bench.moveTo({0.004, -0.002, 0.003}, 0.1);
    EXPECT_NEAR(bench.output.force.y, 2.0, 1e3 * near(0.1));
}

TEST_P(RayProxyIn, ScaleAndPlaceChangeNothing) {
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3})
        for (const double offset : {0.0, 1e3}) {
            glm::dmat4 at(scale);
            at[3] = glm::dvec4(offset * scale, 0.0, -offset * scale, 1.0);
            const Scene scene = sceneOf(assets::sphere(0.05, 30, 30), at);
            TouchBench ray(scene, rays()), sweep(scene, bare(ContactMethod::Sweep));
            int touching = 0, apart = 0;
            for (int i = 0; i < 1000; ++i) {
                const double a = 1e-4 * i / 0.05, r = 0.0505 - 2e-3 * std::sin(0.02 * i);
                const glm::dvec3 hip =
                    glm::dvec3(at[3]) + scale * r * glm::dvec3(std::cos(a), 0.1, std::sin(a));
                const HapticOutput &x = ray.step(hip), &y = sweep.step(hip);
                touching += x.contacts > 0 ? 1 : 0;
                apart += glm::length(x.proxy - y.proxy) > scale * 2.0 * near(0.1) + 4e-16 * offset * scale;
            }
            EXPECT_GT(touching, 300) << scale << " " << offset;
            EXPECT_LE(apart, GetParam() == Precision::Single ? 20 : 2) << scale << " " << offset;
        }
}

TEST_P(RayProxyIn, OfSeveralObjectsItTouchesTheOneInFrontAndStopsAtTheNext) {
    Scene scene = sceneOf(assets::box({0.1, 0.02, 0.1}, 1)); // top at y = 0.01
    glm::dmat4 at(1.0);
    at[3] = glm::dvec4(0.03, 0.01, 0.0, 1.0);
    addShape(scene, assets::box({0.02, 0.03, 0.1}, 1), at); // its wall stands at x = 0.02
    TouchBench bench(scene, rays());
    bench.step({0.0, 0.03, 0.001});
    bench.moveTo({0.0, 0.009, 0.001}, 0.2);
    EXPECT_EQ(bench.output.object, 0);
    bench.moveTo({0.028, 0.009, 0.001}, 0.2);
    EXPECT_NEAR(bench.output.proxy.x, 0.02, near(0.1));
    EXPECT_NEAR(bench.output.proxy.y, 0.01, near(0.1));
    EXPECT_EQ(bench.output.planeCount, 2u);
}

/// At the corner of a box the path is as far from its middle as any of its points.
TEST_P(RayProxyIn, AQuickHandMeetsAnotherObjectAtItsCorner) {
    Scene scene = sceneOf(assets::box(glm::dvec3(0.1)));
    glm::dmat4 at(1.0);
    at[3] = glm::dvec4(0.3, 0.0, 0.0, 1.0);
    addShape(scene, assets::box(glm::dvec3(0.1)), at);
    for (const double side : {1.0, -1.0}) {
        TouchBench bench(scene, rays());
        bench.step({0.0, 0.06, 0.0});
        bench.moveTo({0.0, 0.049, 0.001}, 0.2);
        ASSERT_EQ(bench.output.object, 0);
        bench.moveTo({0.0, 0.06, 0.0}, 0.2);
        bench.moveTo({0.3 + side * 0.049, 0.053, 0.049}, 0.5);
        bench.step({0.3 + side * 0.049, 0.0475, 0.049});
        EXPECT_EQ(bench.output.object, 1) << side;
        EXPECT_NEAR(bench.output.proxy.y, 0.05, near(0.1) + 1e-7) << side;
    }
}

TEST_P(RayProxyIn, ABoxThatRisesIntoAStillHipHoldsItAndCarriesIt) {
    Scene scene = sceneOf(assets::box(glm::dvec3(0.04)));
    glm::dmat4 aside(1.0);
    aside[3] = glm::dvec4(0.0, 0.5, 0.0, 1.0);
    addShape(scene, assets::box(glm::dvec3(0.04)),
             aside); // nearer at first: the reference object is another one
    TouchBench bench(scene, rays());
    bench.motions = bench.scene->restMotions;
    const Similarity rest = bench.motions[0].workspaceFromObject;
    Similarity before = rest;
    before.translation.y = -0.5;
    for (int i = 0; i < 100; ++i) {
        Similarity now = rest;
        now.translation.y = i == 0 ? -0.5 : -0.03 + 2.5e-4 * i;
        bench.motions[0] = {now, i == 0 ? now : before};
        before = now;
        bench.step({0.003, 0.0, 0.002});
    }
    EXPECT_EQ(bench.output.object, 0);
    EXPECT_NEAR(bench.output.proxy.y, -0.03 + 2.5e-4 * 99 + 0.02, near(0.04));
    EXPECT_NEAR(bench.output.proxy.x, 0.003, near(0.04));
}

TEST_P(RayProxyIn, ShadingAndFrictionRunOnIt) {
    HapticSettings settings = rays();
    settings.forceShading = ShadingMode::TwoPass;
    TouchBench bench(sceneOf(assets::prism(10, 0.05, 0.15, true)), settings);
    double worst = 0.0;
    for (int i = 0; i < 3000; ++i) {
        const double a = 2e-3 * i, r = 0.0465 + 1e-4 * std::max(0, 100 - i);
        bench.step({r * std::cos(a), 0.001, r * std::sin(a)});
        if (i < 150)
            continue;
        ASSERT_GT(bench.output.contacts, 0u) << i;
        const glm::dvec3 radial(std::cos(a), 0.0, std::sin(a));
        worst =
            std::max(worst, std::acos(std::min(1.0, glm::dot(glm::normalize(bench.output.force), radial))));
    }
    EXPECT_LT(worst, 0.5 * kPi / 180.0); // unshaded it is up to 18 degrees

    for (const FrictionMode mode : {FrictionMode::Zilles, FrictionMode::Ho, FrictionMode::Elastoplastic}) {
        settings = rays();
        settings.friction = mode;
        settings.staticFriction = settings.dynamicFriction = 0.5;
        TouchBench plane(sceneOf(assets::plane(0.1, 0.1, 9, 9)), settings);
        plane.step({0.001, 0.01, 0.001});
        plane.moveTo({0.001, -0.002, 0.001}, 0.1);
        plane.moveTo({0.0015, -0.002, 0.001}, 0.1); // 0.5 mm; the cone is 1 mm wide
        EXPECT_EQ(plane.output.friction, FrictionState::Sticking) << static_cast<int>(mode);
        // Ho's spring is softer than the surface by the coefficient.
        EXPECT_NEAR(plane.output.force.x, mode == FrictionMode::Ho ? -0.25 : -0.5, 0.01)
            << static_cast<int>(mode);
        plane.moveTo({0.03, -0.002, 0.001}, 0.1);
        EXPECT_EQ(plane.output.friction, FrictionState::Sliding) << static_cast<int>(mode);
        EXPECT_NEAR(plane.output.force.x, -1.0, 0.02) << static_cast<int>(mode);
    }
}

TEST_P(RayProxyIn, TheMethodCanBeChangedWhileTouching) {
    for (const double coefficient : {-1.0, 0.3})
        for (const double side : {1.0, -1.0}) {
            TouchBench bench(sceneOf(assets::plane(0.1, 0.1, 3, 3)), rays());
            bench.scene->buildNeighbourhoods();
            if (coefficient > 0.0) {
                bench.settings.friction = FrictionMode::Zilles;
                bench.settings.staticFriction = bench.settings.dynamicFriction = coefficient;
            }
            bench.step({0.004, side * 0.01, 0.003});
            bench.moveTo({0.004, -side * 0.001, 0.003}, 0.1);
            constexpr ContactMethod kMethods[] = {ContactMethod::Sweep,         ContactMethod::Rays,
                                                  ContactMethod::Neighbourhood, ContactMethod::Rays,
                                                  ContactMethod::Neighbourhood, ContactMethod::Sweep};
            for (int i = 0; i < 18; ++i) {
                bench.settings.contact = kMethods[i % 6];
                for (int tick = 0; tick < 3; ++tick)
                    bench.step({0.004 + 1e-4 * i, -side * 0.001, 0.003});
                EXPECT_GT(bench.output.contacts, 0u) << i << " " << side;
                EXPECT_NEAR(bench.output.proxy.y, 0.0, 1e-6) << i << " " << side;
                EXPECT_GT(side * bench.output.force.y, 0.5) << i << " " << side;
            }
        }
}

TEST_P(RayProxyIn, ABudgetEndsItInFreeSpaceAndLaterTicksFinish) {
    HapticSettings settings = rays();
    settings.iterationBudget = 1;
    TouchBench bench(sceneOf(innerCorner()), settings);
    bench.step({0.05, 0.05, 0.05});
    int flagged = 0;
    for (int i = 0; i < 40; ++i) {
        bench.step({-0.002, -0.004, -0.003});
        flagged += has(bench.output.flags, TickFlag::BudgetReached) ? 1 : 0;
        EXPECT_LE(bench.output.iterations, 1u);
        EXPECT_GT(bench.output.proxy.x, 0.0);
        EXPECT_GT(bench.output.proxy.y, 0.0);
        EXPECT_GT(bench.output.proxy.z, 0.0);
    }
    EXPECT_GT(flagged, 0);
    EXPECT_LT(flagged, 10);
    EXPECT_LT(glm::length(bench.output.proxy), 2.0 * near(0.1));
}

TEST_P(RayProxyIn, AllocatesNothingAndRepeatsToTheLastBit) {
    const Scene scene = sceneOf(assets::torus(0.06, 0.025, 90, 60));
    HapticSettings settings = rays();
    settings.forceShading = ShadingMode::Material;
    settings.friction = FrictionMode::Zilles;
    settings.staticFriction = 0.5;
    settings.dynamicFriction = 0.4;
    TouchBench first(scene, settings), second(scene, settings);
    RestlessHand hand;
    int touching = 0;
    const uint64_t before = allocationsOnThisThread();
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 hip = hand.next();
        first.step(hip);
        second.step(hip);
        touching += first.output.contacts > 0 ? 1 : 0;
        ASSERT_TRUE(std::isfinite(glm::length(first.output.force))) << i;
        ASSERT_EQ(first.output.proxy, second.output.proxy);
        ASSERT_EQ(first.output.force, second.output.force);
    }
    EXPECT_EQ(allocationsOnThisThread() - before, 0u);
    EXPECT_GT(touching, 1000);
}

TEST_P(RayProxyIn, AStartInsideFeelsNothingUntilOutside) {
    TouchBench bench(sceneOf(assets::box(glm::dvec3(0.1), 3)), rays());
    bench.step({0.045, 0.001, 0.002});
    EXPECT_TRUE(has(bench.output.flags, TickFlag::StartedInside));
    bench.moveTo({0.06, 0.001, 0.002}, 0.5);
    EXPECT_EQ(bench.output.flags & static_cast<uint32_t>(TickFlag::StartedInside), 0u);
    bench.moveTo({0.048, 0.001, 0.002}, 0.5);
    EXPECT_NEAR(bench.output.proxy.x, 0.05, near(0.1));
}

TEST_P(RayProxyIn, NoTapIsMissed) {
    TouchBench bench(sceneOf(assets::sphere(0.05, 16, 16)), rays());
    std::mt19937 random(11);
    std::normal_distribution<double> direction;
    std::uniform_real_distribution<double> exponent(-9.0, -3.0);
    const HapticObject& object = *bench.scene->objects.front();
    const Similarity objectFromWorkspace = bench.scene->restMotions.front().workspaceFromObject.inverse();
    for (int tap = 0; tap < 1000; ++tap) {
        const glm::dvec3 out =
            glm::normalize(glm::dvec3(direction(random), direction(random), direction(random)));
        bench.state[0].forgetTouch();
        bench.step(0.06 * out);
        ASSERT_EQ(bench.output.contacts, 0u);
        double low = 0.048, high = 0.051;
        for (int i = 0; i < 50 && high - low > 1e-13; ++i) {
            const double r = 0.5 * (low + high);
            const BruteContact nearest = bruteNearest(object, LVec3(objectFromWorkspace.point(r * out)));
            (glm::dot(nearest.normal, LVec3(out)) > 0.0L ? high : low) = r;
        }
        const double step = std::pow(10.0, exponent(random));
        bench.step((high - step) * out);
        EXPECT_GT(bench.output.contacts, 0u) << tap << " step " << step;
        bench.step(0.046 * out);
        EXPECT_GT(bench.output.contacts, 0u) << tap;
        EXPECT_GT(glm::dot(bench.output.proxy, out), 0.047) << tap;
    }
}

INSTANTIATE_TEST_SUITE_P(Precision, RayProxyIn, ::testing::Values(Precision::Double, Precision::Single),
                         [](const auto& of) { return of.param == Precision::Single ? "Single" : "Double"; });

// What single precision costs, and what rays cannot do.

TEST(RayProxyLimits, SinglePrecisionIsAQuantumOfTheHandAndNoMore) {
    // The place of the hand is a float in the object's frame: on a box of 0.1 m, within 3 nm, and so is the
    // force, to 3 µN at 1000 N/m beside the clearance; double knows no such steps.
    double steps[2] = {};
    for (const Precision precision : {Precision::Double, Precision::Single}) {
        TouchBench bench(sceneOf(assets::box(glm::dvec3(0.1), 3)), bare(ContactMethod::Rays, precision));
        bench.step({0.06, 0.0031, 0.002});
        bench.step({0.049, 0.0031, 0.002});
        double worst = 0.0;
        for (int i = 0; i < 2000; ++i) {
            const glm::dvec3 hip(0.049, 0.0031 + 1e-10 * i, 0.002);
            bench.step(hip);
            worst = std::max(worst, std::abs(bench.output.proxy.y - hip.y));
        }
        steps[precision == Precision::Single] = worst;
    }
    EXPECT_LT(steps[0], 1e-12);
    EXPECT_GT(steps[1], 1e-10);
    EXPECT_LT(steps[1], 2e-8);
}

TEST(RayProxyLimits, FallsThroughASlitThatTheSweepCloses) {
    const double gap = 2e-6;
    assets::Shape sheet = assets::plane(0.1, 0.1);
    const assets::Shape other = assets::plane(0.1, 0.1);
    const auto first = static_cast<uint32_t>(sheet.positions.size());
    for (const glm::vec3& p : other.positions)
        sheet.positions.emplace_back(p.x + 0.1f + static_cast<float>(gap), p.y, p.z);
    for (const uint32_t i : other.indices)
        sheet.indices.push_back(first + i);
    sheet.normals.clear();
    sheet.uv.clear();
    sheet.tangents.clear();
    TouchBench ray(sceneOf(sheet), bare(ContactMethod::Rays)),
        sweep(sceneOf(sheet), bare(ContactMethod::Sweep));
    sweep.settings.proxyRadius = 0.5e-3;
    const double middle = 0.05 + 0.5 * gap;
    for (TouchBench* bench : {&ray, &sweep}) {
        bench->step({middle, 0.01, 0.001});
        bench->moveTo({middle, -0.002, 0.001}, 0.2);
    }
    EXPECT_GT(sweep.output.contacts, 0u);
    EXPECT_EQ(ray.output.contacts, 0u);
}

TEST(RayProxyLimits, BetweenTwoThatCloseItStaysWithOne) {
    // Two plates close on a still hand. The sweep leaves one of them out and says so; the god-object is taken
    // along by the last that runs into it, through the other.
    Scene scene = sceneOf(assets::plane(0.1, 0.1, 2, 2));
    glm::dmat4 above(1.0);
    above[3] = glm::dvec4(0.0, 0.02, 0.0, 1.0);
    addShape(scene, assets::plane(0.1, 0.1, 2, 2), above);
    TouchBench bench(scene, bare(ContactMethod::Rays));
    bench.motions = bench.scene->restMotions;
    bench.step({0.003, 0.01, 0.002});
    bool jammed = false;
    for (int i = 0; i < 250; ++i) {
        for (const size_t k : {size_t{0}, size_t{1}}) {
            ObjectMotion& plate = bench.motions[k];
            plate.before = plate.workspaceFromObject;
            plate.workspaceFromObject.translation.y += k == 0 ? 5e-5 : -5e-5;
        }
        bench.step({0.003, 0.01, 0.002});
        jammed |= has(bench.output.flags, TickFlag::Jammed);
        ASSERT_TRUE(std::isfinite(glm::length(bench.output.force)));
        ASSERT_LT(bench.output.penetration, 0.005);
    }
    EXPECT_TRUE(jammed);
}

TEST(RayProxyLimits, ARadiusAndAPrecisionAreNotPretended) {
    HapticSettings s = bare(ContactMethod::Rays, Precision::Single);
    EXPECT_TRUE(settingWarnings(s).empty());
    EXPECT_EQ(feltRadius(s), 0.0);
    s.proxyRadius = 5e-3;
    ASSERT_EQ(settingWarnings(s).size(), 1u);
    EXPECT_NE(settingWarnings(s)[0].find("contact=rays"), std::string::npos);
    EXPECT_EQ(feltRadius(s), 0.0);
    for (const ContactMethod method : {ContactMethod::Sweep, ContactMethod::Neighbourhood}) {
        const auto warnings = settingWarnings(bare(method, Precision::Single));
        ASSERT_EQ(warnings.size(), 1u);
        EXPECT_NE(warnings[0].find("precision=single is of contact=rays only"), std::string::npos);
    }
    for (const auto& [name, value] :
         {std::pair{"contact", "ray"}, {"contact", "Rays"}, {"precision", "half"}, {"precision", ""}})
        EXPECT_NE(setSetting(s, name, value).find("allowed"), std::string::npos) << name << "=" << value;
}

/// The sub-goal of few planes against alternating projections (Dykstra).
TEST(FewPlanes, NearestIsTheProjectionOntoTheirMeet) {
    std::mt19937 random(9);
    std::normal_distribution<double> normal;
    int byCount[4] = {};
    for (int i = 0; i < 2000; ++i) {
        const auto vector = [&] { return glm::dvec3(normal(random), normal(random), normal(random)); };
        const glm::dvec3 goal = vector();
        FewPlanes<double> planes;
        FewPlanes<float> rough;
        planes.count = rough.count = 1 + static_cast<size_t>(i % 4);
        for (size_t k = 0; k < planes.count; ++k) {
            planes.plane[k] = {glm::normalize(vector()), -0.1 * std::abs(normal(random))};
            rough.plane[k] = {glm::vec3(planes.plane[k].normal), static_cast<float>(planes.plane[k].offset)};
        }
        glm::dvec3 x = goal, correction[4] = {};
        for (int round = 0; round < 20000; ++round)
            for (size_t k = 0; k < planes.count; ++k) {
                const glm::dvec3 y = x + correction[k];
                const double lack = planes.plane[k].offset - glm::dot(planes.plane[k].normal, y);
                x = y + std::max(lack, 0.0) * planes.plane[k].normal;
                correction[k] = y - x;
            }
        const auto exact = nearestOnPlanes(goal, planes);
        const auto single = nearestOnPlanes(glm::vec3(goal), rough);
        ASSERT_TRUE(exact.found) << i;
        EXPECT_LT(glm::length(exact.point - x), 1e-3) << i;
        EXPECT_LE(glm::length(exact.point - goal), glm::length(x - goal) + 1e-3) << i;
        EXPECT_LT(glm::length(glm::dvec3(single.point) - exact.point), 1e-2) << i;
        glm::dvec3 back = goal; // the multipliers bring it there
        for (size_t k = 0; k < exact.count; ++k)
            back += exact.multiplier[k] * planes.plane[exact.active[k]].normal;
        EXPECT_LT(glm::length(back - exact.point), 1e-9) << i;
        ++byCount[exact.count];
    }
    for (const int count : byCount)
        EXPECT_GT(count, 20);
}

} // namespace
} // namespace touchstone::test::ray_proxy_test
