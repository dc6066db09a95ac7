// The contact location on the pad [004]: continuous over polylines of 3 to 1000 points, of first order in the
// update rate; where the published step swings and the solved one does not.

#include "haptics/finger/tactile_shading.h"
#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace touchstone::test {
namespace {

constexpr double kRadius = 0.1, kArc = 0.902; // m, rad: the paper's cylinder

/// `count` points on the arc around the origin (bump), or on the same arc seen from inside (hollow, its
/// lowest place at the origin of the arc's circle shifted up).
std::vector<glm::dvec2> arcOf(int count, bool hollow) {
    std::vector<glm::dvec2> points;
    for (int i = 0; i < count; ++i) {
        const double angle = kArc * (static_cast<double>(i) / (count - 1) - 0.5);
        const glm::dvec2 out(std::sin(angle), hollow ? -std::cos(angle) : std::cos(angle));
        points.push_back(kRadius * out);
    }
    return points;
}

/// The finger at `angle` along the arc, 1 mm deep in the smooth one.
FingerPose poseAt(double angle, double pitch, bool hollow, const ArcFinger& finger) {
    const double distance = hollow ? kRadius - finger.radius + 1e-3 : kRadius + finger.radius - 1e-3;
    const glm::dvec2 centre =
        distance * glm::dvec2(std::sin(angle), hollow ? -std::cos(angle) : std::cos(angle));
    return {centre + finger.radius * glm::dvec2(std::sin(pitch), -std::cos(pitch)), pitch};
}

/// On the smooth arc: the angle between its normal and the pad's.
double smoothLocation(double angle, double pitch, bool hollow, const ArcFinger& finger) {
    const double half = 0.5 * finger.length;
    return std::clamp(finger.radius * ((hollow ? angle : -angle) - pitch), -half, half);
}

struct Slide {
    double worstJump = 0.0;  // m between two steps
    double worstError = 0.0; // m against the smooth arc
    double lowest = 1.0, highest = -1.0;
};

/// Along the middle nine tenths of the arc in `steps` steps.
Slide slide(const Polyline& line, bool hollow, double pitch, int steps, TangentStep step) {
    const ArcFinger finger;
    TactileShading shading(line, finger, step);
    Slide seen;
    double last = 0.0;
    for (int i = 0; i < steps; ++i) {
        const double angle = 0.9 * kArc * (static_cast<double>(i) / (steps - 1) - 0.5);
        const FingerPose pose = poseAt(angle, pitch, hollow, finger);
        if (i == 0)
            for (int k = 0; k < 100; ++k)
                last = shading.step(pose).contact.location;
        const TactileShading::Felt felt = shading.step(pose);
        seen.worstJump = std::max(seen.worstJump, std::abs(felt.contact.location - last));
        seen.worstError = std::max(
            seen.worstError, std::abs(felt.contact.location - smoothLocation(angle, pitch, hollow, finger)));
        seen.lowest = std::min(seen.lowest, felt.contact.location);
        seen.highest = std::max(seen.highest, felt.contact.location);
        last = felt.contact.location;
    }
    return seen;
}

/// The steepest tangent of a patch turns 1.5 times as fast as the arc, and the published step swings by R /
/// rho = 0.2 to 0.3 about the place: twice the arc's own motion bounds a step at any count, and no more than
/// that comes with more steps.
TEST(TactileShading, TheContactLocationHasNoJumpAtAnyCountOnEitherSideAndAtBothEndsOfThePad) {
    const ArcFinger finger;
    constexpr int kSteps = 8000;
    const double smooth = finger.radius * 0.9 * kArc / (kSteps - 1);
    for (const bool hollow : {false, true})
        for (const double pitch : {-0.3, 0.0, 0.3})
            for (const int count : {3, 4, 5, 7, 10, 16, 33, 104, 257, 1000}) {
                const Polyline line(arcOf(count, hollow), false);
                for (const TangentStep step : {TangentStep::AsPublished, TangentStep::Solved}) {
                    const Slide seen = slide(line, hollow, pitch, kSteps, step);
                    EXPECT_LT(seen.worstJump, 2.5 * smooth)
                        << count << " points, hollow " << hollow << ", pitch " << pitch << ", step "
                        << static_cast<int>(step);
                    if (pitch != 0.0) {
                        EXPECT_TRUE(pitch * (hollow ? -1.0 : -1.0) < 0.0
                                        ? seen.lowest == -0.5 * finger.length
                                        : seen.highest == 0.5 * finger.length)
                            << "the sweep reaches an end of the pad";
                    }
                }
            }
}

TEST(TactileShading, ComesToTheSmoothArcWithTheSquareOfTheEdge) {
    std::printf("| points | error of the contact location, mm |\n");
    std::vector<double> errors;
    for (const int count : {12, 23, 45, 89}) { // the first and last half of an edge have no patch
        const Polyline line(arcOf(count, false), false);
        errors.push_back(slide(line, false, 0.0, 2000, TangentStep::Solved).worstError);
        std::printf("| %d | %.6f |\n", count, 1e3 * errors.back());
    }
    for (size_t i = 0; i + 1 < errors.size(); ++i)
        EXPECT_GT(std::log2(errors[i] / errors[i + 1]), 1.9) << i;
}

/// "The accuracy depends on the update rate": against the same slide with each pose repeated until nothing
/// moves.
TEST(TactileShading, ThePublishedStepIsOfFirstOrderInTheUpdateRate) {
    const ArcFinger finger;
    const Polyline line(arcOf(8, false), false);
    std::vector<double> errors;
    for (const int steps : {1000, 2000, 4000, 8000}) {
        TactileShading moving(line, finger), settled(line, finger);
        double sum = 0.0;
        for (int i = 0; i < steps; ++i) {
            const FingerPose pose =
                poseAt(0.9 * kArc * (static_cast<double>(i) / (steps - 1) - 0.5), 0.0, false, finger);
            TactileShading::Felt exact;
            for (int k = 0; k < 60; ++k)
                exact = settled.step(pose);
            const TactileShading::Felt felt = moving.step(pose);
            if (i > steps / 10)
                sum += std::abs(felt.contact.location - exact.contact.location);
        }
        errors.push_back(sum / steps);
    }
    for (size_t i = 0; i + 1 < errors.size(); ++i) {
        const double order = std::log2(errors[i] / errors[i + 1]);
        std::printf("published step: error %.3e m, order %.3f\n", errors[i], order);
        EXPECT_NEAR(order, 1.0, 0.1);
    }
}

/// A square of 20 mm: its curve has a radius of 7 mm at the corners, the finger one of 20 mm. The published
/// step multiplies the error by -20/7, so it never settles.
TEST(TactileShading, OverACurveSharperThanTheFingerThePublishedStepSwingsAndTheSolvedOneSettles) {
    const Polyline square(std::vector<glm::dvec2>{{-0.01, -0.01}, {-0.01, 0.01}, {0.01, 0.01}, {0.01, -0.01}},
                          true);
    const FingerPose pose{{0.0102, 0.0101}, -0.7};
    const auto spread = [&](TangentStep step) {
        TactileShading shading(square, {}, step);
        double low = 1e9, high = -1e9;
        for (int i = 0; i < 400; ++i) {
            const double place = shading.step(pose).place;
            if (i >= 300) {
                low = std::min(low, place);
                high = std::max(high, place);
            }
        }
        return high - low;
    };
    EXPECT_GT(spread(TangentStep::AsPublished), 0.05);
    EXPECT_LT(spread(TangentStep::Solved), 1e-9);
}

TEST(TactileShading, AFingerThatBridgesAValleyGoesToTheDeeperSide) {
    // Two slopes with a narrow floor between them, into which the finger does not fit.
    const Polyline valley(
        std::vector<glm::dvec2>{
            {-0.05, 0.04}, {-0.012, 0.004}, {-0.004, 0.0}, {0.004, 0.0}, {0.012, 0.004}, {0.05, 0.04}},
        false);
    TactileShading shading(valley);
    (void)shading.step({{-0.02, 0.006}, 0.0});
    EXPECT_GT(shading.step({{-0.02, 0.006}, 0.0}).line.normal.x, 0.3) << "on the left slope";
    TactileShading::Felt felt;
    for (int i = 0; i < 50; ++i)
        felt = shading.step({{0.016, 0.004}, 0.0});
    EXPECT_LT(felt.line.normal.x, -0.3) << "on the right one";
}

/// Two flanks that a resting finger touches at once do not take it from each other.
TEST(TactileShading, AHandThatRestsOverAValleyIsFeltAtOnePlace) {
    unsigned seed = 1;
    const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) / 4294967296.0; };
    int swung = 0;
    for (int i = 0; i < 3000; ++i) {
        const double w = 0.004 + 0.012 * random(), d = 0.002 + 0.006 * random();
        const Polyline valley(
            std::vector<glm::dvec2>{
                {-0.06, 0.04}, {-w, d}, {-0.4 * w, 0.0}, {0.4 * w, 0.0}, {w, d}, {0.06, 0.04}},
            false);
        TactileShading shading(valley, {}, TangentStep::Solved);
        const FingerPose pose{{0.004 * (random() - 0.5), 0.001 + 0.003 * random()}, 0.2 * (random() - 0.5)};
        double low = 1e9, high = -1e9;
        for (int k = 0; k < 120; ++k) {
            const double location = shading.step(pose).contact.location;
            if (k >= 100) {
                low = std::min(low, location);
                high = std::max(high, location);
            }
        }
        swung += high - low > 1e-4;
    }
    std::printf("valleys over which a resting contact moves more than 0.1 mm: %d of 3000\n", swung);
    EXPECT_EQ(swung, 0);
}

