// Cameras that stand in the scene, against golden pictures.

#include "renderer/scene_camera.h"
#include "tests/screenshot/golden.h"
#include "tests/screenshot/renderer_fixture.h"

namespace touchstone::test::camera_test {
namespace {

constexpr double kAspect = 320.0 / 180.0;

class CameraPicture : public RendererFixture {
  protected:
    static PixelData seen(const ScenePtr& scene, const SceneCamera& camera) {
        return draw(scene, viewOf(camera, {}, scene->bounds, kAspect));
    }
    /// Beside the torus and below it, with its axis across the picture.
    static SceneCamera low() { return lookAt({0.12, -0.05, 0.14}, {0.0, 0.0, 0.02}, {1.0, 0.2, 0.0}, 0.9); }
    static SceneCamera flat() {
        SceneCamera camera = lookAt({0.2, 0.15, 0.1}, {}, {0.0, 1.0, 0.0}, 0.0);
        camera.orthographic = true;
        camera.halfHeight = 0.07;
        camera.aspect = 1.0;
        camera.farPlane = 1.0;
        return camera;
    }
};

TEST_F(CameraPicture, PerspectiveWithItsOwnUp) {
    const auto scene = torusScene();
    expectMatchesGolden("camera_perspective", seen(scene, low()));
    SceneCamera camera = low();
    camera.fovY = 1.0;
    expectMutationIsSeen("camera_perspective", "another angle", seen(scene, camera));
    expectMutationIsSeen("camera_perspective", "another up",
                         seen(scene, lookAt(camera.eye, {0.0, 0.0, 0.02}, {0.0, 1.0, 0.0}, 0.9)));
    expectMutationIsSeen("camera_perspective", "another target",
                         seen(scene, lookAt(camera.eye, {0.0, 0.01, 0.02}, {1.0, 0.2, 0.0}, 0.9)));
}

TEST_F(CameraPicture, Orthographic) {
    const auto scene = torusScene();
    expectMatchesGolden("camera_orthographic", seen(scene, flat()));
    SceneCamera camera = flat();
    camera.halfHeight = 0.075;
    expectMutationIsSeen("camera_orthographic", "another height", seen(scene, camera));
    camera = flat();
    camera.orthographic = false;
    camera.fovY = 2.0 * std::atan(0.07 / glm::length(camera.eye));
    expectMutationIsSeen("camera_orthographic", "a perspective", seen(scene, camera));
    camera = flat();
    camera.nearPlane = glm::length(camera.eye);
    expectMutationIsSeen("camera_orthographic", "cut by its near plane", seen(scene, camera));
}

/// Parallel lines of sight: the same picture from any distance, highlights and all.
TEST_F(CameraPicture, OrthographicPicturesDoNotDependOnTheDistance) {
    const auto scene = torusScene();
    SceneCamera camera = flat();
    const PixelData before = seen(scene, camera);
    camera.eye *= 3.0;
    EXPECT_LT(failingShare(before, seen(scene, camera)), 1e-3);
}

/// The camera of the window, as one that stands in the scene.
TEST_F(CameraPicture, SeesWhatTheOrbitCameraSees) {
    const auto scene = torusScene();
    const OrbitCamera orbit = cameraFor(*scene, kAspect);
    const SceneCamera camera = lookAt(orbit.eye(), orbit.target, {0.0, 1.0, 0.0}, orbit.fovY);
    EXPECT_LT(failingShare(draw(scene, viewOf(orbit, {}, kAspect)), seen(scene, camera)), 1e-3);
}

/// Glass before its contents, from the farthest: the order of what lets see through it is that of the depth.
TEST_F(CameraPicture, OrthographicGlassIsSortedByDepth) {
    const auto scene = glassBoard();
    SceneCamera camera;
    camera.orthographic = true;
    camera.eye = scene->bounds.centre() + glm::dvec3(0.0, 0.0, 1.0);
    camera.halfHeight = 0.5 * scene->bounds.extent().y;
    camera.aspect = kAspect;
    camera.farPlane = 10.0;
    expectMatchesGolden("camera_glass", seen(scene, camera));
    expectMutationIsSeen("camera_glass", "a mistake", seen(glassBoard(0), camera));
}

} // namespace
} // namespace touchstone::test::camera_test
