// Hidden and cut objects are felt as they are seen: not at all beyond the plane, unchanged before it, and
// open at the cut.

#include "engine/scene/clip_mesh.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/query/clear_of_model.h"
#include "haptics/query/surface_pick.h"
#include "haptics/scene/scene_parts.h"
#include "haptics/tick/stepped_hand.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace touchstone::test {
namespace {

/// A bench that touches a part of its scene.
struct PartBench : TouchBench {
    Scene source;
    PartBench(const Scene& whole, const ScenePart& part, const HapticSettings& chosen = {})
        : TouchBench(whole, chosen), source(whole) {
        show(part);
    }
    void show(const ScenePart& part) { scene = partOf(*scene, source, part); }
};

HapticSettings plainSettings() {
    HapticSettings settings;
    settings.stiffness = 500.0;
    settings.proxyRadius = 0.0005;
    settings.friction = FrictionMode::Off;
    settings.forceShading = ShadingMode::Off;
    settings.damping = 0.0;
    return settings;
}

ScenePart clipped(const glm::dvec3& normal, double offset) {
    ScenePart part;
    part.clip = clipPlane(normal, offset);
    return part;
}

TEST(SceneParts, AHiddenObjectIsMetByNothing) {
    Scene scene = sceneOf(assets::box({0.1, 0.1, 0.1}));
    addShape(scene, assets::box({0.1, 0.1, 0.1}), glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0, 0)));
    PartBench bench(scene, {.hidden = {0}, .clip = {}}, plainSettings());
    ASSERT_EQ(bench.scene->objects.size(), 2u) << "objects keep their numbers";
    EXPECT_TRUE(bench.scene->objects[0]->empty());
    EXPECT_FALSE(bench.scene->objects[1]->empty());
    bench.moveTo({0.0, 0.06, 0.0}, 0.2);
    const auto untouched = [](const HapticOutput& output) {
        ASSERT_EQ(output.contacts, 0u);
        ASSERT_EQ(output.force, glm::dvec3(0.0));
    };
    bench.moveTo({0.0, 0.0, 0.0}, 0.2, untouched);
    const glm::dvec3 above(0.2, 0.06, 0.0);
    bench.moveTo({0.0, 0.06, 0.0}, 0.2, untouched);
    bench.moveTo(above, 0.2, untouched);
    bench.moveTo({0.2, 0.047, 0.0}, 0.2);
    EXPECT_NEAR(bench.output.force.y, 500.0 * 0.0035, 1e-6);
    EXPECT_EQ(bench.output.object, 1);
    EXPECT_TRUE(clearOfModel(*bench.scene, bench.scene->restMotions, glm::dvec3(0.0)));
    EXPECT_FALSE(pickSurface(*bench.scene, {}, {0, 1, 0}, {0, -1, 0}));
    bench.scene->buildRays();
    bench.scene->buildNeighbourhoods();
    for (const ContactMethod method : {ContactMethod::Rays, ContactMethod::Neighbourhood}) {
        TouchBench other(scene, plainSettings());
        other.scene = bench.scene;
        other.settings.contact = method;
        other.moveTo({0.0, 0.06, 0.0}, 0.2);
        other.moveTo({0.0, 0.0, 0.0}, 0.2, untouched);
    }
}

TEST(SceneParts, SharesWhatThePlaneDoesNotCut) {
    const Scene scene = sceneOf(assets::sphere(0.05, 32, 64));
    const auto whole = compileHapticScene(scene, Similarity{});
    EXPECT_EQ(partOf(*whole, scene, clipped({1, 0, 0}, 0.06))->objects[0], whole->objects[0]);
    EXPECT_TRUE(partOf(*whole, scene, clipped({1, 0, 0}, -0.06))->objects[0]->empty());
    EXPECT_TRUE(partOf(*whole, scene, clipped({1, 0, 0}, -0.0500001))->objects[0]->empty());
    const auto half = partOf(*whole, scene, clipped({1, 0, 0}, 0.01))->objects[0];
    EXPECT_FALSE(half->closed);
    EXPECT_LT(half->triangleCount(), whole->objects[0]->triangleCount());
}

/// In free space the proxy would otherwise go along with an object that is hidden and moves.
TEST(SceneParts, AProxyBesideAHiddenObjectMovesToTheFrameOfOneThatIsLeft) {
    Scene scene = sceneOf(assets::box({0.1, 0.1, 0.1}));
    addShape(scene, assets::box({0.05, 0.05, 0.05}), glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0, 0)));
    PartBench bench(scene, {}, plainSettings());
    bench.moveTo({0.0, 0.06, 0.0}, 0.2);
    DeviceState& state = bench.state[0];
    ASSERT_EQ(state.reference, 0);
    const auto proxy = [&] {
        return bench.scene->restMotions[static_cast<size_t>(state.reference)].workspaceFromObject.point(
            state.proxy);
    };
    const glm::dvec3 before = proxy();
    bench.show({.hidden = {0}, .clip = {}});
    EXPECT_EQ(nearestObject(*bench.scene, bench.scene->restMotions, glm::dvec3(0.0)), 1);
    letGoOfEmptied(*bench.scene, bench.scene->restMotions, state);
    EXPECT_EQ(state.reference, 1);
    EXPECT_TRUE(state.placed);
    EXPECT_FALSE(state.mustLeave);
    EXPECT_LT(glm::distance(proxy(), before), 1e-15);
}

