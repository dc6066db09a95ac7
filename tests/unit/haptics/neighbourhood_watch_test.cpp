// The second contact method against the first, against brute force, and at its limits.

#include "haptics/shape/mesh/surface_walk.h"
#include "study/truth/brute_force.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/fan.h"
#include "tests/support/strokes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

namespace touchstone::test::neighbourhood_watch_test {

using namespace truth;

namespace {

constexpr double kPi = 3.141592653589793;

HapticSettings bare(ContactMethod method) {
    HapticSettings settings;
    settings.contact = method;
    settings.forceShading = ShadingMode::Off;
    settings.friction = FrictionMode::Off;
    settings.texture = TextureMode::Off;
    return settings;
}

TouchBench watchBench(const Scene& scene, HapticSettings settings = bare(ContactMethod::Neighbourhood)) {
    TouchBench bench(scene, settings);
    bench.scene->buildNeighbourhoods();
    return bench;
}

struct Convex {
    std::string name;
    assets::Shape shape;
    double reach; // m: half the least extent
};

std::vector<Convex> convexShapes() {
    return {{"sphere", assets::sphere(0.05, 30, 30), 0.049},
            {"fine sphere", assets::sphere(0.05, 90, 90), 0.0499},
            {"box", assets::boxWithSharedCorners({0.08, 0.09, 0.1}), 0.04},
            {"cut box", assets::box({0.08, 0.09, 0.1}, 7), 0.04},
            {"prism", assets::prism(10, 0.05, 0.15, false), 0.0475}};
}

/// A stroke around the body with taps, from the air down to a millimetre and a half.
glm::dvec3 strokeOf(double reach, double speed, int tick) {
    const double a = 1e-3 * speed * tick / reach, tilt = 0.5 * std::sin(0.3 * a);
    const double r = reach + 5e-4 + 2e-3 * std::cos(0.02 * tick);
    return r * glm::dvec3(std::cos(a) * std::cos(tilt), std::sin(tilt), std::sin(a) * std::cos(tilt));
}

/// The largest angle between neighbouring facets, rad.
double sharpestEdge(const HapticScene& scene) {
    const HapticObject& object = *scene.objects.front();
    const SurfaceView surface{object, scene.neighbourhoods()->front()};
    double sharpest = 0.0;
    for (uint32_t t = 0; t < object.triangleCount(); ++t)
        for (uint32_t k = 0; k < 3; ++k) {
            const double cosine =
                glm::dot(surface.normal(2 * t), surface.normal(surface.adjacency.across(2 * t, k)));
            sharpest = std::max(sharpest, std::acos(std::clamp(cosine, -1.0, 1.0)));
        }
    return sharpest;
}

/// No place of the surface near the proxy is nearer to the HIP: a rest of Ho's method and of any god-object.
bool isLocalMinimum(const HapticObject& object, const glm::dvec3& proxy, const glm::dvec3& hip) {
    const auto own = static_cast<long double>(glm::length(proxy - hip));
    for (const BruteContact& touched : bruteWithin(object, LVec3(proxy), 1e-6L)) {
        const auto corner = [&](size_t k) {
            return LVec3(object.vertices[object.indices[3 * touched.triangle + k]]);
        };
        if (distanceFrom({corner(0), corner(1), corner(2)}, LVec3(hip)).distance < own - 2e-6L)
            return false;
    }
    return true;
}

/// At a ridge of angle theta a HIP at depth d has a rest on either face within d tan(theta/2) of the middle.
/// Which one it gets depends on how it came there, so the two methods, which come by different ways, may
/// differ by 2 d tan(theta/2), and then both are rests.
TEST(NeighbourhoodWatch, OnConvexShapesItRestsWhereTheSweepRests) {
    for (const Convex& c : convexShapes())
        for (const double speed : {0.1, 1.0}) {
            const Scene scene = sceneOf(c.shape);
            TouchBench walk = watchBench(scene), sweep(scene, bare(ContactMethod::Sweep));
            const HapticObject& object = *walk.scene->objects.front();
            const Similarity workspaceFromObject = walk.scene->restMotions.front().workspaceFromObject;
            const Similarity back = workspaceFromObject.inverse();
            // The sweep's god-object keeps half a weld tolerance from the surface.
            const double skin = 0.5 * kWeldTolerance * object.diagonal * workspaceFromObject.scale;
            const double slope = std::tan(0.5 * sharpestEdge(*walk.scene));
            int touching = 0, apart = 0;
            for (int i = 0; i < 4000; ++i) {
                const glm::dvec3 hip = strokeOf(c.reach, speed, i);
                const HapticOutput &a = walk.step(hip), &b = sweep.step(hip);
                const std::string where =
                    c.name + " at " + std::to_string(speed) + " m/s, tick " + std::to_string(i);
                EXPECT_EQ(a.flags & static_cast<uint32_t>(TickFlag::BudgetReached), 0u) << where;
                if ((a.contacts > 0) != (b.contacts > 0)) {
                    EXPECT_LT(std::max(a.penetration, b.penetration), 2.0 * skin) << where;
                    continue;
                }
                if (a.contacts == 0)
                    continue;
                ++touching;
                const double difference = glm::length(a.proxy - b.proxy);
                if (difference < 1e-6)
                    continue;
                ++apart;
                EXPECT_LT(difference, 2.0 * a.penetration * slope) << where;
                EXPECT_TRUE(isLocalMinimum(object, back.point(a.proxy), back.point(hip))) << where;
                EXPECT_TRUE(isLocalMinimum(object, back.point(b.proxy), back.point(hip))) << where;
            }
            EXPECT_GT(touching, 1000) << c.name;
            EXPECT_LE(apart, speed > 0.5 ? 20 : 0) << c.name;
        }
}

/// In a convex body the walk ends at the nearest point of the whole surface, but for that same ridge: there
/// the other face is nearer by at most 2 d tan(theta/2) sin(theta/2).
TEST(NeighbourhoodWatch, OnConvexShapesItFindsTheNearestPoint) {
    for (const Convex& c : convexShapes()) {
        TouchBench walk = watchBench(sceneOf(c.shape));
        const HapticObject& object = *walk.scene->objects.front();
        const Similarity back = walk.scene->restMotions.front().workspaceFromObject.inverse();
        const double angle = sharpestEdge(*walk.scene);
        int checked = 0, exact = 0;
        for (int i = 0; i < 3000; ++i) {
            walk.step(strokeOf(c.reach, 1.0, i));
            if (walk.output.contacts == 0 || i % 7 != 0)
                continue;
            ++checked;
            const glm::dvec3 hip = back.point(walk.output.hip);
            const double depth = walk.output.penetration * back.scale;
            const auto nearest = static_cast<double>(bruteNearest(object, LVec3(hip)).distance);
            exact += std::abs(depth - nearest) < 1e-12 ? 1 : 0;
            EXPECT_GT(depth, nearest - 1e-12) << c.name << " tick " << i;
            EXPECT_LT(depth, nearest + 2.0 * depth * std::tan(0.5 * angle) * std::sin(0.5 * angle) + 1e-12)
                << c.name << " tick " << i;
            EXPECT_TRUE(isLocalMinimum(object, back.point(walk.output.proxy), hip)) << c.name << " " << i;
        }
        EXPECT_GT(checked, 100) << c.name;
        EXPECT_GT(exact, checked / 5) << c.name;
    }
}

/// Force is stiffness times depth along the normal of what is touched, from both sides of an open sheet.
TEST(NeighbourhoodWatch, AnOpenSheetIsTouchedFromBothSidesAndLeftOverItsBorder) {
    for (const double side : {1.0, -1.0}) {
        TouchBench bench = watchBench(sceneOf(assets::plane(0.1, 0.1, 5, 5)));
        bench.settings.stiffness = 1000.0;
        bench.moveTo({0.013, side * 0.01, 0.007}, 0.5);
        bench.moveTo({0.013, -side * 0.002, 0.007}, 0.5);
        EXPECT_NEAR(bench.output.force.y, side * 2.0, 1e-6);
        bench.moveTo({0.049, -side * 0.002, 0.007}, 0.5);
        EXPECT_NEAR(bench.output.proxy.x, 0.049, 1e-9);
        EXPECT_NEAR(bench.output.proxy.y, 0.0, 1e-9);
        bench.moveTo({0.0501, -side * 0.002, 0.007}, 0.5); // past the border
        EXPECT_EQ(bench.output.contacts, 0u);
        bench.moveTo({0.0401, -side * 0.002, 0.007}, 0.5); // underneath: free air
        EXPECT_EQ(bench.output.contacts, 0u);
        bench.moveTo({0.0401, side * 0.002, 0.007}, 0.5); // and against it from there
        EXPECT_NEAR(bench.output.force.y, -side * 2.0, 1e-6);
    }
}

TEST(NeighbourhoodWatch, StraightOffASheetItLetsGo) {
    // To the last bit along the normal: the place that is left is the one where the proxy was.
    for (const double side : {1.0, -1.0}) {
        HapticSettings s;
        s.forceShading = ShadingMode::Off;
        s.contact = ContactMethod::Neighbourhood;
        TouchBench bench(sceneOf(assets::plane(0.1, 0.1, 3, 3)), s);
        bench.scene->buildNeighbourhoods();
        bench.step({0.011, 0.005 * side, 0.007});
        for (const double depth : {1e-3, 3e-3}) {
            bench.moveTo({0.011, -depth * side, 0.007}, 0.1);
            EXPECT_GT(bench.output.contacts, 0u) << side;
            bench.moveTo({0.011, 0.0013 * side, 0.007}, 0.1);
            EXPECT_EQ(bench.output.contacts, 0u) << side;
            EXPECT_EQ(bench.output.proxy, bench.output.hip) << side;
        }
    }
}

TEST(NeighbourhoodWatch, AHandExactlyOnASheetKeepsTheSideThatItCameFrom) {
    HapticSettings s;
    s.forceShading = ShadingMode::Off;
    s.contact = ContactMethod::Neighbourhood;
    for (const double side : {1.0, -1.0})
        for (const double on : {0.0, 1e-18, -1e-18, 1e-15, -1e-15})
            for (const bool pressed : {false, true}) {
                TouchBench bench(sceneOf(assets::plane(0.1, 0.1, 3, 3)), s);
                SCOPED_TRACE(std::to_string(side) + (pressed ? " pressed" : " in the air"));
                bench.scene->buildNeighbourhoods();
                const auto at = [side](double y) { return glm::dvec3(0.011, side * y, 0.007); };
                bench.step(at(0.001));
                if (pressed)
                    bench.step(at(-0.001));
                bench.step(at(on));
                EXPECT_LT(glm::length(bench.output.force), 1e-9);
                bench.step(at(0.0005));
                EXPECT_EQ(bench.output.contacts, 0u);
                EXPECT_EQ(bench.output.proxy, bench.output.hip);
                bench.step(at(on));
                bench.step(at(-0.0005));
                EXPECT_GT(bench.output.force.y * side, 0.1) << "held on its side";
            }
}

TEST(NeighbourhoodWatch, AThinPlateHoldsHoweverFastAndDeepItIsPressed) {
    for (const double speed : {0.05, 1.0, 5.0, 50.0}) {
        TouchBench bench = watchBench(sceneOf(assets::box({0.1, 0.001, 0.1}, 8)));
        bench.step({0.011, 0.02, 0.003});
        bench.moveTo({0.011, -0.003, 0.003}, speed);
        for (int i = 0; i < 10; ++i)
            bench.step({0.011, -0.003, 0.003});
        EXPECT_NEAR(bench.output.proxy.y, 0.0005, 1e-9) << speed;
    }
}

TEST(NeighbourhoodWatch, ConcaveEdgesAndCornersHoldTheHip) {
    // An inner corner of three squares.
    assets::Shape corner;
    corner.positions = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
    for (glm::vec3& p : corner.positions)
        p *= 0.1f;
    corner.indices = {0, 1, 2, 0, 2, 3, 0, 5, 1, 0, 4, 5, 0, 3, 6, 0, 6, 4};
    TouchBench walk = watchBench(sceneOf(corner)), sweep(sceneOf(corner), bare(ContactMethod::Sweep));
    const glm::dvec3 stations[] = {{0.05, 0.05, 0.05},       {0.05, 0.05, -0.003},   {-0.002, 0.05, -0.003},
                                   {-0.002, -0.004, -0.003}, {0.05, -0.004, -0.003}, {0.05, 0.05, 0.05}};
    for (const glm::dvec3& station : stations) {
        walk.moveTo(station, 0.2);
        sweep.moveTo(station, 0.2);
        for (int i = 0; i < 5; ++i) {
            walk.step(station);
            sweep.step(station);
        }
        EXPECT_LT(glm::length(walk.output.proxy - sweep.output.proxy), 1e-6);
        EXPECT_EQ(walk.output.contacts > 0, sweep.output.contacts > 0);
    }
}

TEST(NeighbourhoodWatch, GroovesHoldItAsTheyHoldTheSweep) {
    for (const double degrees : {90.0, 20.0, 5.0}) {
        // Two sheets that rise from the z axis, `degrees` between them.
        const double half = 0.5 * degrees * kPi / 180.0;
        assets::Shape groove;
        for (const double side : {-1.0, 0.0, 1.0})
            for (const double z : {-0.05, 0.05})
                groove.positions.emplace_back(0.05 * side * std::sin(half),
                                              0.05 * std::abs(side) * std::cos(half), z);
        groove.indices = {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4};
        TouchBench walk = watchBench(sceneOf(groove)), sweep(sceneOf(groove), bare(ContactMethod::Sweep));
        walk.step({0.0, 0.04, 0.001});
        sweep.step({0.0, 0.04, 0.001});
        for (const glm::dvec2& to : {glm::dvec2{0.0, 0.02},
                                     {0.0, -0.002},
                                     {0.001, -0.001},
                                     {-0.002, -0.0005},
                                     {0.0, -0.003},
                                     {0.0, 0.03}}) {
            walk.moveTo({to, 0.001}, 0.1);
            sweep.moveTo({to, 0.001}, 0.1);
            for (int i = 0; i < 3; ++i) {
                walk.step({to, 0.001});
                sweep.step({to, 0.001});
            }
            // Between two walls the skin of the sweep keeps it off the edge by skin / sin(half).
            EXPECT_LT(glm::length(walk.output.proxy - sweep.output.proxy), 1e-6 / std::sin(half)) << degrees;
            EXPECT_EQ(walk.output.contacts > 0, sweep.output.contacts > 0) << degrees;
        }
    }
}

/// Which way the triangles are wound says nothing about where the hand comes from.
TEST(NeighbourhoodWatch, MixedWindingsChangeNothing) {
    const assets::Shape sphere = assets::sphere(0.05, 24, 24);
    assets::Shape mixed = sphere;
    std::mt19937 random(3);
    for (size_t t = 0; t < mixed.triangleCount(); ++t)
        if (random() % 2 == 0)
            std::swap(mixed.indices[3 * t + 1], mixed.indices[3 * t + 2]);
    TouchBench plain = watchBench(sceneOf(sphere)), turned = watchBench(sceneOf(mixed));
    int touching = 0;
    for (int i = 0; i < 3000; ++i) {
        const glm::dvec3 hip = strokeOf(0.049, 0.5, i);
        plain.step(hip);
        turned.step(hip);
        ASSERT_EQ(plain.output.contacts, turned.output.contacts) << i;
        ASSERT_LT(glm::length(plain.output.proxy - turned.output.proxy), 1e-12) << i;
        touching += turned.output.contacts > 0 ? 1 : 0;
    }
    EXPECT_GT(touching, 1000);
}

/// A fin that stands on a sheet: at their common edge three triangles meet, and each side has its own corner.
TEST(NeighbourhoodWatch, AtAnEdgeOfThreeTrianglesItStaysOnItsSide) {
    assets::Shape fin;
    fin.positions = {{-0.05f, 0, -0.05f}, {-0.05f, 0, 0.05f}, {0, 0, -0.05f},     {0, 0, 0.05f},
                     {0.05f, 0, -0.05f},  {0.05f, 0, 0.05f},  {0, 0.05f, -0.05f}, {0, 0.05f, 0.05f}};
    fin.indices = {0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4, 2, 3, 7, 2, 7, 6};
    for (const double side : {-1.0, 1.0}) {
        TouchBench bench = watchBench(sceneOf(fin));
        bench.step({0.02 * side, 0.02, 0.001});
        bench.moveTo({0.02 * side, -0.002, 0.001}, 0.1);  // into the sheet
        bench.moveTo({-0.01 * side, -0.002, 0.001}, 0.1); // along it, past the fin's foot
        EXPECT_NEAR(bench.output.proxy.x, 0.0, 1e-9);
        EXPECT_NEAR(bench.output.proxy.y, 0.0, 1e-9);
        bench.moveTo({-0.01 * side, 0.01, 0.001}, 0.1); // up, behind the fin
        EXPECT_NEAR(bench.output.proxy.x, 0.0, 1e-9);
        EXPECT_NEAR(bench.output.proxy.y, 0.01, 1e-9);
        // From underneath it is one sheet.
        TouchBench below = watchBench(sceneOf(fin));
        below.step({0.02 * side, -0.02, 0.001});
        below.moveTo({0.02 * side, 0.002, 0.001}, 0.1);
        below.moveTo({-0.01 * side, 0.002, 0.001}, 0.1);
        EXPECT_NEAR(below.output.proxy.x, -0.01 * side, 1e-9);
        EXPECT_NEAR(below.output.proxy.y, 0.0, 1e-9);
    }
}

TEST(NeighbourhoodWatch, TheTorusHoldsOnItsSaddleForMinutes) {
    TouchBench bench = watchBench(sceneOf(assets::torus(0.06, 0.025, 90, 60)));
    for (int i = 0; i < 120000; ++i) {
        const double a = 1e-4 * i / 0.0846 * 3.0, v = 0.37 * a, r = 0.023 + 1e-4 * std::max(0, 200 - i);
        const double ring = 0.06 + r * std::cos(v);
        bench.step({ring * std::cos(a), ring * std::sin(a), r * std::sin(v)});
        if (i > 250) {
            ASSERT_GT(bench.output.contacts, 0u) << "fell through at tick " << i;
            ASSERT_LT(bench.output.penetration, 2.1e-3) << i;
        }
    }
}

TEST(NeighbourhoodWatch, ABoxThatRisesIntoAStillHipHoldsItAndCarriesIt) {
    TouchBench bench = watchBench(sceneOf(assets::box(glm::dvec3(0.04))));
    const Similarity rest = bench.scene->restMotions.front().workspaceFromObject;
    Similarity before = rest;
    for (int i = 0; i < 100; ++i) {
        Similarity now = rest;
        now.translation.y = -0.03 + 2.5e-4 * i;
        bench.motions = {{now, i == 0 ? now : before}};
        before = now;
        bench.step({0.003, 0.0, 0.002});
    }
    EXPECT_NEAR(bench.output.proxy.y, -0.03 + 2.5e-4 * 99 + 0.02, 1e-9);
    EXPECT_NEAR(bench.output.proxy.x, 0.003, 1e-9);
}

TEST(NeighbourhoodWatch, OnATurningAndSlidingBoxItRestsWhereTheSweepRests) {
    const Scene scene = sceneOf(assets::box({0.08, 0.02, 0.08}, 4));
    TouchBench walk = watchBench(scene), sweep(scene, bare(ContactMethod::Sweep));
    const Similarity rest = walk.scene->restMotions.front().workspaceFromObject;
    Similarity before = rest;
    int touching = 0;
    for (int i = 0; i < 2000; ++i) {
        Similarity now = rest;
        now.rotation = glm::angleAxis(2e-3 * i, glm::normalize(glm::dvec3(0.1, 1.0, 0.05)));
        now.translation = {0.01 * std::sin(3e-3 * i), 2e-3 * std::sin(0.01 * i), 0.0};
        for (TouchBench* bench : {&walk, &sweep}) {
            bench->motions = {{now, i == 0 ? now : before}};
            bench->step({0.012, i < 20 ? 0.03 : 0.0092, 0.005});
        }
        before = now;
        if (walk.output.contacts == 0 || sweep.output.contacts == 0) {
            EXPECT_LT(std::max(walk.output.penetration, sweep.output.penetration), 1e-6) << i;
            continue;
        }
        ++touching;
        ASSERT_LT(glm::length(walk.output.proxy - sweep.output.proxy), 1e-6) << i;
    }
    EXPECT_GT(touching, 500);
}

TEST(NeighbourhoodWatch, ScaleAndPlaceChangeNothing) {
    for (const double scale : {1e-6, 1e-3, 1.0, 1e3})
        for (const double offset : {0.0, 1e3}) { // the largest 1000 km off
            glm::dmat4 at(scale);
            at[3] = glm::dvec4(offset * scale, 0.0, -offset * scale, 1.0);
            const Scene scene = sceneOf(assets::sphere(0.05, 30, 30), at);
            TouchBench walk = watchBench(scene), sweep(scene, bare(ContactMethod::Sweep));
            int touching = 0;
            for (int i = 0; i < 1500; ++i) {
                const glm::dvec3 hip = glm::dvec3(at[3]) + scale * strokeOf(0.049, 0.1, i);
                const HapticOutput &a = walk.step(hip), &b = sweep.step(hip);
                if ((a.contacts > 0) != (b.contacts > 0)) {
                    EXPECT_LT(std::max(a.penetration, b.penetration), 1e-6 * scale) << scale << " " << i;
                    continue;
                }
                touching += a.contacts > 0 ? 1 : 0;
                // The skin, and the rounding of places that far out.
                ASSERT_LT(glm::length(a.proxy - b.proxy), 1e-6 * scale + 4e-16 * offset * scale)
                    << scale << " at " << offset << " tick " << i;
            }
            EXPECT_GT(touching, 300);
        }
}

TEST(NeighbourhoodWatch, OfSeveralObjectsItTouchesTheOneInFront) {
    Scene scene = sceneOf(assets::box(glm::dvec3(0.02), 3));
    glm::dmat4 behind(1.0);
    behind[3] = glm::dvec4(0.03, 0.0, 0.0, 1.0);
    addShape(scene, assets::box(glm::dvec3(0.02), 3), behind);
    for (const auto& [start, object] : {std::pair{-0.05, 0}, {0.08, 1}}) {
        TouchBench bench = watchBench(scene);
        bench.step({start, 0.001, 0.002});
        bench.step({0.015, 0.001, 0.002}); // in one tick, through one box into the gap between them
        EXPECT_EQ(bench.output.object, object);
    }
}

/// Where the HIP leaves one object, what stands behind it is found in the same tick.
TEST(NeighbourhoodWatch, LeavingOneSurfaceDoesNotJumpThroughAnother) {
    Scene scene = sceneOf(assets::plane(0.1, 0.1, 2, 2));
    glm::dmat4 wall(0.0); // a plane standing at x = 0.06, facing -x
    wall[0] = glm::dvec4(0, -1, 0, 0);
    wall[1] = glm::dvec4(-1, 0, 0, 0);
    wall[2] = glm::dvec4(0, 0, -1, 0);
    wall[3] = glm::dvec4(0.06, 0, 0, 1);
    addShape(scene, assets::plane(0.1, 0.1, 2, 2), wall);
    TouchBench bench = watchBench(scene);
    bench.step({0.045, 0.01, 0.001});
    bench.step({0.045, -0.001, 0.001});
    ASSERT_EQ(bench.output.object, 0);
    bench.step({0.07, -0.001, 0.001}); // off the border and behind the wall at once
    EXPECT_EQ(bench.output.object, 1);
    EXPECT_NEAR(bench.output.proxy.x, 0.06, 1e-9);
}

TEST(NeighbourhoodWatch, ShadingAndFrictionRunOnTheWalk) {
    HapticSettings settings;
    settings.contact = ContactMethod::Neighbourhood;
    settings.friction = FrictionMode::Off;
    settings.stiffness = 1000.0;
    TouchBench bench = watchBench(sceneOf(assets::prism(10, 0.05, 0.15, true)), settings);
    // Two passes on the cylinder that the normals of the prism say: the force is radial.
    double worst = 0.0;
    int touching = 0;
    for (int i = 0; i < 3000; ++i) {
        const double a = 2e-3 * i, r = 0.0465 + 1e-4 * std::max(0, 100 - i);
        bench.step({r * std::cos(a), 0.001, r * std::sin(a)});
        if (i < 150)
            continue;
        ++touching;
        ASSERT_GT(bench.output.contacts, 0u) << i;
        const glm::dvec3 radial(std::cos(a), 0.0, std::sin(a));
        worst =
            std::max(worst, std::acos(std::min(1.0, glm::dot(glm::normalize(bench.output.force), radial))));
    }
    EXPECT_GT(touching, 2000);
    EXPECT_LT(worst, 0.5 * kPi / 180.0); // unshaded it is up to 18 degrees

    // Friction: below the cone the proxy does not move at all, beyond it it follows.
    settings = bare(ContactMethod::Neighbourhood);
    settings.friction = FrictionMode::Zilles;
    settings.staticFriction = settings.dynamicFriction = 0.5;
    TouchBench plane = watchBench(sceneOf(assets::plane(0.1, 0.1, 9, 9)), settings);
    plane.step({0.001, 0.01, 0.001});
    plane.moveTo({0.001, -0.002, 0.001}, 0.1);
    const glm::dvec3 stuck = plane.output.proxy;
    plane.moveTo({0.0018, -0.002, 0.001}, 0.1); // 0.8 mm; the cone is 1 mm wide
    EXPECT_EQ(plane.output.proxy, stuck);
    EXPECT_EQ(plane.output.friction, FrictionState::Sticking);
    plane.moveTo({0.03, -0.002, 0.001}, 0.1);
    EXPECT_EQ(plane.output.friction, FrictionState::Sliding);
    EXPECT_NEAR(plane.output.proxy.x, 0.029, 1e-6);
}

TEST(NeighbourhoodWatch, TheMethodCanBeChangedWhileTouching) {
    for (const assets::Shape& shape : {assets::plane(0.1, 0.1, 3, 3), assets::box({0.1, 0.02, 0.1}, 3)}) {
        TouchBench bench = watchBench(sceneOf(shape));
        const double top = shape.positions.front().y; // 0, or a face of the box
        const double surface = std::abs(top) > 1e-6 ? 0.01 : 0.0;
        bench.step({0.004, surface + 0.01, 0.003});
        bench.moveTo({0.004, surface - 0.001, 0.003}, 0.1);
        for (int i = 0; i < 6; ++i) {
            bench.settings.contact = i % 2 == 0 ? ContactMethod::Sweep : ContactMethod::Neighbourhood;
            for (int tick = 0; tick < 3; ++tick)
                bench.step({0.004 + 1e-4 * i, surface - 0.001, 0.003});
            EXPECT_GT(bench.output.contacts, 0u) << i;
            EXPECT_NEAR(bench.output.proxy.y, surface, 1e-6) << i;
        }
    }
}

/// Friction keeps a place on the facet itself; the sweep, which stands on one side, must not start from it.
TEST(NeighbourhoodWatch, TheMethodCanBeChangedWhileFrictionHolds) {
    for (const double side : {1.0, -1.0}) // a sheet from above and from below
        for (const double coefficient : {0.1, 2.0}) {
            TouchBench bench = watchBench(sceneOf(assets::plane(0.1, 0.1, 3, 3)));
            bench.settings.friction = FrictionMode::Zilles;
            bench.settings.staticFriction = bench.settings.dynamicFriction = coefficient;
            bench.step({0.004, side * 0.01, 0.003});
            bench.moveTo({0.004, -side * 0.001, 0.003}, 0.1);
            for (int i = 0; i < 8; ++i) {
                bench.settings.contact = i % 2 == 0 ? ContactMethod::Sweep : ContactMethod::Neighbourhood;
                for (int tick = 0; tick < 4; ++tick)
                    bench.step({0.004 + 1e-4 * (4 * i + tick), -side * 0.001, 0.003});
                EXPECT_GT(bench.output.contacts, 0u) << side << " mu " << coefficient << " switch " << i;
                EXPECT_NEAR(bench.output.proxy.y, 0.0, 1e-6)
                    << side << " mu " << coefficient << " switch " << i;
                EXPECT_GT(side * bench.output.force.y, 0.1)
                    << side << " mu " << coefficient << " switch " << i;
            }
        }
}

/// The change is over after one tick: what sticks then holds, as far as its cone allows.
TEST(NeighbourhoodWatch, AfterAChangeToTheSweepFrictionHoldsAsBefore) {
    TouchBench bench = watchBench(sceneOf(assets::plane(0.1, 0.1, 3, 3)));
    bench.settings.friction = FrictionMode::Zilles;
    bench.settings.staticFriction = bench.settings.dynamicFriction = 1.0;
    bench.settings.stiffness = 1000.0;
    bench.step({0.004, 0.01, 0.003});
    bench.moveTo({0.004, -0.001, 0.003}, 0.1);
    bench.settings.contact = ContactMethod::Sweep;
    bench.step({0.004, -0.001, 0.003});
    bench.step({0.004, -0.001, 0.003});
    EXPECT_FALSE(bench.state[0].watch.touching);
    for (int i = 1; i <= 20; ++i) {
        bench.step({0.004 + 2e-5 * i, -0.001, 0.003});
        EXPECT_NEAR(bench.output.force.x, -1000.0 * 2e-5 * i, 1e-6) << i;
        EXPECT_NEAR(bench.output.proxy.x, 0.004, 1e-9) << i;
        EXPECT_EQ(bench.output.friction, FrictionState::Sticking) << i;
    }
}

/// A loop that does not close puts a sheet elsewhere at once: the watch is not caught by the way between.
TEST(NeighbourhoodWatch, AJumpSweepsOverNothing) {
    TouchBench bench = watchBench(sceneOf(assets::plane(0.1, 0.1, 3, 3)));
    bench.motions = bench.scene->restMotions;
    bench.step({0.004, 0.01, 0.003});
    bench.step({0.004, 0.01, 0.003});
    Similarity above = bench.motions[0].workspaceFromObject;
    above.translation.y += 0.03; // now over the hand
    bench.motions[0] = {
        .workspaceFromObject = above, .before = bench.motions[0].workspaceFromObject, .jumped = true};
    bench.step({0.004, 0.01, 0.003});
    EXPECT_TRUE(has(bench.output.flags, TickFlag::ObjectJumped));
    EXPECT_EQ(bench.output.contacts, 0u);
    EXPECT_EQ(bench.output.force, glm::dvec3(0.0));
}

TEST(NeighbourhoodWatch, WithoutItsNeighbourhoodsItSweepsAndSaysSo) {
    TouchBench bench(sceneOf(assets::plane(0.1, 0.1)), bare(ContactMethod::Neighbourhood));
    bench.step({0.001, 0.01, 0.001});
    bench.step({0.001, -0.001, 0.001});
    EXPECT_TRUE(has(bench.output.flags, TickFlag::NeighbourhoodMissing));
    EXPECT_GT(bench.output.contacts, 0u);
    bench.scene->buildNeighbourhoods();
    bench.step({0.001, -0.001, 0.001});
    EXPECT_FALSE(has(bench.output.flags, TickFlag::NeighbourhoodMissing));
    EXPECT_GT(bench.output.contacts, 0u);
}

TEST(NeighbourhoodWatch, ARadiusIsNotPretended) {
    HapticSettings settings = bare(ContactMethod::Neighbourhood);
    EXPECT_TRUE(settingWarnings(settings).empty());
    settings.proxyRadius = 5e-3;
    EXPECT_EQ(settingWarnings(settings).size(), 1u);
    EXPECT_EQ(feltRadius(settings), 0.0);
    TouchBench bench = watchBench(sceneOf(assets::plane(0.1, 0.1)), settings);
    bench.step({0.001, 0.01, 0.001});
    bench.step({0.001, 0.001, 0.001}); // a sphere of 5 mm would touch here
    EXPECT_EQ(bench.output.contacts, 0u);
    settings.contact = ContactMethod::Sweep;
    EXPECT_TRUE(settingWarnings(settings).empty());
    EXPECT_EQ(feltRadius(settings), 5e-3);
}

/// Over a cone of thousands of facets each look about the tip takes them all in.
TEST(NeighbourhoodWatch, TheWalkIsBoundedWhateverTheMesh) {
    for (const uint32_t facets : {1000u, 30000u}) {
        TouchBench bench = watchBench(sceneOf(fan(facets, 0.05, 0.03, 0.0)));
        bench.step({0.0, 0.05, 0.0});
        int flagged = 0, touching = 0;
        for (int i = 0; i < 300; ++i) {
            const double a = 1.7 * i; // from one flank to the other, over the tip
            bench.step({0.004 * std::cos(a), 0.015, 0.004 * std::sin(a)});
            flagged += has(bench.output.flags, TickFlag::BudgetReached) ? 1 : 0;
            touching += bench.output.contacts > 0 ? 1 : 0;
            EXPECT_LE(bench.output.iterations, static_cast<uint32_t>(bench.settings.iterationBudget));
            EXPECT_TRUE(std::isfinite(glm::length(bench.output.force)));
        }
        EXPECT_EQ(touching, 300);
        if (facets > WalkBudget::kMaxTests) {
            EXPECT_GT(flagged, 0);
        }
    }
    // Few steps a tick: it follows late, says so, and gets there.
    TouchBench bench = watchBench(sceneOf(assets::sphere(0.05, 60, 60)));
    bench.settings.iterationBudget = 3;
    bench.step({0.06, 0.0, 0.0});
    bench.step({0.049, 0.0, 0.0});
    const glm::dvec3 goal(0.049 * std::cos(0.5), 0.0, 0.049 * std::sin(0.5));
    bench.step(goal);
    EXPECT_TRUE(has(bench.output.flags, TickFlag::BudgetReached));
    EXPECT_EQ(bench.output.iterations, 3u);
    int ticks = 0;
    while (has(bench.step(goal).flags, TickFlag::BudgetReached))
        ASSERT_LT(++ticks, 100);
    EXPECT_LT(glm::length(bench.output.proxy - goal), 1.2e-3);
}

/// Soup: triangles that share vertices at random, slivers, triangles without area, edges of many triangles.
assets::Shape soup(uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-0.05, 0.05);
    std::uniform_int_distribution<uint32_t> vertex(0, 59);
    assets::Shape shape;
    for (int i = 0; i < 60; ++i)
        shape.positions.emplace_back(place(random), place(random), place(random));
    for (uint32_t i = 3; i < 60; i += 9) // on the line between two others
        shape.positions[i] = 0.5f * (shape.positions[i - 1] + shape.positions[i - 2]);
    for (uint32_t i = 5; i < 60; i += 13) // and all but on it
        shape.positions[i] = 0.3f * shape.positions[i - 1] + 0.7f * shape.positions[i - 2] + glm::vec3(1e-7f);
    for (int t = 0; t < 300; ++t)
        for (int k = 0; k < 3; ++k)
            shape.indices.push_back(vertex(random));
    for (uint32_t i = 3; i < 60; i += 9)
        shape.indices.insert(shape.indices.end(), {i, i - 1, i - 2});
    shape.normals.assign(shape.positions.size(), glm::vec3(0, 1, 0));
    return shape;
}

TEST(NeighbourhoodWatch, InASoupItStaysOnTheSurfaceAndWithinItsBudget) {
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        HapticSettings settings;
        settings.contact = ContactMethod::Neighbourhood;
        settings.staticFriction = settings.dynamicFriction = 0.3;
        TouchBench bench = watchBench(sceneOf(soup(seed)), settings);
        const HapticObject& object = *bench.scene->objects.front();
        std::mt19937 random(seed);
        std::normal_distribution<double> step(0.0, 1e-3);
        glm::dvec3 hip(0.06, 0.0, 0.0);
        int touching = 0;
        const uint64_t before = allocationsOnThisThread();
        for (int i = 0; i < 3000; ++i) {
            hip = 0.995 * hip + glm::dvec3(step(random), step(random), step(random));
            if (i % 97 == 0)
                hip = -0.5 * hip;
            bench.step(hip);
            ASSERT_TRUE(std::isfinite(glm::length(bench.output.force))) << seed << " " << i;
            ASSERT_LE(bench.output.iterations, static_cast<uint32_t>(settings.iterationBudget));
            touching += bench.output.contacts > 0 ? 1 : 0;
        }
        EXPECT_EQ(allocationsOnThisThread() - before, 0u);
        EXPECT_GT(touching, 100);
        for (int i = 0; i < 300; ++i) {
            hip = 0.99 * hip + glm::dvec3(step(random), step(random), step(random));
            bench.step(hip);
            if (bench.output.contacts == 0)
                continue;
            const Similarity& workspaceFromObject = bench.scene->restMotions.front().workspaceFromObject;
            const glm::dvec3 proxy = workspaceFromObject.inversePoint(bench.output.proxy);
            EXPECT_LT(bruteNearest(object, LVec3(proxy)).distance, 1e-13L) << seed << " " << i;
        }
    }
}

