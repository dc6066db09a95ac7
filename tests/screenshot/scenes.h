#pragma once
// The scenes that screenshot tests and the probe draw.

#include "renderer/camera.h"
#include "renderer/overlay.h"
#include "renderer/view.h"
#include "tests/support/test_shapes.h"

#include <glm/gtc/matrix_transform.hpp>

namespace touchstone::test {

/// The torus of 64,800 triangles with base colour, roughness, normal, occlusion and height maps.
inline std::shared_ptr<Scene> torusScene(int columns = 324, int rows = 100) {
    auto scene = std::make_shared<Scene>();
    scene->path = "torus";
    scene->images.push_back(
        checkerImage("color", 2, {0.86f, 0.52f, 0.30f, 1.0f}, {0.80f, 0.43f, 0.24f, 1.0f}));
    scene->images.push_back(
        checkerImage("roughness", 4, {1.0f, 0.35f, 0.0f, 1.0f}, {1.0f, 0.5f, 0.0f, 1.0f}));
    scene->images.push_back(bumpNormalImage("normal", 0.04));
    scene->images.push_back(image("height", 64, 64, 1, [](double u, double v) {
        const double k = glm::two_pi<double>();
        return glm::vec4(static_cast<float>(0.5 + 0.5 * std::cos(k * u) * std::cos(k * v)));
    }));
    Material material;
    material.baseColorTexture = texture(0);
    material.metallicRoughnessTexture = texture(1);
    material.normalTexture = texture(2);
    material.haptic.height.value = HeightMap{texture(3), 0.002f, 0.5f};
    material.haptic.staticFriction.value = 0.4f;
    scene->materials.push_back(material);
    place(*scene, torusMesh(0.060, 0.025, columns, rows, {20.0f, 8.0f}), 0);
    return scene;
}

inline OrbitCamera cameraFor(const Scene& scene, double aspect) {
    OrbitCamera camera;
    camera.orbit(0.45, 0.55);
    camera.frame(scene.bounds, aspect);
    camera.zoom(0.8);
    return camera;
}

/// HIP inside the tube, proxy on it, force arrow, constraint plane and a line between.
inline Overlay touchOverlay() {
    Overlay overlay;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(0.35, 0.75, 0.55));
    const glm::dvec3 middle = 0.060 * glm::normalize(glm::dvec3(0.35, 0.0, 0.55));
    const glm::dvec3 surface = middle + 0.025 * normal, hip = middle + 0.012 * normal;
    overlay.spheres.push_back({hip, 0.0035, {0.9f, 0.1f, 0.08f, 1.0f}});
    overlay.spheres.push_back({surface, 0.0035, {0.1f, 0.45f, 0.95f, 1.0f}});
    overlay.arrows.push_back({surface, surface + 0.045 * normal, 0.0012, {0.95f, 0.75f, 0.1f, 1.0f}});
    overlay.lines.push_back({hip, surface, {1.0f, 1.0f, 1.0f, 1.0f}, 2.0f});
    overlay.discs.push_back({surface, normal, 0.016, {0.2f, 0.8f, 0.9f, 0.35f}});
    return overlay;
}

} // namespace touchstone::test
