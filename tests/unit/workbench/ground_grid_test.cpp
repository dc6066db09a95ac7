// The grid on the ground beneath a model.

#include "renderer/camera.h"
#include "workbench/screen/ground_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace touchstone::test::ground_grid_test {
namespace {

/// Failed: the near end of a long thin model's grid lay before the near plane.
TEST(GroundGrid, LiesBetweenTheCamerasPlanesFromEverySide) {
    double farthest = 0.0;
    const auto check = [&](const Bounds& model, const OrbitCamera& camera) {
        const Bounds grid = GroundGrid(model).bounds;
        for (const glm::dvec3& corner : {grid.low, grid.high, glm::dvec3(grid.low.x, grid.low.y, grid.high.z),
                                         glm::dvec3(grid.high.x, grid.low.y, grid.low.z)}) {
            const double depth = glm::dot(corner - camera.eye(), camera.forward());
            farthest = std::max(farthest, glm::length(corner) / camera.sceneRadius);
            ASSERT_LT(depth, camera.farPlane()) << camera.yaw << " " << camera.pitch;
            if (!camera.orthographic && depth <= 0.05 * camera.distance)
                continue; // beside or behind the eye
            ASSERT_GT(depth, camera.nearPlane()) << camera.yaw << " " << camera.pitch;
        }
    };
    constexpr std::array kExtents{glm::dvec3(1.0, 0.01, 0.01), glm::dvec3(0.01, 0.01, 1.0),
                                  glm::dvec3(1.0, 0.1, 0.3),   glm::dvec3(1.0, 0.01, 1.0),
                                  glm::dvec3(1.0, 1.0, 1.0),   glm::dvec3(0.01, 1.0, 0.01)};
    for (const glm::dvec3& extent : kExtents)
        for (const double size : {0.001, 0.19, 7.3})
            for (int view = 0; view < 60 * 30 * 4; ++view) {
                const Bounds model{-0.5 * size * extent, 0.5 * size * extent};
                OrbitCamera camera;
                camera.orthographic = view % 2 != 0;
                camera.orbit(0.105 * (view / 120), 0.1 * (view / 4 % 30) - 1.5);
                camera.frame(model);
                camera.zoom(view / 2 % 2 != 0 ? 2.0 : 1.0);
                ASSERT_NO_FATAL_FAILURE(check(model, camera));
            }
    EXPECT_GT(farthest, 1.7);
    EXPECT_LT(farthest, 2.0);
}

} // namespace
} // namespace touchstone::test::ground_grid_test