TEST(NeighbourhoodWatch, AllocatesNothingAndRepeatsToTheLastBit) {
    const Scene scene = sceneOf(assets::torus(0.06, 0.025, 90, 60));
    HapticSettings settings;
    settings.contact = ContactMethod::Neighbourhood;
    settings.staticFriction = 0.5;
    settings.dynamicFriction = 0.4;
    TouchBench first = watchBench(scene, settings), second = watchBench(scene, settings);
    RestlessHand hand;
    int touching = 0;
    const uint64_t before = allocationsOnThisThread();
    for (int i = 0; i < 4000; ++i) {
        const glm::dvec3 hip = hand.next();
        first.step(hip);
        second.step(hip);
        touching += first.output.contacts > 0 ? 1 : 0;
        ASSERT_EQ(first.output.proxy, second.output.proxy);
        ASSERT_EQ(first.output.force, second.output.force);
    }
    EXPECT_EQ(allocationsOnThisThread() - before, 0u);
    EXPECT_GT(touching, 1000);
}

TEST(NeighbourhoodWatch, AStartInsideFeelsNothingUntilOutside) {
    TouchBench bench = watchBench(sceneOf(assets::box(glm::dvec3(0.1), 3)));
    bench.step({0.045, 0.001, 0.002});
    EXPECT_TRUE(has(bench.output.flags, TickFlag::StartedInside));
    bench.moveTo({0.06, 0.001, 0.002}, 0.5);
    EXPECT_EQ(bench.output.flags & static_cast<uint32_t>(TickFlag::StartedInside), 0u);
    bench.moveTo({0.048, 0.001, 0.002}, 0.5);
    EXPECT_NEAR(bench.output.proxy.x, 0.05, 1e-9);
}

