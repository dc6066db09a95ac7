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

/// Twelve tiles, each a feature of its own; `without` leaves one of them out, so that its golden picture can
/// be shown to notice. Rows from the top, four tiles each:
///   0 dielectric, rough        1 dielectric, smooth   2 metal, half rough      3 metal, smooth
///   4 vertex colours           5 emission             6 alpha mask, two-sided  7 blended over the background
///   8 occlusion and roughness  9 UV transform        10 mirrored, with normals 11 broken image: grey
inline std::shared_ptr<Scene> featureBoard(int without = -1) {
    auto scene = std::make_shared<Scene>();
    scene->images.push_back(
        checkerImage("checker", 8, glm::vec4(0.95f, 0.85f, 0.5f, 1.0f), {0.15f, 0.3f, 0.5f, 0.0f}));
    scene->images.push_back(bumpNormalImage("bumps", 0.08));
    scene->images.push_back(checkerImage("orm", 6, {0.2f, 0.9f, 0.0f, 1.0f}, {1.0f, 0.25f, 1.0f, 1.0f}));
    Image broken;
    broken.name = "broken.png";
    broken.problem = "not an image";
    scene->images.push_back(broken);
    for (int tile = 0; tile < 12; ++tile) {
        const bool on = tile != without;
        Material material;
        material.baseColor = {0.75f, 0.22f, 0.2f, 1.0f};
        material.metallic = 0.0f;
        material.roughness = 0.6f;
        Mesh mesh = tile == 6 ? quadMesh(0.024)
                              : sphereMesh(0.024, 40, 24,
                                           tile == 10 ? glm::vec2(12.0f, 6.0f) : glm::vec2(2.0f, 1.0f));
        glm::dmat4 pose = glm::translate(glm::dmat4(1.0),
                                         glm::dvec3(0.055 * (tile % 4 - 1.5), 0.055 * (1 - tile / 4), 0.0));
        switch (tile) {
        case 0:
            material.roughness = on ? 0.95f : 0.3f;
            break;
        case 1:
            material.roughness = on ? 0.12f : 0.6f;
            break;
        case 2:
            material.baseColor = {0.9f, 0.65f, 0.3f, 1.0f};
            material.metallic = on ? 1.0f : 0.0f;
            material.roughness = 0.45f;
            break;
        case 3:
            material.baseColor = {0.85f, 0.86f, 0.88f, 1.0f};
            material.metallic = on ? 1.0f : 0.0f;
            material.roughness = 0.15f;
            break;
        case 4:
            material.baseColor = glm::vec4(1.0f);
            if (on)
                for (const glm::vec3& p : mesh.positions)
                    mesh.colors.emplace_back(0.5f + 0.5f * glm::normalize(p), 1.0f);
            break;
        case 5:
            material.baseColor = {0.02f, 0.02f, 0.02f, 1.0f};
            material.emissive = on ? glm::vec3(0.9f, 0.6f, 0.1f) : glm::vec3(0.0f);
            material.emissiveTexture = texture(0);
            break;
        case 6:
            material.baseColor = glm::vec4(1.0f);
            material.baseColorTexture = texture(0);
            material.alphaMode = on ? AlphaMode::Mask : AlphaMode::Opaque;
            material.doubleSided = true;
            pose = pose * glm::rotate(glm::dmat4(1.0), 2.6, glm::dvec3(0.0, 1.0, 0.0)); // seen from behind
            break;
        case 7:
            material.baseColor = {0.1f, 0.5f, 0.9f, 0.45f};
            material.alphaMode = on ? AlphaMode::Blend : AlphaMode::Opaque;
            break;
        case 8:
            if (on)
                material.metallicRoughnessTexture = material.occlusionTexture = texture(2);
            material.metallic = 1.0f;
            break;
        case 9:
            material.baseColor = glm::vec4(1.0f);
            material.baseColorTexture = texture(0);
            if (on) {
                material.baseColorTexture.rotation = 0.5f;
                material.baseColorTexture.scale = {2.0f, 0.7f};
                material.baseColorTexture.offset = {0.1f, 0.3f};
                material.baseColorTexture.wrapS = Wrap::MirroredRepeat;
            }
            break;
        case 10:
            material.normalTexture = texture(1);
            material.normalScale = on ? 1.0f : 0.0f;
            pose = glm::scale(pose, glm::dvec3(-1.0, 1.0, 1.0));
            break;
        default:
            material.baseColor = glm::vec4(1.0f);
            if (on)
                material.baseColorTexture = texture(3);
            break;
        }
        scene->materials.push_back(material);
        place(*scene, std::move(mesh), tile, pose);
    }
    return scene;
}