TEST(TactileShading, AnyPolylineAndAnyHandGiveFiniteAnswersWithinThePad) {
    const ArcFinger finger;
    unsigned seed = 1;
    const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) / 4294967296.0; };
    uint64_t allocations = 0;
    for (int shape = 0; shape < 200; ++shape) {
        std::vector<glm::dvec2> points;
        const int count = 3 + static_cast<int>(random() * 40.0);
        for (int i = 0; i < count; ++i)
            points.emplace_back(0.1 * random(), 0.1 * random());
        const Polyline line(points, random() < 0.5);
        TactileShading shading(line, finger, random() < 0.5 ? TangentStep::AsPublished : TangentStep::Solved);
        const uint64_t before = allocationsOnThisThread();
        for (int i = 0; i < 500; ++i) {
            const TactileShading::Felt felt =
                shading.step({{0.14 * random() - 0.02, 0.14 * random() - 0.02}, 6.3 * random()});
            ASSERT_TRUE(std::isfinite(felt.place) && std::isfinite(felt.contact.depth)) << shape;
            ASSERT_LE(std::abs(felt.contact.location), 0.5 * finger.length);
            ASSERT_NEAR(glm::length(felt.line.normal), 1.0, 1e-12);
        }
        allocations += allocationsOnThisThread() - before;
    }
    EXPECT_EQ(allocations, 0u);
    const Polyline line(arcOf(10, false), false);
    TactileShading shading(line);
    const double at = shading.step(poseAt(0.1, 0.0, false, finger)).place;
    EXPECT_EQ(shading.step({{std::numeric_limits<double>::quiet_NaN(), 0.0}, 0.0}).place, at);
}

} // namespace
} // namespace touchstone::test
