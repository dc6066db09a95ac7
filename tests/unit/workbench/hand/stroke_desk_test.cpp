// Where the simulated hand's strokes are laid: around what was touched last, also on what moves.

#include "haptics/query/surface_pick.h"
#include "tests/support/recorded_servo.h"
#include "workbench/hand/picker.h"
#include "workbench/hand/stroke_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <thread>

namespace touchstone::test::stroke_desk_test {
namespace {

TEST(StrokeController, IsAroundTheTouchedPointWheneverTheHandIsChosen) {
    const TouchedScene scene = touchedScene("doughnut.glb");
    const Similarity& fit = scene.haptic->workspaceFromScene;
    StrokeController controller;
    controller.show(scene.source, fit,
                    std::make_shared<const StrokePath>(layStroke(*scene.source, fit, StrokeRequest{})));
    const StrokeRequest press{.name = "press"};
    const glm::dvec3 front(0.0, 0.0, 1.0);
    for (const double side : {1.0, -1.0, 1.0}) {
        EXPECT_EQ(controller.update(press, front, false), nullptr) << "the mouse";
        const auto hit = pickSurface(*scene.haptic, {}, {0.04 * side, 0.03, 1.0}, {0.0, 0.0, -1.0});
        ASSERT_TRUE(hit);
        controller.touched({hit->point, hit->normal});
        std::shared_ptr<const StrokePath> path;
        for (int i = 0; i < 2000 && path == nullptr; ++i) {
            path = controller.update(press, front, true);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        ASSERT_NE(path, nullptr) << side << " " << controller.notice();
        EXPECT_LT(glm::distance(path->place(), hit->point), 2e-3);
        EXPECT_EQ(controller.update(press, front, true), nullptr) << "it is laid once";
    }
}

TEST(Picker, KnowsWhereWhatMovesIsAtRest) {
    const TouchedScene scene = touchedScene("moving.glb");
    WorldState world(scene.source, *scene.haptic);
    Picker picker;
    picker.show(scene.haptic, scene.source);
    int carried = 0;
    for (double x = -0.1; x <= 0.1; x += 0.01)
        for (const double time : {0.3, 0.8, 1.7}) {
            const auto hit =
                pickSurface(*scene.haptic, world.advance(time), {x, 0.011, 1.0}, {0.0, 0.0, -1.0});
            if (!hit)
                continue;
            const Similarity rest = picker.restFromNow(hit->object, time);
            const glm::dvec3 point = rest.point(hit->point), normal = rest.direction(hit->normal);
            const auto there = pickSurface(*scene.haptic, {}, point + 1e-4 * normal, -normal);
            ASSERT_TRUE(there) << x << ", " << time;
            EXPECT_LT(glm::distance(there->point, point), 1e-6);
            carried += glm::distance(point, hit->point) > 1e-3 ? 1 : 0;
        }
    EXPECT_GT(carried, 3) << "they have moved";
    EXPECT_EQ(picker.restFromNow(-1, 0.3).point({1.0, 2.0, 3.0}), glm::dvec3(1.0, 2.0, 3.0));
}

/// What a press is bounded by in the air, where it may meet any of them.
TEST(Picker, KnowsTheStiffestAndTheRoughest) {
    const TouchedScene scene = touchedScene("swatches.glb");
    Picker picker;
    picker.show(scene.haptic, scene.source);
    double stiffest = 0.0, roughest = 0.0;
    for (const auto& object : scene.haptic->objects) {
        const HapticMaterialData& material = scene.haptic->materials[static_cast<size_t>(object->material)];
        const double stiffness =
            std::isnan(material.stiffness) ? DeviceLimits{}.recommendedStiffness : material.stiffness;
        stiffest = std::max(stiffest, std::min(stiffness, DeviceLimits{}.maxStiffness));
        roughest = std::max(roughest, material.staticFriction);
    }
    const Ray ray{{0.01, 0.02, 1.0}, {0.0, 0.0, -1.0}};
    const auto seen = picker.look(ray, 0.0, {}, {});
    ASSERT_TRUE(seen);
    EXPECT_GT(roughest, 0.0);
    EXPECT_GE(seen->stiffest, stiffest);
    EXPECT_LE(seen->stiffest, DeviceLimits{}.maxStiffness);
    EXPECT_GE(seen->stiffest, seen->stiffness);
    EXPECT_GE(seen->friction, roughest);
    HapticSettings settings;
    settings.stiffness = 5000.0;
    settings.staticFriction = 3.0;
    EXPECT_GE(picker.look(ray, 0.0, settings, {})->stiffest, 5000.0) << "what is asked for is not cut";
    EXPECT_GE(picker.look(ray, 0.0, settings, {})->friction, 3.0);
    EXPECT_EQ(picker.look(ray, 0.0, settings, {})->grip, 1.0);
    settings.friction = FrictionMode::Ho;
    settings.dynamicFriction = 1.0;
    EXPECT_EQ(picker.look(ray, 0.0, settings, {})->grip, 3.0);
    settings.dynamicFriction = 0.0;
    EXPECT_GE(picker.look(ray, 0.0, settings, {})->grip, 100.0);
    EXPECT_TRUE(std::isfinite(picker.look(ray, 0.0, settings, {})->grip));
    settings.friction = FrictionMode::Off;
    EXPECT_EQ(picker.look(ray, 0.0, settings, {})->friction, 0.0);
}

} // namespace
} // namespace touchstone::test::stroke_desk_test
