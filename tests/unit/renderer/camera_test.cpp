#include "renderer/camera.h"
#include "renderer/view.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone {
namespace {

OrbitCamera tilted() {
    OrbitCamera camera;
    camera.target = {0.03, -0.02, 0.01};
    camera.orbit(0.7, 0.4);
    return camera;
}

/// Pixel by way of the matrices, as the graphics card does it.
glm::dvec3 projected(const OrbitCamera& camera, const glm::dvec3& point, const glm::dvec2& size) {
    const glm::dvec4 clip =
        camera.clipFromView(size.x / size.y) * camera.viewFromWorkspace() * glm::dvec4(point, 1.0);
    const glm::dvec3 ndc = glm::dvec3(clip) / clip.w;
    return {(0.5 + 0.5 * ndc.x) * size.x, (0.5 - 0.5 * ndc.y) * size.y, ndc.z};
}

TEST(OrbitCamera, AxesAreARightHandedFrame) {
    const OrbitCamera camera = tilted();
    EXPECT_NEAR(glm::length(camera.right()), 1.0, 1e-15);
    EXPECT_NEAR(glm::length(camera.up()), 1.0, 1e-15);
    EXPECT_NEAR(glm::length(glm::cross(camera.right(), camera.up()) + camera.forward()), 0.0, 1e-15);
    EXPECT_GT(camera.up().y, 0.0);
    EXPECT_NEAR(glm::length(camera.target - camera.eye() - camera.distance * camera.forward()), 0.0, 1e-15);
}

TEST(OrbitCamera, StartsWhereTheUserSits) {
    const OrbitCamera camera;
    EXPECT_NEAR(camera.eye().z, camera.distance, 1e-15);
    EXPECT_EQ(camera.right(), glm::dvec3(1.0, 0.0, 0.0));
}

TEST(OrbitCamera, PositiveAnglesMoveTheEyeRightAndUp) {
    OrbitCamera camera;
    camera.orbit(0.1, 0.1);
    EXPECT_GT(camera.eye().x, 0.0);
    EXPECT_GT(camera.eye().y, 0.0);
}

TEST(OrbitCamera, PitchStopsAtThePole) {
    OrbitCamera camera;
    camera.orbit(0.0, 100.0);
    EXPECT_EQ(camera.pitch, OrbitCamera::kMaxPitch);
    EXPECT_GT(camera.up().y, 0.0);
    camera.orbit(0.0, -200.0);
    EXPECT_EQ(camera.pitch, -OrbitCamera::kMaxPitch);
}

TEST(OrbitCamera, YawGoesRoundAndRound) {
    OrbitCamera camera;
    for (int i = 0; i < 1000; ++i)
        camera.orbit(0.1, 0.0);
    EXPECT_LE(std::abs(camera.yaw), 3.1416);
    EXPECT_NEAR(std::cos(camera.yaw), std::cos(100.0), 1e-9);
}

TEST(OrbitCamera, PixelOfAgreesWithTheMatrices) {
    const OrbitCamera camera = tilted();
    const glm::dvec2 size(800.0, 450.0);
    for (const glm::dvec3 point :
         {glm::dvec3(0.0), glm::dvec3(0.05, 0.02, -0.03), glm::dvec3(-0.04, 0.06, 0.02)}) {
        const glm::dvec3 direct = camera.pixelOf(point, size), matrix = projected(camera, point, size);
        EXPECT_NEAR(direct.x, matrix.x, 1e-9);
        EXPECT_NEAR(direct.y, matrix.y, 1e-9);
        EXPECT_GT(matrix.z, 0.0);
        EXPECT_LT(matrix.z, 1.0);
    }
}

TEST(OrbitCamera, RayThroughThePixelOfAPointMeetsIt) {
    const OrbitCamera camera = tilted();
    const glm::dvec2 size(640.0, 480.0);
    const glm::dvec3 point(0.05, 0.02, -0.03);
    const Ray ray = camera.rayThroughPixel(glm::dvec2(camera.pixelOf(point, size)), size);
    EXPECT_NEAR(glm::length(ray.direction), 1.0, 1e-15);
    EXPECT_NEAR(glm::length(glm::cross(point - ray.origin, ray.direction)), 0.0, 1e-14);
}

TEST(OrbitCamera, ViewPlaneDisplacementFollowsThePointer) {
    const OrbitCamera camera = tilted();
    const glm::dvec2 size(640.0, 480.0), pixels(37.0, -21.0);
    const glm::dvec3 at(0.05, 0.02, -0.03);
    const glm::dvec3 moved = at + camera.viewPlaneDisplacement(pixels, size.y, at);
    const glm::dvec3 before = camera.pixelOf(at, size), after = camera.pixelOf(moved, size);
    EXPECT_NEAR(after.x - before.x, pixels.x, 1e-9);
    EXPECT_NEAR(after.y - before.y, pixels.y, 1e-9);
    EXPECT_NEAR(after.z, before.z, 1e-15) << "the movement stays in the view plane";
}

TEST(OrbitCamera, ViewPlaneDisplacementBehindTheEyeIsFiniteAndKeepsItsSense) {
    const OrbitCamera camera;
    const glm::dvec3 moved = camera.viewPlaneDisplacement({10.0, 0.0}, 480.0, glm::dvec3(0.0, 0.0, 5.0));
    EXPECT_GT(moved.x, 0.0);
    EXPECT_LT(moved.x, 0.1);
}

TEST(OrbitCamera, PanMovesTheTargetWithThePointer) {
    OrbitCamera camera = tilted();
    const glm::dvec3 grabbed = camera.target;
    const glm::dvec2 size(640.0, 480.0);
    const glm::dvec3 before = camera.pixelOf(grabbed, size);
    camera.pan({12.0, 34.0}, size.y);
    const glm::dvec3 after = camera.pixelOf(grabbed, size);
    EXPECT_NEAR(after.x - before.x, 12.0, 1e-9);
    EXPECT_NEAR(after.y - before.y, 34.0, 1e-9);
}

TEST(OrbitCamera, FramedBoxIsInsideTheImageAndFillsIt) {
    for (const double aspect : {0.5, 1.0, 16.0 / 9.0}) {
        OrbitCamera camera = tilted();
        Bounds box;
        box.include({-0.06, -0.02, -0.05});
        box.include({0.09, 0.03, 0.01});
        camera.frame(box, aspect);
        const glm::dvec2 size(450.0 * aspect, 450.0);
        double furthest = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 point((corner & 1) ? box.low.x : box.high.x,
                                   (corner & 2) ? box.low.y : box.high.y,
                                   (corner & 4) ? box.low.z : box.high.z);
            const glm::dvec3 pixel = projected(camera, point, size);
            EXPECT_GT(pixel.z, 0.0);
            EXPECT_LT(pixel.z, 1.0);
            furthest = std::max(
                {furthest, std::abs(2.0 * pixel.x / size.x - 1.0), std::abs(2.0 * pixel.y / size.y - 1.0)});
        }
        EXPECT_LT(furthest, 1.0);
        EXPECT_GT(furthest, 0.5);
    }
}