/// The plane leaves this strip as many vertices and triangles as it had. Failed: it was felt whole.
TEST(SceneParts, CutsAStripThatKeepsItsNumberOfTriangles) {
    assets::Shape strip;
    strip.positions = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 0}, {2, 0, 0}, {2, 1, 0}};
    strip.normals.assign(6, {0, 0, 1});
    strip.indices = {0, 1, 2, 1, 2, 3, 2, 3, 4, 3, 4, 5};
    const Scene scene = sceneOf(strip);
    const auto whole = compileHapticScene(scene, Similarity{});
    const auto part = partOf(*whole, scene, clipped({1, 0.5, 0}, 1.0733));
    EXPECT_NE(part->objects[0], whole->objects[0]);
    EXPECT_TRUE(pickSurface(*part, {}, {0.3, 0.3, 1}, {0, 0, -1}));
    EXPECT_FALSE(pickSurface(*part, {}, {1.7, 0.5, 1}, {0, 0, -1}));
}

/// A floor in y = 0 whose part beyond a line is cut away, by planes through vertices, along edges and at any
/// angle. Over the kept part the force is that of the whole floor in closed form; beyond the line, farther
/// than the ball reaches, there is none; in between it never exceeds the whole floor's.
TEST(SceneParts, ACutFloorIsTheFloorUpToTheCut) {
    const Scene scene = sceneOf(assets::plane(0.1, 0.1, 8, 8));
    const HapticSettings settings = plainSettings();
    constexpr double kDepth = 0.002;
    std::mt19937 random(11);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    size_t kept = 0, gone = 0;
    for (int trial = 0; trial < 40; ++trial) {
        glm::dvec3 normal(1, 0, 0);
        double offset = 0.0;
        if (trial > 0) {
            normal = trial < 3   ? glm::dvec3(1, 0, trial == 1 ? 1 : -1)
                     : trial < 8 ? glm::dvec3(1, 0, 0.001 * number(random))
                                 : glm::dvec3(number(random), 0.8 * number(random), number(random));
            offset = trial < 3 ? 0.0 : trial < 8 ? 0.0125 + 1e-7 * number(random) : 0.02 * number(random);
        }
        const ScenePart part = clipped(normal, offset);
        const ClipPlane& plane = *part.clip;
        // Along the floor, across the cut.
        const double lean = std::hypot(plane.normal.x, plane.normal.z);
        const glm::dvec3 across = glm::dvec3(plane.normal.x, 0, plane.normal.z) / lean;
        const glm::dvec3 line = across * (plane.offset / lean);
        PartBench bench(scene, part, settings);
        bench.moveTo(line - 0.02 * across + glm::dvec3(0, 0.01, 0), 0.3);
        bench.moveTo(line - 0.02 * across - glm::dvec3(0, kDepth, 0), 0.3);
        bench.moveTo(line + 0.02 * across - glm::dvec3(0, kDepth, 0), 0.05, [&](const HapticOutput& output) {
            const double beyond = glm::dot(output.hip - line, across);
            const double whole = settings.stiffness * (settings.proxyRadius - output.hip.y);
            if (beyond < -1e-9) {
                ASSERT_NEAR(output.force.y, whole, 2e-6 * whole) << trial << " at " << beyond;
                ASSERT_LT(std::hypot(output.force.x, output.force.z), 2e-6 * whole) << trial;
                ++kept;
            } else {
                ASSERT_LE(glm::length(output.force), whole * (1.0 + 2e-6)) << trial << " at " << beyond;
                // Beside the rim the ball may hang on it, until it rolls over.
                if (beyond > settings.proxyRadius + 1e-6) {
                    ASSERT_EQ(output.contacts, 0u) << trial << " at " << beyond;
                    ++gone;
                }
            }
            ASSERT_FALSE(has(output.flags, TickFlag::BudgetReached)) << trial;
        });
    }
    EXPECT_GT(kept, 10000u);
    EXPECT_GT(gone, 10000u);
}

