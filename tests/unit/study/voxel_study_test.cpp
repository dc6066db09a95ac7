// The orders in which a field's errors fall with its voxel; times are nobody's promise.

#include "study/voxel/tricubic_field.h"
#include "study/voxel/voxel_study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>
#include <map>
#include <random>

namespace touchstone::study::voxel_study_test {
namespace {

const VoxelShape& shapeNamed(const std::string& name) {
    static const std::vector<VoxelShape> shapes = voxelShapes();
    for (const VoxelShape& shape : shapes)
        if (shape.name == name)
            return shape;
    return shapes.front();
}

/// Five voxel sizes, nodes out of the closed form, without times.
const std::vector<VoxelResult>& resultsOf(const std::string& name) {
    static std::map<std::string, std::vector<VoxelResult>> known;
    auto [at, fresh] = known.try_emplace(name);
    if (fresh) {
        std::vector<std::string> notes;
        at->second = studyVoxelsOf(
            shapeNamed(name),
            {.across = {48, 64, 96, 128, 192}, .meshes = false, .errorTicks = 3000, .rounds = 0}, notes,
            [](double) {});
        for (const VoxelResult& r : at->second)
            std::printf("%s, %s, %.3f mm: place %.4g um, surface %.4g um, at most %.4g um; %.4f degrees\n",
                        r.shape.c_str(), r.method.c_str(), 1e3 * r.voxel, 1e6 * r.meanPosition,
                        1e6 * r.meanSurface, 1e6 * r.maxSurface, 57.29578 * r.direction.p99);
    }
    return at->second;
}

double orderOf(const std::string& shape, const std::string& method, double VoxelResult::*error) {
    return voxelOrder(resultsOf(shape), shape, kFromClosedForm, method, error);
}

TEST(VoxelStudy, OnSmoothShapesTheErrorFallsWithTheSquareOfTheVoxel) {
    for (const char* shape : {"sphere", "torus"}) {
        for (const char* method : {"sweep", "sweep, two-pass", "virtual point"}) {
            SCOPED_TRACE(std::string(shape) + ", " + method);
            EXPECT_GT(orderOf(shape, method, &VoxelResult::meanSurface), 1.8);
            EXPECT_LT(orderOf(shape, method, &VoxelResult::meanSurface), 2.2);
        }
        EXPECT_GT(orderOf(shape, "virtual point", &VoxelResult::meanPosition), 1.8);
        EXPECT_LT(orderOf(shape, "virtual point", &VoxelResult::meanPosition), 2.2);
    }
}

TEST(VoxelStudy, ASplineIsNearerAndGainsMoreByEachVoxel) {
    for (const char* shape : {"sphere", "torus"}) {
        SCOPED_TRACE(shape);
        EXPECT_GT(orderOf(shape, "virtual point, tricubic", &VoxelResult::meanSurface), 2.5);
        EXPECT_GT(orderOf(shape, "virtual point, tricubic", &VoxelResult::meanPosition), 1.8);
    }
}

/// In the oblique groove the sweep's proxy rests in steps of twisted cells: its place along the groove is off
/// by less than a voxel here, and gains nothing where voxels are smaller than a quarter of the hand's depth
/// (docs/accuracy.md).
TEST(VoxelStudy, AtEdgesTheErrorFallsWithTheVoxel) {
    const auto isFirstPower = [](const char* shape, const char* method, double VoxelResult::*error) {
        SCOPED_TRACE(std::string(shape) + ", " + method);
        EXPECT_GT(orderOf(shape, method, error), 0.8);
        EXPECT_LT(orderOf(shape, method, error), 1.2);
    };
    isFirstPower("groove", "sweep", &VoxelResult::maxSurface);
    isFirstPower("groove", "virtual point", &VoxelResult::meanPosition);
    isFirstPower("box", "virtual point", &VoxelResult::maxSurface);
    for (const char* shape : {"box", "groove"})
        for (const VoxelResult& r : resultsOf(shape)) {
            EXPECT_LT(r.maxSurface, 0.5 * r.voxel) << "edges are rounded by less than half a voxel";
            EXPECT_LT(r.meanPosition, 0.6 * r.voxel) << r.shape << ", " << r.method;
        }
}

TEST(VoxelStudy, ComparesFieldsOfMeshesWithThoseMeshes) {
    std::vector<std::string> notes;
    const std::vector<VoxelResult> results =
        studyVoxelsOf(shapeNamed("torus"),
                      {.across = {64, 128, 8192}, .errorTicks = 1500, .rounds = 0, .torusTriangles = {}},
                      notes, [](double) {});
    EXPECT_EQ(notes.size(), 2u) << "8192 voxels across are more than a field may have";
    const double order = voxelOrder(results, "torus", kFromMesh, "sweep", &VoxelResult::meanPosition);
    EXPECT_GT(order, 0.8);
    for (const VoxelResult& r : results) {
        EXPECT_LT(r.contactLost, 0.01) << r.method;
        if (r.source == kFromMesh) {
            EXPECT_EQ(r.triangles, 64'800u);
            EXPECT_GT(r.memory, 0.0);
        }
    }
}

/// Fields of quadratic and cubic polynomials; a grid of 16 cells.
std::shared_ptr<const FieldShape> fieldOf(const std::function<double(const glm::dvec3&)>& f) {
    const FieldLayout layout{.origin = glm::dvec3(-0.5), .voxel = 1.0 / 16.0, .cells = glm::ivec3(16)};
    return std::make_shared<FieldShape>(
        std::make_shared<FieldGrid>(layout, 10.0, 10.0, [&](const glm::ivec3& first, std::span<float> nodes) {
            size_t i = 0;
            for (int z = 0; z < FieldGrid::kNodes; ++z)
                for (int y = 0; y < FieldGrid::kNodes; ++y)
                    for (int x = 0; x < FieldGrid::kNodes; ++x)
                        nodes[i++] = static_cast<float>(
                            f(layout.origin + layout.voxel * glm::dvec3(first + glm::ivec3(x, y, z))));
        }));
}

TEST(TricubicField, IsExactOnQuadraticsAndItsGradientIsItsOwn) {
    const auto quadratic = [](const glm::dvec3& p) {
        return glm::dot(p, p) + 0.3 * p.x * p.y - 0.2 * p.z - 0.05;
    };
    const auto field = fieldOf(quadratic);
    const TricubicField cubic(field);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> at(-0.4, 0.4);
    double farthest = 0.0, steepest = 0.0;
    for (int i = 0; i < 500; ++i) {
        const glm::dvec3 p(at(random), at(random), at(random));
        EXPECT_NEAR(cubic.value(p), quadratic(p), 1e-6) << "of float nodes";
        farthest = std::max(farthest, std::abs(field->value(p) - quadratic(p)));
        const glm::dvec3 gradient = cubic.gradient(p);
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 h(0.0);
            h[axis] = 1e-6;
            EXPECT_NEAR((cubic.value(p + h) - cubic.value(p - h)) / 2e-6, gradient[axis], 1e-5);
        }
        steepest = std::max(steepest, glm::length(gradient));
    }
    EXPECT_GT(farthest, 1e-3) << "the trilinear field is not";
    EXPECT_LE(steepest, cubic.lipschitz());
}

} // namespace
} // namespace touchstone::study::voxel_study_test
