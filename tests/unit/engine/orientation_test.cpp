#include "engine/math/orientation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::orientation_test {
namespace {

__extension__ using Wide = __int128;

/// The sign from integers: the coordinates are whole multiples of 2^-40 below 2^22 of them.
int exactSign(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b) {
    const auto whole = [](double x) { return static_cast<Wide>(std::ldexp(x, 40)); };
    const Wide area = (whole(a.x) - whole(p.x)) * (whole(b.y) - whole(p.y)) -
                      (whole(a.y) - whole(p.y)) * (whole(b.x) - whole(p.x));
    return area > 0 ? 1 : area < 0 ? -1 : 0;
}

int sign(double value) {
    return value > 0.0 ? 1 : value < 0.0 ? -1 : 0;
}

TEST(Orientation, HasTheExactSignNextToALine) {
    std::mt19937_64 random(3);
    const auto coordinate = [&] {
        return std::ldexp(static_cast<double>(random() % (uint64_t{1} << 41)), -40);
    };
    int zeros = 0;
    for (int trial = 0; trial < 200000; ++trial) {
        const glm::dvec2 a(coordinate(), coordinate()), b(coordinate(), coordinate());
        // On the line but for the rounding to the grid, or exactly in its middle.
        const double t = static_cast<double>(random() % 1024) / 1024.0;
        glm::dvec2 p = trial % 3 == 0 ? a : a + t * (b - a);
        p = {std::ldexp(std::round(std::ldexp(p.x, 40)), -40),
             std::ldexp(std::round(std::ldexp(p.y, 40)), -40)};
        const int expected = exactSign(p, a, b);
        ASSERT_EQ(sign(orientation(p, a, b)), expected) << trial;
        ASSERT_EQ(sign(orientation(p, b, a)), -expected) << trial;
        ASSERT_EQ(sign(orientation(a, b, p)), expected) << trial;
        zeros += expected == 0;
    }
    EXPECT_GT(zeros, 60000);
}

TEST(Orientation, IsTheArea) {
    EXPECT_DOUBLE_EQ(orientation({0, 0}, {2, 0}, {0, 3}), 6.0);
    EXPECT_DOUBLE_EQ(orientation({0, 0}, {0, 3}, {2, 0}), -6.0);
}

} // namespace
} // namespace touchstone::orientation_test