/// Taps at random over random directions, ending a hair above or under the surface: none is missed.
TEST(NeighbourhoodWatch, NoTapIsMissed) {
    TouchBench bench = watchBench(sceneOf(assets::sphere(0.05, 16, 16)));
    std::mt19937 random(11);
    std::normal_distribution<double> direction;
    std::uniform_real_distribution<double> exponent(-9.0, -3.0);
    const HapticObject& object = *bench.scene->objects.front();
    const Similarity objectFromWorkspace = bench.scene->restMotions.front().workspaceFromObject.inverse();
    for (int tap = 0; tap < 1000; ++tap) {
        const glm::dvec3 out =
            glm::normalize(glm::dvec3(direction(random), direction(random), direction(random)));
        bench.state[0].forgetTouch(); // the way to here would lead through the sphere
        bench.step(0.06 * out);
        ASSERT_EQ(bench.output.contacts, 0u);
        // Along this ray the surface is here:
        double low = 0.048, high = 0.051;
        for (int i = 0; i < 50; ++i) {
            const double r = 0.5 * (low + high);
            const BruteContact nearest = bruteNearest(object, LVec3(objectFromWorkspace.point(r * out)));
            (glm::dot(nearest.normal, LVec3(out)) > 0.0L ? high : low) = r;
            if (high - low < 1e-13)
                break;
        }
        const double step = std::pow(10.0, exponent(random));
        bench.step((high + step) * out);
        EXPECT_EQ(bench.output.contacts, 0u) << tap;
        bench.step((high - step) * out);
        EXPECT_GT(bench.output.contacts, 0u) << tap << " step " << step;
        bench.step(0.046 * out);
        EXPECT_GT(bench.output.contacts, 0u) << tap;
    }
}

