// The eye's dents: vertices by the polynomial that the hand feels.

#include "assets/shapes.h"
#include "tests/support/touch_bench.h"
#include "workbench/model/dented_meshes.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::test::dented_meshes_test {
namespace {

/// A square of 81 x 81 vertices in y = 0, which gives way 2 cm around a contact.
Scene softSquare(const glm::dmat4& sceneFromMesh) {
    Scene scene = sceneOf(assets::plane(0.1, 0.1, 80, 80), sceneFromMesh);
    HapticMaterial& haptic = scene.materials[0].haptic;
    haptic.deformationRadius = {0.02f, HapticSource::Touchstone};
    haptic.deformationLinear = {-1.0f, HapticSource::Touchstone};
    haptic.deformationQuadratic = {-0.5f, HapticSource::Touchstone};
    return scene;
}

TEST(DentedMeshes, LieWhereThePolynomialPutsThem) {
    // A node that turns and scales: its dents are those of the workspace.
    const glm::dmat4 turned = glm::scale(
        glm::rotate(glm::dmat4(1.0), 0.4, glm::normalize(glm::dvec3(1.0, 2.0, 0.5))), glm::dvec3(2.0));
    const Scene scene = softSquare(turned);
    const auto haptic = compileHapticScene(scene, Similarity{}, {.rays = false, .progress = {}});
    const Similarity objectFromWorkspace = haptic->restMotions[0].workspaceFromObject.inverse();
    const glm::dvec3 centre(turned * glm::dvec4(0.005, 0.0, -0.01, 1.0));
    const glm::dvec3 normal = glm::normalize(glm::dmat3(turned) * glm::dvec3(0.0, 1.0, 0.0));
    constexpr double kDepth = 0.003;
    Dents dents;
    dents.depth[2] = kDepth;
    dents.centre[2] = objectFromWorkspace.point(centre);
    dents.normal[2] = objectFromWorkspace.direction(normal);
    DrawnVertices drawn;
    ASSERT_TRUE(dentedVertices(scene, *haptic, 0, std::span(&dents, 1), drawn));
    const Mesh& mesh = scene.meshes[0];
    const LocalDeformation law{.radius = 0.02, .linear = -1.0, .quadratic = -0.5};
    size_t moved = 0;
    for (size_t v = 0; v < mesh.positions.size(); ++v) {
        const auto inScene = [&](const glm::vec3& p) {
            return glm::dvec3(turned * glm::dvec4(glm::dvec3(p), 1.0));
        };
        const glm::dvec3 rest = inScene(mesh.positions[v]), place = inScene(drawn.positions[v]);
        const double r = glm::distance(rest, centre), s = r / law.radius;
        const double depth = s < 1.0 ? kDepth * law.shape(s) : 0.0;
        ASSERT_LT(glm::length(place - (rest - depth * normal)), 2e-8) << v;
        moved += depth > 0.0 ? 1 : 0;
        if (!(s < 0.999) || r < 1e-4) // at the border the slope steps
            continue;
        // A height -D over a plane has the normal n + grad D.
        const glm::dvec3 expected =
            glm::normalize(normal + (kDepth * law.slope(s) / (law.radius * r)) * (rest - centre));
        const glm::dvec3 found = glm::normalize(glm::dmat3(turned) * glm::dvec3(drawn.normals[v]));
        ASSERT_LT(glm::length(found - expected), 1e-5) << v;
    }
    EXPECT_GT(moved, 100u);
    dents.depth[2] = 0.0;
    EXPECT_FALSE(dentedVertices(scene, *haptic, 0, std::span(&dents, 1), drawn));
}

TEST(DentedMeshes, WhatFacesAwayStays) {
    const Scene scene = softSquare(glm::dmat4(1.0));
    const auto haptic = compileHapticScene(scene, Similarity{}, {.rays = false, .progress = {}});
    Dents dents;
    dents.depth[0] = 0.003;
    dents.centre[0] = haptic->restMotions[0].workspaceFromObject.inversePoint(glm::dvec3(0.0));
    dents.normal[0] = {0.0, -1.0, 0.0};
    DrawnVertices drawn;
    EXPECT_FALSE(dentedVertices(scene, *haptic, 0, std::span(&dents, 1), drawn));
}

} // namespace
} // namespace touchstone::test::dented_meshes_test