/// Two plates side by side with maps of friction and stiffness, a third that states nothing and one with
/// values of its vertices.
inline std::shared_ptr<Scene> hapticBoard(bool swapped = false) {
    auto scene = std::make_shared<Scene>();
    scene->images.push_back(
        image("ramp", 64, 4, 1, [](double u, double) { return glm::vec4(static_cast<float>(u)); }));
    scene->images.push_back(checkerImage("checker", 4, glm::vec4(0.1f), glm::vec4(0.9f)));
    for (int plate = 0; plate < 4; ++plate) {
        Material material;
        Mesh mesh = quadMesh(0.02, 8);
        if (plate < 2) {
            const TextureRef map = texture(swapped ? 1 - plate : plate);
            material.haptic.staticFriction.value = 0.8f;
            material.haptic.friction.value = FactorMap{map, 0.2f, 1.0f};
            material.haptic.stiffness.value = 800.0f;
            material.haptic.stiffnessMap.value = FactorMap{map, 0.5f, 1.5f};
            material.haptic.damping.value = 2.0f;
            material.haptic.dampingMap.value = FactorMap{map, 0.0f, 1.0f};
        } else if (plate == 2) {
            for (const glm::vec3& p : mesh.positions) {
                const float t = 0.5f + (swapped ? -1.0f : 1.0f) * p.y / 0.04f;
                mesh.friction.push_back(0.9f * t);
                mesh.stiffness.push_back(1500.0f * t);
                mesh.damping.push_back(3.0f * t);
            }
        }
        scene->materials.push_back(material);
        place(*scene, std::move(mesh), plate,
              glm::translate(glm::dmat4(1.0), glm::dvec3(0.045 * (plate - 1.5), 0.0, 0.0)));
    }
    return scene;
}

/// What lets see through it: glass with something solid and with glass within, a two-sided mask, vertex
/// colours with alpha, and a pane before it all. `wrong` makes a mistake: 0 the glass is single-sided, 1
/// nothing is blended, 2 the mask is single-sided, 3 the vertices have no colours, 4 the cutoff is another.
inline std::shared_ptr<Scene> glassBoard(int wrong = -1) {
    auto scene = std::make_shared<Scene>();
    scene->images.push_back(
        checkerImage("holes", 8, glm::vec4(0.95f, 0.75f, 0.3f, 0.9f), {0.2f, 0.5f, 0.7f, 0.3f}));
    const auto material = [&](const glm::vec4& color, AlphaMode mode, bool bothSides) {
        Material made;
        made.baseColor = color;
        made.metallic = 0.0f;
        made.roughness = 0.15f;
        made.alphaMode = wrong == 1 && mode == AlphaMode::Blend ? AlphaMode::Opaque : mode;
        made.doubleSided = bothSides;
        scene->materials.push_back(made);
        return static_cast<int>(scene->materials.size()) - 1;
    };
    const auto at = [](double x, double y, double z) {
        return glm::translate(glm::dmat4(1.0), glm::dvec3(x, y, z));
    };
    const int blue = material({0.3f, 0.5f, 0.95f, 0.4f}, AlphaMode::Blend, wrong != 0);
    const int green = material({0.2f, 0.9f, 0.3f, 0.4f}, AlphaMode::Blend, wrong != 0);
    const int red = material({0.8f, 0.1f, 0.08f, 1.0f}, AlphaMode::Opaque, false);
    place(*scene, sphereMesh(0.028, 40, 24), blue, at(-0.07, 0.02, 0.0));
    place(*scene, sphereMesh(0.014, 40, 24), red, at(-0.07, 0.02, 0.0));
    place(*scene, sphereMesh(0.028, 40, 24), blue, at(0.0, 0.02, 0.0));
    place(*scene, sphereMesh(0.016, 40, 24), green, at(0.004, 0.02, 0.004));
    const int mask = material(glm::vec4(1.0f), AlphaMode::Mask, wrong != 2);
    scene->materials.back().baseColorTexture = texture(0);
    scene->materials.back().alphaCutoff = wrong == 4 ? 0.2f : 0.5f;
    place(*scene, sphereMesh(0.028, 40, 24), mask, at(0.07, 0.02, 0.0));
    const int fading = material(glm::vec4(1.0f), AlphaMode::Blend, true);
    Mesh sheet = quadMesh(0.03, 8);
    for (const glm::vec3& p : sheet.positions)
        sheet.colors.emplace_back(
            wrong == 3 ? glm::vec4(1.0f)
                       : glm::vec4(0.5f + 16.0f * p.x, 0.5f - 16.0f * p.x, 0.9f, 0.5f + 16.0f * p.y));
    place(*scene, std::move(sheet), fading, at(-0.04, -0.035, 0.0));
    place(*scene, sphereMesh(0.02, 40, 24), red, at(0.04, -0.035, 0.0));
    place(*scene, quadMesh(0.03), green, at(0.05, -0.03, 0.03));
    return scene;
}

inline OrbitCamera frontCamera(const Scene& scene, double aspect) {
    OrbitCamera camera;
    camera.frame(scene.bounds, aspect);
    return camera;
}

/// HIP inside the tube, proxy on it, force arrow, constraint plane and a line between.
inline Overlay touchOverlay() {
    Overlay overlay;
    const glm::dvec3 normal = glm::normalize(glm::dvec3(-0.45, 0.8, 0.25));
    const glm::dvec3 middle = 0.060 * glm::normalize(glm::dvec3(-0.45, 0.0, 0.25));
    const glm::dvec3 surface = middle + 0.025 * normal, hip = middle + 0.012 * normal;
    overlay.spheres.push_back({hip, 0.0035, {0.9f, 0.1f, 0.08f, 1.0f}});
    overlay.spheres.push_back({surface, 0.0035, {0.1f, 0.45f, 0.95f, 1.0f}});
    overlay.arrows.push_back({surface, surface + 0.045 * normal, 0.0012, {0.95f, 0.75f, 0.1f, 1.0f}});
    overlay.lines.push_back({hip, surface, {1.0f, 1.0f, 1.0f, 1.0f}, 2.0f});
    overlay.discs.push_back({surface, normal, 0.016, {0.2f, 0.8f, 0.9f, 0.35f}});
    return overlay;
}

} // namespace touchstone::test