// What the method cannot do, each computed from the geometry, beside the sweep that can.

/// Boxes that stand in one another share no vertices: the walk on one knows nothing of the other's wall.
TEST(NeighbourhoodWatchLimits, WalksThroughWhatSharesNoVertices) {
    Scene scene = sceneOf(assets::box({0.1, 0.02, 0.1}, 1)); // top at y = 0.01
    glm::dmat4 at(1.0);
    at[3] = glm::dvec4(0.03, 0.01, 0.0, 1.0);
    addShape(scene, assets::box({0.02, 0.03, 0.1}, 1), at); // its wall stands at x = 0.02
    TouchBench walk = watchBench(scene), sweep(scene, bare(ContactMethod::Sweep));
    for (TouchBench* bench : {&walk, &sweep}) {
        bench->step({0.0, 0.03, 0.001});
        bench->moveTo({0.0, 0.009, 0.001}, 0.2);
        bench->moveTo({0.028, 0.009, 0.001}, 0.2);
    }
    EXPECT_NEAR(sweep.output.proxy.x, 0.02, 1e-6); // held by the wall
    EXPECT_NEAR(walk.output.proxy.x, 0.028, 1e-9); // 8 mm inside the other box
    EXPECT_NEAR(walk.output.proxy.y, 0.01, 1e-9);
}

