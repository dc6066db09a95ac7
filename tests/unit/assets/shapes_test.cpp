#include "assets/shapes.h"
#include "tests/unit/assets/topology.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace touchstone::assets {
namespace {

using test::topologyOf;
constexpr double kPi = std::numbers::pi;

TEST(Shapes, AreClosedAndFaceOutwards) {
    const auto check = [](const char* name, const Shape& shape, double volume, double tolerance, int euler) {
        SCOPED_TRACE(name);
        const test::Topology topology = topologyOf(shape.positions, shape.indices);
        EXPECT_TRUE(topology.closed()) << topology.unpairedEdges << " edges do not pair";
        EXPECT_NEAR(topology.volume / volume, 1.0, tolerance);
        EXPECT_EQ(topology.euler(), euler);
    };
    check("torus", torus(0.06, 0.025, 180, 180), 2 * kPi * kPi * 0.06 * 0.025 * 0.025, 1e-3, 0);
    check("torus with a seam", torus(0.06, 0.025, 180, 180, {12, 5}), 2 * kPi * kPi * 0.06 * 0.025 * 0.025,
          1e-3, 0);
    check("odd torus", torus(0.06, 0.025, 19, 12), 2 * kPi * kPi * 0.06 * 0.025 * 0.025, 0.08, 0);
    check("sphere", sphere(0.05, 179, 180), 4.0 / 3.0 * kPi * 0.05 * 0.05 * 0.05, 1e-3, 2);
    check("box", boxWithSharedCorners({0.1, 0.2, 0.3}), 0.006, 1e-6, 2);
    check("finer box", box({0.1, 0.2, 0.3}, 7), 0.006, 1e-6, 2);
    const double decagon = 5.0 * 0.05 * 0.05 * std::sin(kPi / 5.0);
    check("flat prism", prism(10, 0.05, 0.15, false), decagon * 0.15, 1e-6, 2);
    check("smooth prism in rows", prism(10, 0.05, 0.15, true, 9), decagon * 0.15, 1e-6, 2);
}

TEST(Shapes, ATorusLiesOnATorusToTheLastFloatBit) {
    for (const Shape& shape : {torus(0.06, 0.025, 180, 180), torus(0.06, 0.025, 97, 31, {12, 5})})
        for (size_t i = 0; i < shape.positions.size(); ++i) {
            const glm::dvec3 p(shape.positions[i]);
            const double radius = std::hypot(p.x, p.y);
            ASSERT_NEAR(std::hypot(radius - 0.06, p.z), 0.025, 8e-9); // an ulp of 0.085 is 7.5e-9
            const glm::dvec3 outwards((radius - 0.06) * p.x / radius, (radius - 0.06) * p.y / radius, p.z);
            ASSERT_LT(glm::distance(outwards / 0.025, glm::dvec3(shape.normals[i])), 1e-6);
        }
}

TEST(Shapes, ASphereLiesOnASphereAndKeepsItsPoles) {
    const Shape shape = sphere(0.05, 180, 180);
    for (size_t i = 0; i < shape.positions.size(); ++i) {
        ASSERT_NEAR(glm::length(glm::dvec3(shape.positions[i])), 0.05, 4e-9);
        ASSERT_LT(glm::distance(glm::dvec3(shape.positions[i]) / 0.05, glm::dvec3(shape.normals[i])), 1e-7);
    }
    EXPECT_EQ(shape.positions.front(), glm::vec3(0, 0.05f, 0));
    EXPECT_EQ(shape.positions.back(), glm::vec3(0, -0.05f, 0));
}

TEST(Shapes, HaveTheCountsOfTableOne) {
    const test::Topology three = topologyOf(sphere(0.05, 30, 30).positions, sphere(0.05, 30, 30).indices);
    EXPECT_EQ(three.vertices, 902u);
    EXPECT_EQ(three.edges, 2700u);
    EXPECT_EQ(three.triangles, 1800u);
    const Shape four = sphere(0.05, 180, 180);
    EXPECT_EQ(four.positions.size(), 32402u);
    EXPECT_EQ(four.triangleCount(), 64800u);
    EXPECT_EQ(boxWithSharedCorners(glm::dvec3(0.1)).positions.size(), 8u);
    EXPECT_EQ(torus(0.06, 0.025, 180, 180).positions.size(), 32400u);
}

/// Tangents must be what the UVs say: t along growing u, and cross(n, t) * w against growing v (the image's
/// top).
void expectTangentsFollowUv(const Shape& shape) {
    ASSERT_EQ(shape.tangents.size(), shape.positions.size());
    for (size_t t = 0; t < shape.indices.size(); t += 3) {
        const uint32_t i = shape.indices[t], j = shape.indices[t + 1], k = shape.indices[t + 2];
        const glm::dvec3 p(shape.positions[j] - shape.positions[i]),
            q(shape.positions[k] - shape.positions[i]);
        const glm::dvec2 a(shape.uv[j] - shape.uv[i]), b(shape.uv[k] - shape.uv[i]);
        const double det = a.x * b.y - a.y * b.x;
        ASSERT_NE(det, 0.0);
        const glm::dvec3 alongU = glm::normalize((b.y * p - a.y * q) / det);
        const glm::dvec3 alongV = glm::normalize((a.x * q - b.x * p) / det);
        const glm::dvec3 tangent(shape.tangents[i]), normal(shape.normals[i]);
        ASSERT_GT(glm::dot(tangent, alongU), 0.99);
        ASSERT_LT(glm::dot(glm::cross(normal, tangent) * double{shape.tangents[i].w}, alongV), -0.99);
    }
}

TEST(Shapes, TangentsFollowTheTexture) {
    expectTangentsFollowUv(torus(0.06, 0.025, 180, 180, {12, 5}));
    expectTangentsFollowUv(plane(0.15, 0.1, 3, 5));
}

TEST(Shapes, APrismIsFlatOrRadialOnItsSides) {
    const Shape flat = prism(10, 0.05, 0.15, false), smooth = prism(10, 0.05, 0.15, true);
    ASSERT_EQ(flat.positions.size(), smooth.positions.size());
    EXPECT_EQ(flat.triangleCount(), 40u);
    size_t lateral = 0;
    for (size_t i = 0; i < flat.positions.size(); ++i) {
        EXPECT_EQ(flat.positions[i], smooth.positions[i]);
        if (flat.normals[i].y != 0.0f) {
            EXPECT_EQ(flat.normals[i], smooth.normals[i]) << "caps are flat in both";
            continue;
        }
        ++lateral;
        const glm::dvec3 radial = glm::normalize(glm::dvec3(flat.positions[i].x, 0, flat.positions[i].z));
        EXPECT_LT(glm::distance(glm::dvec3(smooth.normals[i]), radial), 1e-6);
        EXPECT_NEAR(glm::dot(glm::dvec3(flat.normals[i]), radial), std::cos(kPi / 10.0), 1e-6);
        EXPECT_NEAR(std::hypot(flat.positions[i].x, flat.positions[i].z), 0.05, 1e-8);
    }
    EXPECT_EQ(lateral, 40u);
}

TEST(Shapes, APlaneFacesUpInEveryCell) {
    const Shape shape = plane(0.15, 0.1, 4, 3);
    EXPECT_EQ(shape.triangleCount(), 24u);
    for (size_t t = 0; t < shape.indices.size(); t += 3) {
        const glm::vec3 a = shape.positions[shape.indices[t]];
        EXPECT_GT(
            glm::cross(shape.positions[shape.indices[t + 1]] - a, shape.positions[shape.indices[t + 2]] - a)
                .y,
            0);
    }
}

TEST(Shapes, RefuseCountsThatEncloseNothing) {
    EXPECT_THROW((void)torus(0.06, 0.025, 2, 10), std::invalid_argument);
    EXPECT_THROW((void)sphere(0.05, 0, 10), std::invalid_argument);
    EXPECT_THROW((void)box(glm::dvec3(0.1), 0), std::invalid_argument);
    EXPECT_THROW((void)prism(2, 0.05, 0.1, false), std::invalid_argument);
    EXPECT_THROW((void)plane(0.1, 0.1, 0, 1), std::invalid_argument);
}

} // namespace
} // namespace touchstone::assets