/// The same of parallel lines of sight, at any zoom: pixels, rays and movements agree with the matrices, and
/// nothing between eye and far plane is cut away.
TEST(OrbitCamera, OrthographicViewsArePickedWhereTheyAreDrawn) {
    const glm::dvec2 size(640.0, 480.0);
    for (const double zoom : {1.0, 0.05, 20.0}) {
        OrbitCamera camera = tilted();
        camera.orthographic = true;
        camera.zoom(zoom);
        for (const glm::dvec3 point :
             {glm::dvec3(0.0), glm::dvec3(0.05, 0.02, -0.03), glm::dvec3(-0.04, 0.06, 0.02)}) {
            const glm::dvec3 direct = camera.pixelOf(point, size), matrix = projected(camera, point, size);
            EXPECT_NEAR(direct.x, matrix.x, 1e-8);
            EXPECT_NEAR(direct.y, matrix.y, 1e-8);
            EXPECT_GT(matrix.z, 0.0) << zoom;
            EXPECT_LT(matrix.z, 1.0) << zoom;
            const Ray ray = camera.rayThroughPixel(glm::dvec2(direct), size);
            EXPECT_NEAR(glm::length(glm::cross(point - ray.origin, ray.direction)), 0.0, 1e-13);
            EXPECT_GT(glm::dot(point - ray.origin, ray.direction), 0.0) << "it starts before the model";
            const glm::dvec3 moved = point + camera.viewPlaneDisplacement({7.0, -3.0}, size.y, point);
            EXPECT_NEAR(camera.pixelOf(moved, size).x, direct.x + 7.0, 1e-8);
            EXPECT_NEAR(camera.pixelOf(moved, size).y, direct.y - 3.0, 1e-8);
        }
    }
}