/// A slit of twice the weld tolerance, far too narrow to be felt: the walk ends at it, and lets go.
TEST(NeighbourhoodWatchLimits, FallsThroughASlitThatTheSweepCloses) {
    const double gap =
        2e-6; // m, of an object with a diagonal of 0.22 m: wider than the weld, which joins 0.2 um
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
    TouchBench walk = watchBench(sceneOf(sheet)), sweep(sceneOf(sheet), bare(ContactMethod::Sweep));
    sweep.settings.proxyRadius = 0.5e-3; // wider than the gap, so the sphere cannot fall in
    for (TouchBench* bench : {&walk, &sweep}) {
        bench->step({0.04, 0.01, 0.001});
        bench->moveTo({0.04, -0.002, 0.001}, 0.2);
        bench->moveTo({0.06, -0.002, 0.001}, 0.2);
    }
    EXPECT_GT(sweep.output.contacts, 0u);
    EXPECT_EQ(walk.output.contacts, 0u);
}

/// While it touches one object it does not see another one come.
TEST(NeighbourhoodWatchLimits, DoesNotSeeAnotherObjectComeWhileItTouches) {
    Scene scene = sceneOf(assets::plane(0.1, 0.1, 3, 3));
    glm::dmat4 aside(1.0);
    aside[3] = glm::dvec4(0.03, 0.002, 0.001, 1.0);
    addShape(scene, assets::box(glm::dvec3(0.01)), aside); // its left wall at x = 0.025
    TouchBench walk = watchBench(scene), sweep(scene, bare(ContactMethod::Sweep));
    for (TouchBench* bench : {&walk, &sweep}) {
        bench->motions = bench->scene->restMotions;
        bench->step({0.001, 0.01, 0.001});
        bench->moveTo({0.001, -0.001, 0.001}, 0.1);
        ASSERT_EQ(bench->output.object, 0);
        for (int i = 0; i < 245; ++i) { // to the left: its wall ends at x = 0.0005
            ObjectMotion& box = bench->motions[1];
            box.before = box.workspaceFromObject;
            box.workspaceFromObject.translation.x -= 1e-4;
            bench->step({0.001, -0.001, 0.001});
        }
    }
    EXPECT_NEAR(sweep.output.proxy.x, 0.0005, 1e-6); // pushed along
    EXPECT_NEAR(walk.output.proxy.x, 0.001, 1e-9);   // inside the box
}

