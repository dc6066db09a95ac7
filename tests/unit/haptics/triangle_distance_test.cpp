#include "haptics/shape/mesh/triangle.h"

#include <gtest/gtest.h>

#include <random>

namespace touchstone::triangle_distance_test {
namespace {

/// Distance by a fine search over the triangle, refined around the best point.
double searchedDistance(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& p) {
    double u0 = 0.0, v0 = 0.0, step = 0.05, best = INFINITY, bu = 0.0, bv = 0.0;
    for (int round = 0; round < 9; ++round) {
        for (int i = -20; i <= 20; ++i)
            for (int k = -20; k <= 20; ++k) {
                const double u = std::clamp(u0 + i * step, 0.0, 1.0);
                const double v = std::clamp(v0 + k * step, 0.0, 1.0 - u);
                const double d = glm::length(a + u * (b - a) + v * (c - a) - p);
                if (d < best)
                    best = d, bu = u, bv = v;
            }
        u0 = bu, v0 = bv, step *= 0.12;
    }
    return best;
}

TEST(TriangleDistance, AgreesWithASearchAndPointsAwayFromTheSurface) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> in(-1.0, 1.0);
    const auto point = [&] { return glm::dvec3(in(random), in(random), in(random)); };
    int faces = 0;
    for (int trial = 0; trial < 300; ++trial) {
        const glm::dvec3 a = point(), b = point(), c = point(), p = 1.5 * point();
        const TriangleDistance found = distanceTo(Triangle(a, b, c), p);
        EXPECT_NEAR(found.distance, searchedDistance(a, b, c, p), 1e-6);
        EXPECT_NEAR(glm::length(found.closest + found.distance * found.gradient - p), 0.0, 1e-12);
        faces += found.face ? 1 : 0;
    }
    EXPECT_GT(faces, 20);
}

TEST(TriangleDistance, DegenerateTrianglesAreSegmentsAndPoints) {
    const glm::dvec3 a(0, 0, 0), b(1, 0, 0);
    EXPECT_NEAR(distanceTo(Triangle(a, b, glm::dvec3(0.5, 0, 0)), {0.3, 0.4, 0.0}).distance, 0.4, 1e-15);
    EXPECT_NEAR(distanceTo(Triangle(a, b, b), {2.0, 0.0, 0.0}).distance, 1.0, 1e-15);
    EXPECT_NEAR(distanceTo(Triangle(a, a, a), {0.0, 3.0, 4.0}).distance, 5.0, 1e-15);
}

} // namespace
} // namespace touchstone::triangle_distance_test
