// Continuous collision of a point and a moving triangle against dense samples in long double.
#include "haptics/contact/moving_triangle.h"
#include "tests/unit/deforming/deforming_bench.h"

#include <random>

namespace touchstone::test::moving_triangle_test {
namespace {

long double leastDistance(const MovingTriangle& triangle, const glm::dvec3& from, const glm::dvec3& to) {
    long double least = INFINITY;
    constexpr int kSamples = 2000;
    for (int i = 0; i <= kSamples; ++i) {
        const long double t = static_cast<long double>(i) / kSamples;
        const auto at = [&](const glm::dvec3& a, const glm::dvec3& b) {
            return LVec3(a) + t * (LVec3(b) - LVec3(a));
        };
        const std::array<LVec3, 3> now{at(triangle.start.a, triangle.end.a),
                                       at(triangle.start.b, triangle.end.b),
                                       at(triangle.start.c, triangle.end.c)};
        least = std::min(least, distanceFrom(now, at(from, to)));
    }
    return least;
}

TEST(MovingTriangle, WhatStaysClearNeverComesNearerAndMostOfItIsSeen) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> unit(-1.0, 1.0);
    const auto place = [&](double size) {
        return size * glm::dvec3(unit(random), unit(random), unit(random));
    };
    size_t clear = 0, seen = 0, wrong = 0;
    for (int k = 0; k < 3000; ++k) {
        // From gentle motion to triangles that collapse and turn over.
        const double motion = std::pow(10.0, -3.0 + 3.5 * (k % 100) / 99.0);
        const glm::dvec3 a = place(1.0), b = place(1.0), c = place(1.0);
        const MovingTriangle triangle{{a, b, c}, {a + place(motion), b + place(motion), c + place(motion)}};
        const glm::dvec3 from = place(1.5), to = from + place(motion);
        const double keep = 1e-3;
        const long double least = leastDistance(triangle, from, to);
        const bool claims = staysClear(triangle, from, to, keep);
        wrong += claims && least < static_cast<long double>(keep) - 1e-12L ? 1 : 0;
        clear += least > 1.2L * static_cast<long double>(keep) ? 1 : 0;
        seen += claims && least > 1.2L * static_cast<long double>(keep) ? 1 : 0;
    }
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(static_cast<double>(seen), 0.98 * static_cast<double>(clear)) << seen << " of " << clear;
    std::printf("%zu of %zu clear ways were recognised\n", seen, clear);
}

TEST(MovingTriangle, APointThatItPassesOverIsHit) {
    const Triangle start({-1, -1, 0}, {1, -1, 0}, {0, 1, 0}), end({-1, -1, 1}, {1, -1, 1}, {0, 1, 1});
    EXPECT_FALSE(staysClear({start, end}, {0, 0, 0.5}, {0, 0, 0.5}, 1e-9));
    EXPECT_TRUE(staysClear({start, end}, {0, 0, 0.5}, {0, 0, 1.5}, 1e-9));
    EXPECT_TRUE(staysClear({start, end}, {3, 0, 0.5}, {3, 0, 0.5}, 1e-9));
    // Collapsed at both ends, turned inside out between.
    const Triangle flipped({1, -1, 0}, {-1, -1, 0}, {0, 1, 0});
    EXPECT_TRUE(staysClear({start, flipped}, {0, 0, 1e-6}, {0, 0, 1e-6}, 1e-7));
}

TEST(MovingTriangle, CarriesAPointAtItsSide) {
    const Triangle start({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    // A quarter turn about x and a step.
    const Triangle end({0, 0, 2}, {1, 0, 2}, {0, 0, 3});
    const glm::dvec3 carried = carriedAlong({start, end}, {0.2, 0.3, 0.1});
    EXPECT_NEAR(carried.x, 0.2, 1e-15);
    EXPECT_NEAR(carried.y, -0.1, 1e-15);
    EXPECT_NEAR(carried.z, 2.3, 1e-15);
}

} // namespace
} // namespace touchstone::test::moving_triangle_test
