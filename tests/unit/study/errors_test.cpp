// Errors of signals whose errors are known.

#include "study/errors/compare.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone::study::errors_test {
namespace {

using truth::FeltTick;

struct Signal {
    std::vector<glm::dvec3> hips;
    std::vector<FeltTick> truth;
};

/// A hand that goes along x at 0.1 mm a tick, pushed up by 1 N.
Signal levelSignal(size_t ticks) {
    Signal signal;
    for (size_t i = 0; i < ticks; ++i) {
        signal.hips.emplace_back(1e-4 * static_cast<double>(i), -1e-3, 0.0);
        signal.truth.push_back(
            {glm::dvec3(1e-4 * static_cast<double>(i), 0.0, 0.0), glm::dvec3(0.0, 1.0, 0.0), true, false});
    }
    return signal;
}

TEST(Errors, OfTheTruthItselfAreNone) {
    const Signal s = levelSignal(100);
    const Errors e = compareWithTruth(s.hips, s.truth, s.truth);
    EXPECT_EQ(e.position.max, 0.0);
    EXPECT_EQ(e.force.max, 0.0);
    EXPECT_EQ(e.forceDirection.max, 0.0);
    EXPECT_EQ(e.energyCreated, 0.0);
    EXPECT_EQ(e.contactLost, 0.0);
    EXPECT_EQ(e.contactInvented, 0.0);
    EXPECT_EQ(e.compared, 100u);
    EXPECT_EQ(e.ticks, 100u);
}

TEST(Errors, OfADisplacedSignalAreItsDisplacement) {
    const Signal s = levelSignal(100);
    std::vector<FeltTick> ours = s.truth;
    for (FeltTick& tick : ours) {
        tick.proxy += glm::dvec3(3e-6, 4e-6, 0.0);
        tick.force = glm::dvec3(std::sin(0.1), std::cos(0.1), 0.0) * 1.25; // leans 0.1 rad forward, 1.25 N
    }
    const Errors e = compareWithTruth(s.hips, s.truth, ours);
    for (const double value : {e.position.median, e.position.p99, e.position.max})
        EXPECT_NEAR(value, 5e-6, 1e-18);
    EXPECT_NEAR(e.forceMagnitude.median, 0.25, 1e-12);
    EXPECT_NEAR(e.forceDirection.median, 0.1, 1e-12);
    EXPECT_NEAR(e.force.median, std::hypot(1.25 * std::sin(0.1), 1.25 * std::cos(0.1) - 1.0), 1e-12);
    // A force along the way gives its length times the way, 99 ticks of 0.1 mm.
    EXPECT_NEAR(e.energyCreated, 1.25 * std::sin(0.1) * 99e-4, 1e-12);
    EXPECT_NEAR(e.largestJump, 0.0, 1e-15);
}

TEST(Errors, TellWhatIsRareFromWhatIsUsual) {
    const Signal s = levelSignal(1000);
    std::vector<FeltTick> ours = s.truth;
    for (size_t i = 0; i < 20; ++i)
        ours[10 + i].force.y += 0.2;
    ours[500].force.y += 0.7;
    const Errors e = compareWithTruth(s.hips, s.truth, ours);
    EXPECT_EQ(e.force.median, 0.0);
    EXPECT_NEAR(e.force.p99, 0.2, 1e-12);
    EXPECT_NEAR(e.force.max, 0.7, 1e-12);
    EXPECT_NEAR(e.largestJump, 0.7, 1e-12);
    EXPECT_EQ(e.truthJump, 0.0);
}

TEST(Errors, CountContactThatIsLostOrInvented) {
    Signal s = levelSignal(100);
    for (size_t i = 0; i < 40; ++i)
        s.truth[i] = {s.hips[i], glm::dvec3(0.0), false, false};
    std::vector<FeltTick> ours = s.truth;
    for (size_t i = 38; i < 40; ++i)
        ours[i] = {s.hips[i], glm::dvec3(0.0, 0.5, 0.0), true, false};
    for (size_t i = 90; i < 96; ++i)
        ours[i] = {s.hips[i], glm::dvec3(0.0), false, false};
    const Errors e = compareWithTruth(s.hips, s.truth, ours);
    EXPECT_NEAR(e.contactInvented, 2.0 / 40.0, 1e-15);
    EXPECT_NEAR(e.contactLost, 6.0 / 60.0, 1e-15);
    EXPECT_EQ(e.compared, 54u);
    EXPECT_NEAR(e.force.max, 1.0, 1e-15) << "lost contact is an error of the whole force";
    EXPECT_NEAR(e.truthJump, 1.0, 1e-15);
    EXPECT_EQ(e.forceMagnitude.max, 0.0) << "told of ticks in contact in both alone";
}

TEST(Errors, CompareNothingWhereThereIsNoTruth) {
    Signal s = levelSignal(100);
    std::vector<FeltTick> ours = s.truth;
    for (size_t i = 50; i < 60; ++i) {
        s.truth[i].failed = true;
        ours[i].force = glm::dvec3(9.0);
        ours[i].proxy = glm::dvec3(1.0);
    }
    const Errors e = compareWithTruth(s.hips, s.truth, ours);
    EXPECT_EQ(e.truthFailed, 10u);
    EXPECT_EQ(e.compared, 90u);
    EXPECT_EQ(e.force.max, 0.0);
    EXPECT_EQ(e.largestJump, 0.0);
    EXPECT_EQ(e.energyCreated, 0.0);
}

} // namespace
} // namespace touchstone::study::errors_test
