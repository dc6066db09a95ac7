#include "devices/stroke/stroke_path.h"
#include "engine/core/error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace touchstone::stroke_path_test {
namespace {

const std::vector<glm::dvec3> kSquare{{0, 0, 0}, {0.05, 0, 0}, {0.05, 0.05, 0}, {0, 0.05, 0}};

TEST(StrokePath, NeverExceedsItsSpeed) {
    const StrokePath path = StrokePath::around(kSquare, 0.1);
    for (double t = 0.0; t < path.period(); t += 0.0007)
        EXPECT_LE(glm::length(path.velocity(t)), 0.1 * (1 + 1e-12));
    EXPECT_NEAR(glm::length(path.velocity(0.25)), 0.1, 1e-3) << "and goes at it where the path is straight";
}

TEST(StrokePath, PositionAndVelocityAreContinuousAndBelongTogether) {
    const StrokePath path = StrokePath::around(kSquare, 0.1);
    constexpr double kStep = 1e-5;
    // The second derivative is a convex combination of second differences of control points, each at most
    // 2 * speed * interval, over the interval squared.
    const double largestAcceleration = 2.0 * 0.1 / StrokePath::kKnotInterval;
    for (double t = -0.1; t < path.period() + 0.1; t += kStep) {
        const glm::dvec3 chord = (path.position(t + kStep) - path.position(t)) / kStep;
        ASSERT_LE(glm::distance(chord, path.velocity(t + 0.5 * kStep)), 1e-6) << t;
        ASSERT_LE(glm::distance(path.velocity(t + kStep), path.velocity(t)),
                  largestAcceleration * kStep * (1 + 1e-6))
            << t;
    }
}

/// A model of a million kilometres at its own size: the round would take eleven thousand years.
TEST(StrokePath, RefusesARoundThatNobodyLivesToSee) {
    for (const double length : {5e3, 1e9, 1e30}) {
        const std::vector<glm::dvec3> there{{0, 0, 0}, {length, 0, 0}};
        try {
            (void)StrokePath::around(there, 0.1);
            ADD_FAILURE() << length;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find("12 hours"), std::string::npos) << error.what();
        }
    }
    EXPECT_NEAR(StrokePath::around(std::vector<glm::dvec3>{{0, 0, 0}, {500, 0, 0}}, 0.1).period(), 1e4, 1.0);
}

TEST(StrokePath, CutsCornersByLessThanAControlInterval) {
    const StrokePath path = StrokePath::around(kSquare, 0.1);
    for (const glm::dvec3& corner : kSquare) {
        double nearest = 1.0;
        for (double t = 0.0; t < path.period(); t += 0.001)
            nearest = std::min(nearest, glm::distance(path.position(t), corner));
        EXPECT_LT(nearest, 0.1 * StrokePath::kKnotInterval);
    }
}

TEST(StrokePath, RepeatsForEver) {
    const StrokePath path = StrokePath::around(kSquare, 0.1);
    EXPECT_NEAR(path.period(), 2.0, 0.02);
    for (const double t : {0.0, 0.3, 1.1})
        EXPECT_LT(glm::distance(path.position(t), path.position(t + 1000.0 * path.period())), 1e-9);
}

TEST(StrokePath, StaysWhereItIsWithOneWaypoint) {
    const std::vector<glm::dvec3> one{{0.01, 0.02, 0.03}};
    const StrokePath path = StrokePath::around(one, 0.1);
    EXPECT_LT(glm::distance(path.position(0.123), one[0]), 1e-15);
    EXPECT_LT(glm::length(path.velocity(0.123)), 1e-15);
}

TEST(StrokePath, SurvivesTimesThatAreNone) {
    const StrokePath path = StrokePath::around(kSquare, 0.1);
    for (const double t :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300})
        EXPECT_LT(glm::length(path.position(t)), 0.1);
}

TEST(StrokePath, RefusesWhatIsNoPath) {
    const std::vector<glm::dvec3> none, broken{{0, 0, std::numeric_limits<double>::quiet_NaN()}};
    EXPECT_THROW((void)StrokePath::around(none, 0.1), Error);
    EXPECT_THROW((void)StrokePath::around(broken, 0.1), Error);
    EXPECT_THROW((void)StrokePath::around(kSquare, 0.0), Error);
    EXPECT_THROW((void)StrokePath::around(kSquare, std::numeric_limits<double>::quiet_NaN()), Error);
}

} // namespace
} // namespace touchstone::stroke_path_test