/// A closed box is open where it is cut: the hand goes in through the cut, and feels the walls from inside.
TEST(SceneParts, TheHandEntersThroughTheCut) {
    const Scene scene = sceneOf(assets::box({0.1, 0.1, 0.1}, 4));
    PartBench bench(scene, clipped({0, 1, 0}, 0.02), plainSettings());
    bench.moveTo({0.0, 0.08, 0.0}, 0.3);
    bench.moveTo({0.0, -0.03, 0.0}, 0.3, [](const HapticOutput& output) { ASSERT_EQ(output.contacts, 0u); });
    bench.moveTo({0.0, -0.052, 0.0}, 0.3);
    EXPECT_NEAR(bench.output.force.y, 500.0 * 0.0025, 1e-6) << "the bottom from inside";
    bench.moveTo({0.0, -0.03, 0.0}, 0.3);
    bench.moveTo({0.052, -0.03, 0.0}, 0.3);
    EXPECT_NEAR(bench.output.force.x, -500.0 * 0.0025, 1e-6) << "a wall from inside";
    // Over the rim and down the outside of the wall that it left.
    bench.moveTo({0.03, 0.0, 0.0}, 0.3);
    bench.moveTo({0.03, 0.04, 0.0}, 0.3, [](const HapticOutput& output) { ASSERT_EQ(output.contacts, 0u); });
    bench.moveTo({0.07, 0.04, 0.0}, 0.3, [](const HapticOutput& output) { ASSERT_EQ(output.contacts, 0u); });
    bench.moveTo({0.07, 0.0, 0.0}, 0.3);
    bench.moveTo({0.048, 0.0, 0.0}, 0.3);
    EXPECT_NEAR(bench.output.force.x, 500.0 * 0.0025, 1e-6);
}

/// A hand that goes about on what is left of a sphere, over the rim too, is never where the whole sphere's
/// wall would have to be crossed: against the whole scene while it is away from the rim, and never through
/// the wall, however the plane cuts the mesh.
TEST(SceneParts, NothingLeaksAndNothingCatchesOnACutSphere) {
    const double radius = 0.05;
    const Scene scene = sceneOf(assets::sphere(radius, 48, 96));
    HapticSettings settings = plainSettings();
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    size_t compared = 0;
    for (int trial = 0; trial < 25; ++trial) {
        settings.proxyRadius = trial % 2 == 0 ? 0.0 : 0.001;
        const glm::dvec3 normal = trial < 3 ? glm::dvec3(trial == 0, trial == 1, trial == 2)
                                            : glm::dvec3(number(random), number(random), number(random));
        const ScenePart part = clipped(normal, trial < 3 ? 0.0 : 0.03 * number(random));
        PartBench cut(scene, part, settings);
        TouchBench whole(scene, settings);
        // A great circle that begins in the middle of what is left and stays on it.
        const glm::dvec3 pole = -part.clip->normal;
        const glm::dvec3 side = glm::normalize(glm::cross(pole, glm::dvec3(0.3, 0.9, -0.2)));
        const double last = std::acos(std::clamp(-part.clip->offset / radius, -1.0, 1.0));
        const auto at = [&](double angle, double height) {
            return (radius + height) * (std::cos(angle) * pole + std::sin(angle) * side);
        };
        for (TouchBench* bench : {static_cast<TouchBench*>(&cut), &whole})
            bench->moveTo(at(0.0, 0.01), 0.3);
        constexpr double kDepth = 0.003;
        const double step = 1e-4 / radius;
        for (double angle = 0.0; angle < last + 0.3; angle += step) {
            const HapticOutput& a = cut.step(at(angle, -kDepth * std::min(1.0, angle / 0.05)));
            if (angle > last - 0.08) { // the ball's and the facets' reach from the rim
                ASSERT_LE(glm::length(a.force), settings.stiffness * (kDepth + 0.0011)) << trial;
                if (angle > last + 0.1) {
                    ASSERT_EQ(a.contacts, 0u) << trial << ": it hangs on the rim";
                }
                continue;
            }
            const HapticOutput& b = whole.step(a.hip);
            ASSERT_NEAR(glm::distance(a.force, b.force), 0.0, 2e-5 * settings.stiffness * kDepth)
                << trial << " at " << angle;
            ASSERT_FALSE(has(a.flags, TickFlag::BudgetReached));
            ++compared;
        }
        // Back against the wall from within: the far side holds it.
        cut.moveTo(glm::dvec3(0.0), 0.1);
        cut.moveTo(1.1 * radius * pole, 0.1);
        EXPECT_NEAR(glm::length(cut.output.proxy), radius - settings.proxyRadius, 1.5e-4) << trial;
    }
    EXPECT_GT(compared, 5000u);
}

/// Of an object that moves the plane cuts what rests; the cut goes along.
TEST(SceneParts, TheCutMovesWithItsObject) {
    const Scene scene = sceneOf(assets::box({0.1, 0.1, 0.1}, 4));
    PartBench bench(scene, clipped({0, 1, 0}, 0.02), plainSettings());
    Similarity moved = bench.scene->restMotions[0].workspaceFromObject;
    moved.translation += glm::dvec3(0.5, 0.0, 0.0);
    bench.motions = {{moved, moved}};
    bench.world.place(bench.motions);
    bench.moveTo({0.5, 0.08, 0.0}, 0.3);
    bench.moveTo({0.5, -0.03, 0.0}, 0.3, [](const HapticOutput& output) { ASSERT_EQ(output.contacts, 0u); });
    bench.moveTo({0.5, -0.052, 0.0}, 0.3);
    EXPECT_NEAR(bench.output.force.y, 500.0 * 0.0025, 1e-6);
}

} // namespace
} // namespace touchstone::test
