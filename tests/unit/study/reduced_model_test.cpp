// A model reduced to an angle keeps the angle, and its error is that of the surfaces.

#include "engine/core/error.h"
#include "study/perception/reduced_model.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>

namespace touchstone::study::reduced_model_test {
namespace {

TEST(ReducedModel, KeepsTheAngleAndMeasuresTheDistanceOfASphere) {
    constexpr double kRadius = 0.05;
    const Scene scene = test::sceneOf(assets::sphere(kRadius, 90, 180)); // facets meet at 2 degrees
    const ReducedModel model = reducedTo(scene, Similarity{}, 10.0);
    std::printf(
        "%zu -> %zu triangles, %.3g -> %.3g degrees, %zu edges beyond, %.4g mm at most, %.4g mm mean\n",
        model.before, model.after, model.angleBefore, model.angle, model.edgesBeyond, 1e3 * model.largest,
        1e3 * model.mean);
    EXPECT_LT(model.after, model.before / 4);
    EXPECT_GT(model.after, model.before / 60) << "a quarter of the angle squared leaves a twentieth";
    EXPECT_LE(model.angle, 10.0);
    EXPECT_LE(model.edgesBeyond, model.after * 3 / 2 / 10 + 1);
    // Every vertex is one of the sphere; the facets lie inside by their sagitta, which is measured here from
    // the middles of the triangles and edges, without the query.
    double deepest = 0.0;
    for (const Mesh& mesh : model.scene->meshes)
        for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const glm::dvec3 a(mesh.positions[mesh.indices[i]]), b(mesh.positions[mesh.indices[i + 1]]),
                c(mesh.positions[mesh.indices[i + 2]]);
            for (const glm::dvec3& place : {(a + b + c) / 3.0, (a + b) / 2.0, (b + c) / 2.0, (c + a) / 2.0})
                deepest = std::max(deepest, kRadius - glm::length(place));
        }
    const double ofTheOriginal = kRadius * (1.0 - std::cos(2.0 * std::numbers::pi / 180.0));
    EXPECT_GE(model.largest, 0.7 * (deepest - ofTheOriginal));
    EXPECT_LE(model.largest, 1.5 * deepest + ofTheOriginal);
    EXPECT_GT(model.mean, 0.0);
    EXPECT_LT(model.mean, model.largest);
    EXPECT_GT(model.places, 40'000u);
}

TEST(ReducedModel, TheScaleOfTheWorkspaceIsNoneOfItsError) {
    const Scene scene = test::sceneOf(assets::sphere(0.05, 40, 80));
    Similarity larger;
    larger.scale = 3.0;
    const ReducedModel one = reducedTo(scene, Similarity{}, 12.0), three = reducedTo(scene, larger, 12.0);
    EXPECT_EQ(one.after, three.after);
    EXPECT_NEAR(three.largest, one.largest, 1e-3 * one.largest);
}

TEST(ReducedModel, FacetsOfTheirOwnAreWeldedFirst) {
    // As an STL: each triangle has vertices of its own, and no normals are stated.
    Scene scene = test::sceneOf(assets::sphere(0.05, 60, 120));
    Mesh& mesh = scene.meshes[0];
    Mesh apart;
    apart.material = mesh.material;
    for (const uint32_t index : mesh.indices) {
        apart.indices.push_back(static_cast<uint32_t>(apart.positions.size()));
        apart.positions.push_back(mesh.positions[index]);
    }
    for (size_t i = 0; i + 2 < apart.positions.size(); i += 3) {
        const glm::vec3 normal = glm::cross(apart.positions[i + 1] - apart.positions[i],
                                            apart.positions[i + 2] - apart.positions[i]);
        apart.normals.insert(apart.normals.end(), 3, normal / std::max(glm::length(normal), 1e-12f));
    }
    mesh = apart;
    const ReducedModel model = reducedTo(scene, Similarity{}, 14.8);
    EXPECT_LT(model.after, model.before / 3);
    EXPECT_LE(model.angle, 14.8);
}

TEST(ReducedModel, WhatIsCoarserThanAskedForIsRefusedWithTheNumberNeeded) {
    const Scene scene = test::sceneOf(assets::sphere(0.05, 20, 40));
    try {
        (void)reducedTo(scene, Similarity{}, 1.0);
        FAIL() << "facets of nine degrees";
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("triangles are needed"), std::string::npos) << error.what();
    }
    Scene lines;
    lines.materials.emplace_back();
    EXPECT_THROW((void)reducedTo(lines, Similarity{}, 5.0), Error);
}

TEST(ReducedModel, APlaneHasNothingToLose) {
    // Two triangles: no level has fewer.
    const ReducedModel model = reducedTo(test::sceneOf(assets::plane(0.1, 0.1)), Similarity{}, 3.4);
    EXPECT_EQ(model.after, model.before);
    EXPECT_EQ(model.largest, 0.0);
}

} // namespace
} // namespace touchstone::study::reduced_model_test
