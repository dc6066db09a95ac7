#include "renderer/scene_camera.h"

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace touchstone {
namespace {

Bounds unitBox() {
    Bounds bounds;
    bounds.include({-0.5, -0.5, -0.5});
    bounds.include({0.5, 0.5, 0.5});
    return bounds;
}

/// Normalised device coordinates of a point of the scene.
glm::dvec3 seenAt(const View& view, const glm::dvec3& point) {
    const glm::dvec4 clip =
        view.clipFromView * view.viewFromWorkspace * glm::dvec4(view.workspaceFromScene.point(point), 1.0);
    return glm::dvec3(clip) / clip.w;
}

constexpr double kFov = 0.8;
const glm::dvec3 kEye{3.0, 2.0, 5.0}, kUp{0.0, 1.0, 0.0};

TEST(SceneCamera, LooksAtItsTargetWithUpUpwards) {
    Similarity moved;
    moved.scale = 0.15;
    moved.translation = {0.3, -0.2, 0.1};
    const SceneCamera camera = lookAt(kEye, {0.1, 0.2, 0.3}, kUp, kFov);
    EXPECT_NEAR(glm::determinant(camera.axes), 1.0, 1e-14);
    for (const Similarity& fit : {Similarity{}, moved}) {
        const View view = viewOf(camera, fit, unitBox(), 2.0);
        const glm::dvec3 target = seenAt(view, {0.1, 0.2, 0.3}), above = seenAt(view, {0.1, 0.3, 0.3});
        EXPECT_NEAR(glm::length(glm::dvec2(target)), 0.0, 1e-12);
        EXPECT_NEAR(above.x, 0.0, 1e-12);
        EXPECT_GT(above.y, 0.01);
    }
}

TEST(SceneCamera, HalfTheAngleReachesTheEdgeOfThePicture) {
    const SceneCamera camera = lookAt({0.0, 0.0, 4.0}, {}, kUp, kFov);
    const View view = viewOf(camera, {}, unitBox(), 2.0);
    EXPECT_FALSE(view.orthographic());
    EXPECT_NEAR(seenAt(view, {0.0, 4.0 * std::tan(0.5 * kFov), 0.0}).y, 1.0, 1e-12);
    EXPECT_NEAR(seenAt(view, {8.0 * std::tan(0.5 * kFov), 0.0, 0.0}).x, 1.0, 1e-12);
}

TEST(SceneCamera, AnOrthographicFrameHasItsOwnSizeAtAnyDepth) {
    SceneCamera camera = lookAt({0.0, 0.0, 4.0}, {}, kUp, kFov);
    camera.orthographic = true;
    camera.halfHeight = 0.7;
    camera.aspect = 1.5;
    camera.farPlane = 10.0;
    const View view = viewOf(camera, {}, unitBox(), 1.5);
    EXPECT_TRUE(view.orthographic());
    for (const double z : {-0.4, 0.4}) {
        EXPECT_NEAR(seenAt(view, {1.05, 0.7, z}).x, 1.0, 1e-12);
        EXPECT_NEAR(seenAt(view, {1.05, 0.7, z}).y, 1.0, 1e-12);
    }
}

/// In a picture of another shape the whole frame is there, and touches two edges of the picture.
TEST(SceneCamera, ItsFrameIsWhollyInAPictureOfAnyShape) {
    SceneCamera camera = lookAt({0.0, 0.0, 4.0}, {}, kUp, kFov);
    camera.aspect = 1.5;
    const double y = 4.0 * std::tan(0.5 * kFov), x = 1.5 * y;
    const glm::dvec3 wide = seenAt(viewOf(camera, {}, unitBox(), 3.0), {x, y, 0.0}),
                     high = seenAt(viewOf(camera, {}, unitBox(), 0.5), {x, y, 0.0});
    EXPECT_NEAR(wide.x, 0.5, 1e-12);
    EXPECT_NEAR(wide.y, 1.0, 1e-12);
    EXPECT_NEAR(high.x, 1.0, 1e-12);
    EXPECT_NEAR(high.y, 1.0 / 3.0, 1e-12);
}

/// What lies within the file's planes is drawn, from any distance; what lies beyond them is not.
TEST(SceneCamera, PlanesCloseInOnTheModelButNotBeyondTheFiles) {
    for (const double distance : {0.7, 4.0, 4000.0}) {
        SceneCamera camera = lookAt({0.0, 0.0, distance}, {}, kUp, kFov);
        for (const bool orthographic : {false, true}) {
            camera.orthographic = orthographic;
            camera.halfHeight = 1.0;
            camera.nearPlane = 1e-9;
            const View view = viewOf(camera, {}, unitBox(), 1.0);
            EXPECT_GT(seenAt(view, {0.0, 0.0, 0.5}).z, 0.0) << distance;
            EXPECT_LT(seenAt(view, {0.0, 0.0, -0.5}).z, 1.0) << distance;
            camera.nearPlane = distance;
            const View half = viewOf(camera, {}, unitBox(), 1.0);
            EXPECT_LT(seenAt(half, {0.0, 0.0, 0.1}).z, 0.0);
            EXPECT_GT(seenAt(half, {0.0, 0.0, -0.1}).z, 0.0);
            camera.farPlane = distance + 0.2;
            EXPECT_GT(seenAt(viewOf(camera, {}, unitBox(), 1.0), {0.0, 0.0, -0.3}).z, 1.0);
            camera.farPlane = INFINITY;
        }
    }
}

TEST(SceneCamera, EveryViewIsFiniteWhereverItStands) {
    const auto finite = [](const SceneCamera& camera, const Bounds& bounds) {
        const View view = viewOf(camera, {}, bounds, 1.3);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 4; ++row)
                EXPECT_TRUE(std::isfinite(view.clipFromView[column][row]) &&
                            std::isfinite(view.viewFromWorkspace[column][row]));
    };
    Bounds point;
    point.include(glm::dvec3(0.0));
    for (const Bounds& bounds : {unitBox(), point, Bounds{}})
        for (const glm::dvec3& eye :
             {glm::dvec3(0.1, 0.0, 0.0), glm::dvec3(0.0, 0.0, -9.0), glm::dvec3(1e9, 0.0, 0.0)})
            for (const bool away : {false, true}) {
                SceneCamera camera =
                    lookAt(eye, away ? 2.0 * eye : glm::dvec3(0.0, 0.01, 0.0), {0.3, 1.0, 0.2}, kFov);
                finite(camera, bounds);
                camera.orthographic = true;
                camera.halfHeight = 1.0;
                finite(camera, bounds);
            }
}

TEST(SceneCamera, SaysWhyNoCameraCanStandThere) {
    EXPECT_EQ(sightProblem(kEye, {}, kUp), "");
    EXPECT_NE(sightProblem(kEye, kEye, kUp), "");
    EXPECT_NE(sightProblem({}, {}, kUp), "");
    EXPECT_NE(sightProblem(kEye, {}, {}), "");
    EXPECT_NE(sightProblem(kEye, {}, kEye), "");
    EXPECT_NE(sightProblem(kEye, {}, -2.0 * kEye), "");
    EXPECT_NE(sightProblem({NAN, 0.0, 0.0}, {}, kUp), "");
    EXPECT_NE(sightProblem({1e200, 0.0, 0.0}, {}, kUp), "") << "its length overflows";
    EXPECT_EQ(usualUp(kEye, {}), kUp);
    EXPECT_EQ(usualUp({0.0, 3.0, 0.0}, {}), glm::dvec3(0.0, 0.0, -1.0)) << "as in the view from above";
    EXPECT_EQ(usualUp({0.0, -3.0, 0.0}, {}), glm::dvec3(0.0, 0.0, 1.0));
}

TEST(SceneCamera, SaysWhyItSeesNothing) {
    const auto why = [](const glm::dvec3& eye, const glm::dvec3& target) {
        return unseenBecause(lookAt(eye, target, kUp, kFov), unitBox(), 1.0, 600);
    };
    EXPECT_EQ(why(kEye, {}), "");
    EXPECT_EQ(why({0.1, 0.2, 0.0}, kEye), "") << "inside";
    EXPECT_NE(why(kEye, 2.0 * kEye).find("behind"), std::string::npos);
    EXPECT_NE(why(kEye, {6.0, 2.0, -3.0}).find("beside"), std::string::npos);
    EXPECT_NE(why(1e4 * kEye, {}).find("pixel"), std::string::npos);
    SceneCamera camera = lookAt({0.0, 0.0, 5.0}, {}, kUp, kFov);
    camera.nearPlane = 6.0;
    EXPECT_NE(unseenBecause(camera, unitBox(), 1.0, 600).find("near plane"), std::string::npos);
    camera.nearPlane = 1.0;
    camera.farPlane = 2.0;
    EXPECT_NE(unseenBecause(camera, unitBox(), 1.0, 600).find("far plane"), std::string::npos);
    EXPECT_NE(unseenBecause(lookAt(kEye, {}, kUp, kFov), {}, 1.0, 600), "") << "an empty model";
}

TEST(OrbitCamera, LooksStraightFromEverySide) {
    const std::array<glm::dvec3, 6> from{
        {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}}};
    for (size_t side = 0; side < from.size(); ++side) {
        OrbitCamera camera;
        camera.lookFrom(static_cast<Side>(side));
        EXPECT_NEAR(glm::length(camera.eye() - camera.distance * from[side]), 0.0, 1e-12) << kSideNames[side];
    }
}

} // namespace
} // namespace touchstone
