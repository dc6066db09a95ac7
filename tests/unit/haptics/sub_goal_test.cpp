// The exact sub-goal against an exhaustive search over all active sets.

#include "haptics/solve/sub_goal.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace touchstone::sub_goal_test {
namespace {

/// Dykstra's alternating projections: slow, independent, converges to the nearest feasible point.
glm::dvec3 dykstra(const glm::dvec3& goal, const std::vector<ConstraintPlane>& planes) {
    glm::dvec3 x = goal;
    std::vector<glm::dvec3> correction(planes.size(), glm::dvec3(0.0));
    for (int sweep = 0; sweep < 20000; ++sweep)
        for (size_t i = 0; i < planes.size(); ++i) {
            const glm::dvec3 y = x + correction[i];
            const double lack = planes[i].offset - glm::dot(planes[i].normal, y);
            x = lack > 0.0 ? y + lack * planes[i].normal : y;
            correction[i] = y - x;
        }
    return x;
}

TEST(SubGoal, AgreesWithAlternatingProjections) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    int byCount[4] = {};
    for (int trial = 0; trial < 300; ++trial) {
        std::vector<ConstraintPlane> planes(1 + random() % 7);
        for (ConstraintPlane& plane : planes) {
            plane.normal =
                glm::normalize(glm::dvec3(normal(random), normal(random), std::abs(normal(random)) + 0.4));
            plane.offset = -0.1 * std::abs(normal(random));
        }
        const glm::dvec3 goal(normal(random), normal(random), -std::abs(normal(random)));
        const SubGoal found = nearestFeasible(goal, planes);
        ASSERT_TRUE(found.exact);
        ++byCount[found.count];
        EXPECT_LT(glm::length(found.point - dykstra(goal, planes)), 1e-6) << "trial " << trial;
        glm::dvec3 rebuilt = goal;
        for (int i = 0; i < found.count; ++i) {
            EXPECT_GE(found.multiplier[static_cast<size_t>(i)], 0.0);
            rebuilt += found.multiplier[static_cast<size_t>(i)] *
                       planes[static_cast<size_t>(found.active[static_cast<size_t>(i)])].normal;
        }
        EXPECT_LT(glm::length(rebuilt - found.point), 1e-12);
    }
    EXPECT_GT(byCount[1], 10);
    EXPECT_GT(byCount[2], 10);
    EXPECT_GT(byCount[3], 10);
}

TEST(SubGoal, PlanesAlmostParallelAreSolvedNotGivenUp) {
    for (double angle : {1e-2, 1e-4, 1.7e-5, 1e-6, 1e-8, 0.0}) {
        const std::vector<ConstraintPlane> planes{{{0.0, 1.0, 0.0}, 0.0},
                                                  {{std::sin(angle), std::cos(angle), 0.0}, 0.0}};
        for (double x : {-1.0, 0.0, 1.0}) {
            const SubGoal found = nearestFeasible({x, -1.0, 0.5}, planes);
            EXPECT_TRUE(found.exact) << angle;
            for (const ConstraintPlane& plane : planes)
                EXPECT_GE(glm::dot(plane.normal, found.point), -1e-7) << "angle " << angle;
        }
    }
}

TEST(SubGoal, PlanesThatShareADirectionHoldItFree) {
    // A fan of planes along z: any three of them are dependent.
    std::mt19937 random(11);
    std::uniform_real_distribution<double> angle(-1.4, 1.4), offset(-0.3, 0.0), place(-1.0, 1.0);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<ConstraintPlane> planes(3 + random() % 4);
        for (ConstraintPlane& plane : planes) {
            const double turn = angle(random);
            plane.normal = {std::sin(turn), std::cos(turn), 0.0};
            plane.offset = offset(random);
        }
        const glm::dvec3 goal(place(random), -1.5, place(random));
        const SubGoal found = nearestFeasible(goal, planes);
        ASSERT_TRUE(found.exact) << trial;
        EXPECT_EQ(found.point.z, goal.z) << trial;
        EXPECT_LE(found.count, 2) << trial;
        EXPECT_LT(glm::length(found.point - dykstra(goal, planes)), 1e-6) << trial;
    }
}

/// Two jaws that overlap leave no feasible point: the result says so and stays at the origin.
TEST(SubGoal, JawsThatOverlapHaveNoSolution) {
    for (const glm::dvec3& n : {glm::dvec3(1.0, 0.0, 0.0), glm::normalize(glm::dvec3(1.0, -2.0, 0.5))})
        for (const double overlap : {1e-6, 0.1}) {
            const std::vector<ConstraintPlane> planes{{n, overlap}, {-n, overlap}};
            for (const glm::dvec3& goal : {glm::dvec3(0.0), glm::dvec3(-1.0, 0.3, 0.2), 2.0 * n}) {
                const SubGoal found = nearestFeasible(goal, planes);
                EXPECT_FALSE(found.exact) << overlap;
                EXPECT_EQ(found.point, glm::dvec3(0.0));
                EXPECT_EQ(found.count, 0);
            }
        }
}

} // namespace
} // namespace touchstone::sub_goal_test