// Where a walk downhill might be thought to differ and does not: the sweep's rest is a local minimum too.

/// A ridge along z, `width` wide at its foot and 10 mm high, on a floor.
assets::Shape ridge(double width) {
    assets::Shape hill;
    const double profile[][2] = {
        {-0.05, 0.0}, {-0.5 * width, 0.0}, {0.0, 0.01}, {0.5 * width, 0.0}, {0.05, 0.0}};
    for (const auto& [x, y] : profile)
        for (const double z : {-0.05, 0.05})
            hill.positions.emplace_back(x, y, z);
    for (uint32_t i = 0; i < 4; ++i) {
        const uint32_t a = 2 * i;
        hill.indices.insert(hill.indices.end(), {a, a + 1, a + 3, a, a + 3, a + 2});
    }
    return hill;
}

TEST(NeighbourhoodWatch, AfterAJumpUnderAHillItEndsWhereTheSweepDoes) {
    for (const double width : {0.02, 0.004}) {
        const Scene scene = sceneOf(ridge(width));
        TouchBench walk = watchBench(scene), sweep(scene, bare(ContactMethod::Sweep));
        // A steep hill is an obstacle: from its foot at (-0.002, 0) the way up leads away from a HIP at
        // (0.001, -0.004), since (3, -4) . (2, 10) < 0. A gentle one is gone over.
        const bool steep = width < 0.01;
        const glm::dvec3 to = steep ? glm::dvec3(0.001, -0.004, 0.001) : glm::dvec3(0.03, -0.001, 0.001);
        for (TouchBench* bench : {&walk, &sweep}) {
            bench->step({-0.03, 0.02, 0.001});
            bench->step({-0.03, -0.004, 0.001});
            bench->step(to);
        }
        EXPECT_NEAR(walk.output.proxy.x, steep ? -0.002 : 0.03, 1e-8);
        EXPECT_LT(glm::length(walk.output.proxy - sweep.output.proxy), 1e-6);
    }
}

