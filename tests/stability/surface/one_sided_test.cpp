// Materials with `sides: front`: from the front as any surface, from behind not there, and nothing between.

#include "study/truth/brute_force.h"
#include "tests/stability/surface/touched_plane.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::test::one_sided_test {

using namespace truth;

namespace {

constexpr double kRadius = 0.5e-3; // m

Scene oneSided(Scene scene) {
    for (Material& material : scene.materials)
        material.haptic.sides = SideChoice::Front;
    return scene;
}

/// A sheet of kSide facing +z.
Scene sheet() {
    Scene scene;
    scene.materials.emplace_back();
    place(scene, quadMesh(0.5 * kSide, 3), 0);
    return scene;
}

/// Every way to touch.
std::vector<HapticSettings> allWays() {
    std::vector<HapticSettings> ways;
    for (const Variant& variant : allVariants())
        for (const FrictionMode friction : {FrictionMode::Off, FrictionMode::Zilles}) {
            HapticSettings s = variant.settings();
            s.friction = friction;
            s.staticFriction = s.dynamicFriction = 0.5;
            ways.push_back(s);
        }
    HapticSettings walk = ways.front();
    walk.contact = ContactMethod::Neighbourhood;
    ways.push_back(walk);
    return ways;
}

std::string nameOf(const HapticSettings& s) {
    return "r " + settingValue(s, "proxyRadius") + " shading " + settingValue(s, "forceShading") +
           " friction " + settingValue(s, "friction") + " " + settingValue(s, "contact");
}

TouchBench benchOf(const Scene& scene, const HapticSettings& settings) {
    TouchBench bench(scene, settings);
    if (settings.contact == ContactMethod::Neighbourhood)
        bench.scene->buildNeighbourhoods();
    return bench;
}

/// Distance of the proxy's centre from the mesh, workspace m, by looking at every triangle.
double proxyClearance(const TouchBench& bench) {
    const HapticObject& object = *bench.scene->objects[0];
    const Similarity& pose = object.workspaceFromObject;
    const LVec3 proxy(pose.inversePoint(bench.output.proxy));
    return pose.scale * static_cast<double>(bruteNearest(object, proxy).distance);
}

TEST(OneSided, FromOutsideABodyIsTheSameWithBothSides) {
    const Scene torus = sceneOf(assets::torus(0.06, 0.025, 48, 24)),
                box = sceneOf(assets::box({0.1, 0.1, 0.1}));
    for (const Scene* scene : {&torus, &box})
        for (const HapticSettings& s : allWays()) {
            SCOPED_TRACE(nameOf(s));
            TouchBench both = benchOf(*scene, s), front = benchOf(oneSided(*scene), s);
            int touched = 0;
            double apart = 0.0;
            for (int i = 0; i < 6000; ++i) { // all over it, in and out, round every edge
                const double a = 2.1e-3 * i, b = 5.3e-3 * i, reach = 0.078 + 0.012 * std::sin(0.013 * i);
                const glm::dvec3 hip =
                    reach * glm::dvec3(std::cos(a) * std::cos(0.4 * std::sin(b)), std::sin(0.4 * std::sin(b)),
                                       std::sin(a) * std::cos(0.4 * std::sin(b)));
                both.step(hip);
                front.step(hip);
                touched += both.output.contacts > 0 ? 1 : 0;
                EXPECT_EQ(both.output.contacts > 0, front.output.contacts > 0) << i;
                apart = std::max({apart, glm::distance(both.output.proxy, front.output.proxy),
                                  glm::distance(both.output.force, front.output.force) / kStiffness});
            }
            EXPECT_GT(touched, 300);
            EXPECT_LT(apart, 1e-9);
        }
}

TEST(OneSided, FromBehindTheHandComesThroughAndThenStandsOnIt) {
    for (const HapticSettings& s : allWays())
        for (const double speed : {0.01, 0.1, 1.0, 20.0}) {
            SCOPED_TRACE(nameOf(s) + " at " + std::to_string(speed));
            TouchBench bench = benchOf(oneSided(sheet()), s);
            bench.step({0.011, 0.007, -0.02});
            bench.moveTo({0.013, 0.005, 0.02}, speed, [&](const HapticOutput& out) {
                EXPECT_EQ(out.contacts, 0u) << out.hip.z;
                EXPECT_EQ(out.force, glm::dvec3(0.0));
                EXPECT_LT(glm::distance(out.proxy, out.hip), 1e-9);
            });
            bench.moveTo({0.013, 0.005, -1e-3}, std::min(speed, 1.0));
            bench.step(bench.output.hip);
            bench.moveTo(bench.output.hip, 1.0);
            const double stands = feltRadius(s);
            EXPECT_NEAR(bench.output.force.z, kStiffness * (1e-3 + stands), 1e-3);
            EXPECT_NEAR(bench.output.proxy.z, stands, 1e-6);
            EXPECT_EQ(held(bench), 0.0);
            // However deep, it stands on the front, and comes off it as from any surface.
            bench.moveTo({0.013, 0.005, -0.03}, 0.5);
            EXPECT_NEAR(bench.output.proxy.z, stands, 1e-6);
            bench.moveTo({0.013, 0.005, 0.003}, 0.5);
            EXPECT_EQ(bench.output.contacts, 0u);
        }
}

TEST(OneSided, TurningRoundOnTheWayThroughComesOutFree) {
    for (const HapticSettings& s : allWays()) {
        if (s.proxyRadius == 0.0)
            continue;
        SCOPED_TRACE(nameOf(s));
        TouchBench bench = benchOf(oneSided(sheet()), s);
        const auto free = [](const HapticOutput& out) {
            EXPECT_EQ(out.contacts, 0u) << out.hip.z;
            EXPECT_EQ(out.force, glm::dvec3(0.0));
        };
        bench.step({0.011, 0.007, -0.005});
        for (const double height : {-0.9, -0.1, 0.0, 0.1, 0.5, 0.9, 0.999}) { // in radii
            bench.moveTo({0.011, 0.007, height * kRadius}, 0.05, free);
            bench.moveTo({0.018, 0.002, height * kRadius}, 0.05, free); // along, half through
            for (int i = 0; i < 50; ++i)
                free(bench.step(bench.output.hip));
            bench.moveTo({0.011, 0.007, -0.005}, 0.05, free);
        }
        bench.moveTo({0.011, 0.007, 1.001 * kRadius}, 0.05, free); // wholly through
        bench.moveTo({0.011, 0.007, 0.2 * kRadius}, 0.05);
        EXPECT_NEAR(bench.output.force.z, 0.8 * kStiffness * kRadius, 1e-3) << "now it stands on it";
    }
}

TEST(OneSided, ThereIsNoPlaceBetweenTheSides) {
    // A hand that trembles through the sheet and along it: it is either free, the proxy with it, or stands on
    // the front; what it feels changes in a tick by what it moved.
    for (const HapticSettings& s : allWays())
        for (const double tremble : {2e-5, 3e-4, 3e-3}) {
            SCOPED_TRACE(nameOf(s) + " trembling by " + std::to_string(tremble));
            TouchBench bench = benchOf(oneSided(sheet()), s);
            std::mt19937 random(7);
            std::normal_distribution<double> step(0.0, tremble);
            const double stands = feltRadius(s);
            glm::dvec3 hip(0.0, 0.0, -0.002);
            bench.step(hip);
            HapticOutput last = bench.output;
            int standing = 0, through = 0;
            for (int i = 0; i < 8000; ++i) {
                hip += glm::dvec3(step(random), step(random), step(random));
                hip = glm::clamp(hip, glm::dvec3(-0.03, -0.03, -0.004), glm::dvec3(0.03, 0.03, 0.004));
                if (i % 400 == 399) // off it to the side, and back behind it
                    for (const glm::dvec3& by :
                         {glm::dvec3(0, 0, 0.006), glm::dvec3(0.08, 0, 0.006), glm::dvec3(0.08, 0, -0.006)})
                        bench.moveTo(by, 0.5);
                const glm::dvec3 before = bench.output.hip;
                last = bench.output;
                const HapticOutput& out = bench.step(hip);
                ASSERT_TRUE(std::isfinite(out.force.x + out.force.y + out.force.z));
                if (out.contacts > 0) {
                    ++standing;
                    EXPECT_NEAR(out.proxy.z, stands, 1e-6) << i;
                    EXPECT_LT(out.hip.z, stands + 1e-6);
                    EXPECT_GT(out.force.z, -1e-9) << "the front pushes to the front";
                } else {
                    EXPECT_LT(glm::distance(out.proxy, out.hip), 1e-9);
                    through += last.contacts == 0 && before.z < 0.0 && hip.z > 0.0 ? 1 : 0;
                }
                // Coming through it is not felt, standing on it the spring is.
                const double moved = glm::distance(hip, before);
                EXPECT_LE(glm::distance(out.force, last.force), kStiffness * 2.0 * moved + 1e-6) << i;
            }
            EXPECT_GT(standing, 100);
            EXPECT_GT(through, 0);
        }
}

TEST(OneSided, OverTheRimItIsLeftAndNotHeldFromBelow) {
    for (const HapticSettings& s : allWays()) {
        SCOPED_TRACE(nameOf(s));
        TouchBench bench = benchOf(oneSided(sheet()), s);
        const double depth = 2e-4;
        bench.step({0.04, 0.007, 0.01});
        bench.moveTo({0.04, 0.007, -depth}, 0.1);
        EXPECT_GT(bench.output.contacts, 0u);
        double most = 0.0;
        bench.moveTo({0.056, 0.007, -depth}, 0.1,
                     [&](const HapticOutput& out) { most = std::max(most, glm::length(out.force)); });
        EXPECT_EQ(bench.output.contacts, 0u);
        EXPECT_LT(glm::distance(bench.output.proxy, bench.output.hip), 1e-9);
        EXPECT_LT(most, kStiffness * (depth + feltRadius(s)) * std::sqrt(1.25) * 1.001);
        bench.moveTo({0.04, 0.007, -0.005}, 0.1, [&](const HapticOutput& out) { // under it
            EXPECT_EQ(out.contacts, 0u) << out.hip.x;
        });
        bench.moveTo({0.04, 0.007, 0.01}, 0.1); // and through it again
        EXPECT_EQ(bench.output.contacts, 0u);
    }
}

TEST(OneSided, ARoomIsEnteredFromOutsideAndFeltFromInside) {
    assets::Shape inwards = assets::box({0.1, 0.1, 0.1});
    for (size_t t = 0; t + 2 < inwards.indices.size(); t += 3)
        std::swap(inwards.indices[t + 1], inwards.indices[t + 2]);
    for (glm::vec3& n : inwards.normals)
        n = -n;
    for (const HapticSettings& s : allWays()) {
        SCOPED_TRACE(nameOf(s));
        TouchBench inside = benchOf(oneSided(sceneOf(inwards)), s);
        inside.step({0.01, 0.02, 0.0});
        EXPECT_FALSE(has(inside.output.flags, TickFlag::StartedInside));
        inside.moveTo({0.01, 0.051, 0.0}, 0.1);
        EXPECT_NEAR(inside.output.force.y, -kStiffness * (1e-3 + feltRadius(s)), 1e-3);
        TouchBench outside = benchOf(oneSided(sceneOf(inwards)), s);
        outside.step({0.01, 0.07, 0.003});
        outside.moveTo({0.01, 0.02, 0.0}, 0.1,
                       [&](const HapticOutput& out) { EXPECT_EQ(out.contacts, 0u) << out.hip.y; });
        outside.moveTo({0.0, 0.051, 0.051}, 0.1);
        // Both walls hold; friction may hold some more.
        const double holds = kStiffness * (1e-3 + feltRadius(s)), sticks = 0.5 * holds;
        const double slack = s.friction == FrictionMode::Off ? 1e-3 : sticks;
        EXPECT_NEAR(outside.output.force.y, -holds, slack);
        EXPECT_NEAR(outside.output.force.z, -holds, slack);
    }
}

TEST(OneSided, AMovingSheetPushesWithItsFrontAlone) {
    for (const bool front : {true, false})
        for (const double radius : {0.0, kRadius}) {
            HapticSettings s = Variant{radius, false}.settings();
            TouchBench bench(oneSided(sheet()), s);
            const double side = front ? 1.0 : -1.0;
            bench.step({0.011, 0.007, side * 0.01});
            bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
            for (int i = 0; i < 300; ++i) { // 30 mm at 0.1 m/s, towards the hand and past it
                bench.motions[0].before = bench.motions[0].workspaceFromObject;
                bench.motions[0].workspaceFromObject.translation.z += 1e-4 * side;
                bench.step({0.011, 0.007, side * 0.01});
                if (!front) {
                    EXPECT_LT(glm::length(bench.output.force), 1e-6) << i;
                }
            }
            if (front) {
                EXPECT_NEAR(bench.output.proxy.z, 0.03 + radius, 1e-6);
                EXPECT_NEAR(bench.output.force.z, kStiffness * (0.02 + radius), 1e-2);
            }
        }
}

/// A torus and a room with a corner, pressed by a hand that moves a little.
struct Pressed {
    const char* name;
    Scene scene;
    glm::dvec3 outside, pressed, along;
};
std::vector<Pressed> pressedBodies() {
    assets::Shape room = assets::box({0.1, 0.1, 0.1});
    for (size_t t = 0; t + 2 < room.indices.size(); t += 3)
        std::swap(room.indices[t + 1], room.indices[t + 2]);
    std::vector<Pressed> all;
    all.push_back({"torus",
                   oneSided(sceneOf(assets::torus(0.06, 0.025, 60, 60))),
                   {0.095, 5e-4, 5e-4},
                   {0.084, 5e-4, 5e-4},
                   {0.0, 1.0, 0.3}});
    all.push_back(
        {"corner", oneSided(sceneOf(room)), {0.0, 0.0, 0.0}, {0.051, 0.0508, 0.0512}, {0.01, -0.02, 0.01}});
    return all;
}

/// Presses, lets `change` happen `times` times, a tick after each, and holds on while the hand strokes. The
/// force never falls to less than half of the pressed one. Returns how far clear the proxy stands at the end.
template <class Change>
double clearanceAfter(const Pressed& body, TouchBench& bench, int times, const Change& change) {
    bench.step(body.outside);
    bench.moveTo(body.pressed, 0.1);
    const double pressed = glm::length(bench.output.force);
    EXPECT_GT(pressed, 0.5);
    glm::dvec3 hand = body.pressed;
    double least = INFINITY;
    for (int i = 0; i < times + 200; ++i) {
        if (i < times)
            change(bench, i);
        hand += 2e-5 * body.along;
        bench.step(hand);
        least = std::min(least, glm::length(bench.output.force));
    }
    EXPECT_GT(least, 0.5 * pressed);
    return proxyClearance(bench);
}

TEST(OneSided, ARadiusRaisedInContactLiftsTheProxyAndKeepsTheForce) {
    const std::vector<Pressed> bodies = pressedBodies();
    for (const Pressed& body : bodies)
        for (const double from : {0.0, 1e-4})
            for (const int times : {1, 50})
                for (const HapticSettings& way : allWays()) {
                    if (way.contact != ContactMethod::Sweep)
                        continue;
                    HapticSettings s = way;
                    s.proxyRadius = from;
                    SCOPED_TRACE(std::string(body.name) + " " + nameOf(s) + " in " + std::to_string(times));
                    const auto raise = [&](TouchBench& b, int i) {
                        b.settings.proxyRadius = from + (1e-3 - from) * (i + 1) / times;
                    };
                    TouchBench bench = benchOf(body.scene, s);
                    const double clearance = clearanceAfter(body, bench, times, raise);
                    // Friction may hold a proxy where it stood, as on a body with both sides (a room with
                    // both sides is no body to be inside of).
                    if (s.friction == FrictionMode::Off) {
                        EXPECT_GT(clearance, 1e-3 - 1e-9);
                    } else if (&body == &bodies.front()) {
                        Scene both = body.scene;
                        both.materials[0].haptic.sides = SideChoice::Both;
                        TouchBench twin = benchOf(both, s);
                        EXPECT_NEAR(clearance, clearanceAfter(body, twin, times, raise), 1e-9);
                    }
                }
}

TEST(OneSided, FromTheWatchToASweepWithARadiusTheForceStays) {
    const Pressed body = pressedBodies().front();
    HapticSettings s = Variant{1e-3, false}.settings();
    s.contact = ContactMethod::Neighbourhood;
    TouchBench bench = benchOf(body.scene, s);
    const double clearance =
        clearanceAfter(body, bench, 1, [](TouchBench& b, int) { b.settings.contact = ContactMethod::Sweep; });
    EXPECT_GT(clearance, 1e-3 - 1e-9);
}

TEST(OneSided, AnObjectThatShrinksUnderTheHandKeepsIt) {
    for (const double radius : {0.0, 1e-3})
        for (const HapticSettings& way : allWays()) {
            if (way.contact != ContactMethod::Sweep)
                continue;
            HapticSettings s = way;
            s.proxyRadius = radius;
            SCOPED_TRACE(nameOf(s));
            // The hand is inside a room that closes on it from all sides: its wall comes towards the hand.
            const Pressed room = pressedBodies().back();
            TouchBench bench = benchOf(room.scene, s);
            bench.step({0.0, 0.0, 0.0});
            bench.moveTo({0.002, 0.001, 0.0505 - radius}, 0.1);
            bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
            double before = glm::length(bench.output.force);
            for (int i = 0; i < 200; ++i) {
                bench.motions[0].before = bench.motions[0].workspaceFromObject;
                bench.motions[0].workspaceFromObject.scale *= 0.9995;
                bench.step({0.002, 0.001, 0.0505 - radius});
                EXPECT_GT(glm::length(bench.output.force), before) << "tick " << i;
                before = glm::length(bench.output.force);
            }
        }
}

TEST(OneSided, BesideABothSidedOneEachKeepsItsOwn) {
    Scene scene = sheet(); // one-sided at z = 0, both-sided at z = 10 mm
    scene.materials.emplace_back();
    scene.materials[0].haptic.sides = SideChoice::Front;
    place(scene, quadMesh(0.5 * kSide, 3), 1, glm::dmat4(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0.01, 1));
    for (const HapticSettings& s : allWays()) {
        SCOPED_TRACE(nameOf(s));
        TouchBench bench = benchOf(scene, s);
        bench.step({0.011, 0.007, -0.01});
        bench.moveTo({0.011, 0.007, 0.01203}, 0.1); // through the first, against the second from below
        EXPECT_NEAR(bench.output.force.z, -kStiffness * (2.03e-3 + feltRadius(s)), 1e-2);
        bench.moveTo({0.011, 0.007, -0.001}, 0.1); // back onto the front of the first
        EXPECT_NEAR(bench.output.force.z, kStiffness * (1e-3 + feltRadius(s)), 1e-2);
    }
}

} // namespace
} // namespace touchstone::test::one_sided_test
