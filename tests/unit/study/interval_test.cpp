#include "study/timing/interval.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace touchstone::study::interval_test {
namespace {

TEST(Interval, OfNothingAndOfOneValue) {
    EXPECT_EQ(medianOf({}).value, 0.0);
    const std::vector<double> same(20, 7.0);
    for (const Estimate& e : {medianOf(same), meanOf(same)}) {
        EXPECT_EQ(e.value, 7.0);
        EXPECT_EQ(e.low, 7.0);
        EXPECT_EQ(e.high, 7.0);
    }
}

TEST(Interval, IsTheSameEveryTime) {
    const std::vector<double> rounds{3.0, 1.0, 4.0, 1.5, 9.0, 2.6, 5.0};
    EXPECT_EQ(medianOf(rounds), medianOf(rounds));
    EXPECT_EQ(medianOf(rounds).value, 3.0);
    EXPECT_NEAR(meanOf(rounds).value, 26.1 / 7.0, 1e-15);
}

/// Holds the truth in about 95 of 100 studies; a percentile bootstrap of 30 rounds is a little too sure.
TEST(Interval, HoldsTheTruthAsOftenAsItSays) {
    std::mt19937 random(11);
    std::lognormal_distribution<double> draw(0.0, 0.3); // as times are: none below, few far above
    const double median = 1.0, mean = std::exp(0.5 * 0.09);
    int medians = 0, means = 0;
    constexpr int kStudies = 300;
    for (int study = 0; study < kStudies; ++study) {
        std::vector<double> rounds;
        for (int i = 0; i < 30; ++i)
            rounds.push_back(draw(random));
        const Estimate m = medianOf(rounds), a = meanOf(rounds);
        medians += m.low <= median && median <= m.high ? 1 : 0;
        means += a.low <= mean && mean <= a.high ? 1 : 0;
        EXPECT_LE(m.low, m.value);
        EXPECT_GE(m.high, m.value);
    }
    EXPECT_GT(medians, kStudies * 90 / 100);
    EXPECT_GT(means, kStudies * 89 / 100);
    EXPECT_LT(medians, kStudies);
    EXPECT_LT(means, kStudies);
}

TEST(Interval, AreApartWithoutACommonValue) {
    EXPECT_TRUE(apart({1.0, 0.9, 1.1}, {2.0, 1.2, 2.2}));
    EXPECT_TRUE(apart({2.0, 1.2, 2.2}, {1.0, 0.9, 1.1}));
    EXPECT_FALSE(apart({1.0, 0.9, 1.3}, {2.0, 1.2, 2.2}));
    EXPECT_FALSE(apart({1.0, 0.9, 1.2}, {2.0, 1.2, 2.2}));
}

} // namespace
} // namespace touchstone::study::interval_test