/// A T-junction that is closed by triangles without area, six in a row at its far end: the walk leaves each
/// over the edge nearest to the place where it enters.
TEST(NeighbourhoodWatch, WalksOverTrianglesWithoutArea) {
    constexpr int kParts = 7;
    constexpr float kHalf = 0.035f;
    assets::Shape sheet;
    for (int i = 0; i <= kParts; ++i)
        sheet.positions.emplace_back(0.0f, 0.0f, kHalf * (2.0f * static_cast<float>(i) / kParts - 1.0f));
    sheet.positions.emplace_back(-0.05f, 0.0f, 0.0f);
    sheet.positions.emplace_back(0.05f, 0.0f, 0.0f);
    constexpr uint32_t kLast = kParts, kLeft = kParts + 1, kRight = kParts + 2;
    sheet.indices = {kLeft, kLast, 0};
    for (uint32_t i = 0; i < kParts; ++i)
        sheet.indices.insert(sheet.indices.end(), {kRight, i, i + 1});
    for (uint32_t i = 0; i + 2 <= kLast; ++i)
        sheet.indices.insert(sheet.indices.end(), {i, kLast, i + 1});
    for (const double side : {1.0, -1.0})
        for (const double z : {-0.030, -0.021, 0.001, 0.011, 0.0205, 0.0265}) {
            TouchBench bench = watchBench(sceneOf(sheet));
            bench.moveTo({-0.004, side * 0.004, z}, 0.2);
            bench.moveTo({-0.004, -side * 0.001, z}, 0.1);
            int lost = 0;
            double off = 0.0;
            const auto each = [&](const HapticOutput& out) {
                lost += out.contacts == 0 ? 1 : 0;
                off = std::max(off, glm::distance(out.proxy, {out.hip.x, 0.0, out.hip.z}));
            };
            bench.moveTo({0.004, -side * 0.001, z}, 0.1, each);
            bench.moveTo({-0.004, -side * 0.001, z}, 0.1, each);
            EXPECT_EQ(lost, 0) << z;
            EXPECT_LT(off, 1e-8) << z;
        }
}

} // namespace
} // namespace touchstone::test::neighbourhood_watch_test
