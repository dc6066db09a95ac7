// Times that were made up, so that what must come out is known.

#include "study/timing/step_figures.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace touchstone::study::step_figures_test {
namespace {

constexpr std::array<double, kStageCount> kTrue{10.0, 120.0, 80.0, 0.0, 40.0, 5.0, 15.0, 30.0};
constexpr double kClock = 20.0, kWhole = 300.0;

/// Rounds of 200 whole and 25 split ticks each, with noise of a few ns; `stolen` of a thousand take 100 µs
/// more.
std::vector<RoundTimes> rounds(int count, int stolen) {
    std::mt19937 random(3);
    std::normal_distribution<double> noise(0.0, 4.0);
    const auto tick = [&](double ns) {
        return ns + kClock + noise(random) + (static_cast<int>(random() % 1000) < stolen ? 1e5 : 0.0);
    };
    std::vector<RoundTimes> all;
    for (int r = 0; r < count; ++r) {
        RoundTimes& round = all.emplace_back();
        for (int i = 0; i < 200; ++i)
            round.whole.push_back(tick(kWhole));
        double sum = 0.0;
        for (size_t s = 0; s < kStageCount; ++s) {
            sum += kTrue[s];
            for (int i = 0; i < 25; ++i)
                round.upTo[s].push_back(tick(sum));
        }
    }
    return all;
}

TEST(StepFigures, FindTheStagesAndTheyAddUp) {
    for (const int stolen : {0, 5}) {
        const StepFigures figures = figuresOf(rounds(60, stolen), kClock);
        EXPECT_NEAR(figures.median.value, kWhole, 1.0);
        EXPECT_NEAR(figures.mean.value, kWhole, 1.0);
        double sum = 0.0;
        for (size_t s = 0; s < kStageCount; ++s) {
            EXPECT_NEAR(figures.stages[s].value, kTrue[s], 1.5) << kStageNames[s] << ", stolen " << stolen;
            EXPECT_LE(figures.stages[s].low, kTrue[s] + 0.5);
            EXPECT_GE(figures.stages[s].high, kTrue[s] - 0.5);
            sum += figures.stages[s].value;
        }
        EXPECT_NEAR(sum, figures.mean.value, 0.01 * kWhole);
    }
}

TEST(StepFigures, LeaveOutRoundsWithHardlyAnyContact) {
    std::vector<RoundTimes> some = rounds(20, 0);
    RoundTimes& lifted = some.emplace_back();
    lifted.whole = {1.0, 2.0};
    const StepFigures figures = figuresOf(some, kClock);
    EXPECT_NEAR(figures.mean.value, kWhole, 1.5);
    EXPECT_EQ(figuresOf(std::span(some).last(1), kClock).median.value, 0.0);
    EXPECT_EQ(figuresOf({}, kClock).mean.value, 0.0);
}

} // namespace
} // namespace touchstone::study::step_figures_test