TEST(OrbitCamera, OrthographicShowsAtTheTargetWhatThePerspectiveShows) {
    OrbitCamera camera = tilted();
    const glm::dvec2 size(640.0, 480.0);
    const glm::dvec3 beside = camera.target + 0.02 * camera.right() - 0.01 * camera.up();
    const glm::dvec3 perspective = camera.pixelOf(beside, size);
    camera.orthographic = true;
    const glm::dvec3 parallel = camera.pixelOf(beside, size);
    EXPECT_NEAR(parallel.x, perspective.x, 1e-9);
    EXPECT_NEAR(parallel.y, perspective.y, 1e-9);
}

TEST(OrbitCamera, ThreeQuarterViewSeesThreeSidesOfABox) {
    Bounds box;
    box.include(glm::dvec3(-0.05));
    box.include(glm::dvec3(0.05));
    const glm::dvec3 toEye = -OrbitCamera::threeQuarter(box, 1.5).forward();
    for (int axis = 0; axis < 3; ++axis)
        EXPECT_GT(toEye[axis], 0.2);
}

TEST(OrbitCamera, FramingNothingLeavesAUsableCamera) {
    OrbitCamera camera;
    camera.frame(Bounds{});
    EXPECT_GT(camera.distance, 0.0);
    EXPECT_GT(camera.nearPlane(), 0.0);
    EXPECT_LT(camera.nearPlane(), camera.farPlane());
    Bounds point;
    point.include({1.0, 2.0, 3.0});
    camera.frame(point);
    EXPECT_GT(camera.distance, 0.0);
    EXPECT_EQ(camera.target, glm::dvec3(1.0, 2.0, 3.0));
}

TEST(OrbitCamera, ZoomIsBounded) {
    OrbitCamera camera;
    for (int i = 0; i < 1000; ++i)
        camera.zoom(0.5);
    EXPECT_NEAR(camera.distance, 1e-2 * camera.sceneRadius, 1e-12);
    EXPECT_GT(camera.nearPlane(), 0.0);
    EXPECT_LT(camera.nearPlane(), camera.distance);
    for (int i = 0; i < 1000; ++i)
        camera.zoom(2.0);
    EXPECT_NEAR(camera.distance, 1e3 * camera.sceneRadius, 1e-9);
}

TEST(View, LightsMoveWithTheCameraAndComeFromItsSide) {
    const OrbitCamera camera = tilted();
    const View view = viewOf(camera, {}, 1.0);
    const std::array<Lamp, 2>& lamps = view.surroundings.lamps;
    for (const glm::dvec3& towards : {view.lights[0].toLight, lamps[0].towards, lamps[1].towards}) {
        EXPECT_GT(glm::dot(towards, -camera.forward()), 0.0);
        EXPECT_GT(glm::dot(towards, camera.up()), 0.0);
    }
    EXPECT_LT(glm::dot(view.lights[0].toLight, camera.right()), 0.0);
    EXPECT_LT(glm::dot(lamps[0].towards, camera.right()), 0.0);
    EXPECT_GT(glm::dot(lamps[1].towards, camera.right()), 0.0);
    EXPECT_EQ(view.lights[1].irradiance, glm::vec3(0.0f)) << "a light that is off costs nothing";
}

} // namespace
} // namespace touchstone
