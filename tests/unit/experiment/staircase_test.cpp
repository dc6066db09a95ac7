// One up, two down [004 §5] by hand, and its bias and spread on functions that are known.

#include "engine/core/error.h"
#include "experiment/people/psychometric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

namespace touchstone::experiment {
namespace {

TEST(Staircase, RisesAfterTwoRightAnswersAndFallsAfterOneWrong) {
    Staircase staircase({.start = 10.0,
                         .largeStep = 4.0,
                         .smallStep = 1.0,
                         .lowest = 2.0,
                         .highest = 100.0,
                         .largeReversals = 2,
                         .reversals = 4,
                         .averaged = 2});
    const auto answers = [&](std::initializer_list<bool> each) {
        for (const bool right : each)
            staircase.answer(right);
    };
    answers({true});
    EXPECT_EQ(staircase.level(), 10.0);
    answers({true});
    EXPECT_EQ(staircase.level(), 14.0) << "two in a row";
    answers({true, false});
    EXPECT_EQ(staircase.level(), 10.0) << "one right one does not count beside a wrong one";
    ASSERT_EQ(staircase.reversals().size(), 1u);
    EXPECT_EQ(staircase.reversals()[0], 14.0);
    answers({false});
    EXPECT_EQ(staircase.level(), 6.0) << "still large";
    EXPECT_EQ(staircase.reversals().size(), 1u) << "the same direction";
    answers({true, true});
    EXPECT_EQ(staircase.reversals()[1], 6.0);
    EXPECT_EQ(staircase.level(), 7.0) << "small from the second reversal on";
    EXPECT_FALSE(staircase.threshold());
    answers({false, true, true});
    EXPECT_TRUE(staircase.finished());
    EXPECT_EQ(staircase.threshold(), 0.5 * (7.0 + 6.0)) << "the last two";
    const size_t trials = staircase.trials().size();
    answers({true});
    EXPECT_EQ(staircase.trials().size(), trials) << "it has ended";
}

TEST(Staircase, StaysWithinItsLevelsAndEndsWhateverIsAnswered) {
    Staircase staircase(
        {.start = 3.0, .largeStep = 5.0, .smallStep = 1.0, .lowest = 2.0, .highest = 9.0, .mostTrials = 50});
    while (!staircase.finished()) {
        EXPECT_GE(staircase.level(), 2.0);
        staircase.answer(false);
    }
    EXPECT_EQ(staircase.trials().size(), 50u);
    EXPECT_EQ(staircase.level(), 2.0);
    EXPECT_FALSE(staircase.threshold()) << "no reversal, no threshold";
}

TEST(Staircase, RefusesRulesThatCannotBe) {
    const StaircaseRule good{.start = 3.0, .lowest = 2.0, .highest = 9.0};
    EXPECT_NO_THROW(Staircase{good});
    const auto refused = [&](auto change) {
        StaircaseRule rule = good;
        change(rule);
        EXPECT_THROW(Staircase{rule}, Error);
    };
    refused([](StaircaseRule& r) { r.smallStep = 0.0; });
    refused([](StaircaseRule& r) { r.largeStep = -1.0; });
    refused([](StaircaseRule& r) { r.start = 10.0; });
    refused([](StaircaseRule& r) { r.highest = 1.0; });
    refused([](StaircaseRule& r) { r.averaged = 12; });
    refused([](StaircaseRule& r) { r.averaged = 0; });
    refused([](StaircaseRule& r) { r.start = std::numeric_limits<double>::quiet_NaN(); });
}

TEST(PsychometricFunction, OneThatNobodyHasIsRefused) {
    const StaircaseRule rule{.start = 3.0, .lowest = 2.0, .highest = 9.0};
    for (const PsychometricFunction function :
         {PsychometricFunction{5.0, 0.0}, PsychometricFunction{5.0, -1.0},
          PsychometricFunction{5.0, 1.0, 0.3}, PsychometricFunction{5.0, 1.0, -0.1},
          PsychometricFunction{std::nan(""), 1.0}})
        EXPECT_THROW((void)simulate(rule, function, 1, 1), Error);
}

TEST(PsychometricFunction, IsHalfWhereNothingIsToldAndItsLevelsAreItsInverse) {
    const PsychometricFunction function{.middle = 100.0, .spread = 20.0};
    EXPECT_NEAR(function.share(1000.0), 0.5, 1e-12);
    EXPECT_NEAR(function.share(100.0), 0.75, 1e-15);
    EXPECT_NEAR(function.share(-1000.0), 1.0, 1e-12);
    for (const double share : {0.55, kStaircaseShare, 0.95})
        EXPECT_NEAR(function.share(function.levelOf(share)), share, 1e-12);
    EXPECT_NEAR((PsychometricFunction{100.0, 20.0, 0.02}).share(-1000.0), 0.98, 1e-12);
}

/// 10,000 runs each. The bias is a share of the function's spread: with large steps of half the spread and
/// small ones of at most a quarter it is under 5 % of the 70.7 % point even where the spread is 0.4 of the
/// middle. Larger first steps overshoot upwards, where two right answers in a row happen by chance; smaller
/// ones still come from the start.
TEST(Staircase, FindsThe707PercentPointOfKnownFunctions) {
    std::printf("| spread / middle | small step / spread | large / small | bias, %% of the 70.7 %% point | "
                "spread, %% | trials |\n");
    std::printf("|---|---|---|---|---|---|\n");
    for (const double spread : {0.1, 0.2, 0.4})
        for (const double small : {0.0625, 0.125, 0.25, 0.5, 1.0})
            for (const double large : {2.0, 4.0, 8.0}) {
                const PsychometricFunction function{.middle = 100.0, .spread = 100.0 * spread};
                const double step = small * function.spread;
                const StaircaseRule rule{.start = function.middle - 2.0 * function.spread,
                                         .largeStep = large * step,
                                         .smallStep = step,
                                         .lowest = 1.0,
                                         .highest = 1000.0};
                const ProcedureError error = simulate(rule, function, 10000, 1);
                const double bias = error.bias / error.target;
                std::printf("| %.1f | %.3f | %.0f | %+.2f | %.2f | %.1f |\n", spread, small, large,
                            100.0 * bias, 100.0 * error.spread / error.target, error.trials);
                EXPECT_EQ(error.ended, error.runs);
                if (small <= 0.25 && large * small == 0.5) {
                    EXPECT_LT(std::abs(bias), 0.05) << spread << " " << small << " " << large;
                }
            }
}

} // namespace
} // namespace touchstone::experiment
