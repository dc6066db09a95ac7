// Distributions against published tables, and the analysis of variance against an example worked by hand.

#include "engine/core/error.h"
#include "experiment/statistics/distributions.h"
#include "experiment/statistics/variance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace touchstone::experiment {
namespace {

/// Upper 5 % and 1 % points as every table of the studentized range prints them (Harter 1960).
TEST(StudentizedRange, HasThePointsOfThePublishedTable) {
    struct Row {
        double tail;
        int groups;
        double degrees, q;
    };
    for (const Row& row : {Row{0.05, 2, 10.0, 3.151}, Row{0.05, 3, 10.0, 3.877}, Row{0.05, 4, 20.0, 3.958},
                           Row{0.05, 4, 30.0, 3.845}, Row{0.05, 4, 40.0, 3.791}, Row{0.05, 3, 60.0, 3.399},
                           Row{0.05, 10, 20.0, 5.008}, Row{0.05, 5, 120.0, 3.917}, Row{0.01, 4, 20.0, 5.018},
                           Row{0.01, 3, 10.0, 5.270}, Row{0.05, 3, 2.0, 8.331}, Row{0.05, 4, 1e9, 3.633}}) {
        EXPECT_NEAR(studentizedRangeQuantile(row.tail, row.groups, row.degrees), row.q, 6e-4)
            << row.tail << ", " << row.groups << " groups, " << row.degrees;
        EXPECT_NEAR(studentizedRangeTail(row.q, row.groups, row.degrees), row.tail, 5e-4 * row.tail / 0.05);
    }
}

/// For two groups q = sqrt 2 |t|.
TEST(StudentizedRange, OfTwoGroupsIsStudentsT) {
    for (const double degrees : {3.0, 11.0, 33.0, 200.0})
        EXPECT_NEAR(studentizedRangeQuantile(0.05, 2, degrees), std::sqrt(2.0) * tQuantile(0.95, degrees),
                    1e-6)
            << degrees;
}

TEST(Distributions, OfF) {
    EXPECT_NEAR(fTail(2.8916, 3.0, 33.0), 0.05, 2e-5); // tables: F(0.05; 3, 33) = 2.89
    EXPECT_NEAR(fTail(2.8165, 3.0, 44.0), 0.05, 2e-5); // 2.82
    EXPECT_LT(fTail(47.76, 3.0, 44.0), 1e-3) << "[004]";
    EXPECT_EQ(fTail(-1.0, 3.0, 33.0), 1.0);
    EXPECT_TRUE(std::isnan(fTail(std::nan(""), 3.0, 33.0)));
    EXPECT_THROW((void)fTail(1.0, 0.0, 3.0), Error);
    EXPECT_NEAR(tQuantile(0.95, 11.0), 2.201, 5e-4);
    EXPECT_NEAR(guessTail(15, 20), 0.0207, 1e-4);
    EXPECT_EQ(guessTail(0, 20), 1.0);
}

/// Three people, three conditions, by hand: conditions' means 3, 5, 7 (sum of squares 24, two degrees);
/// within them 2 + 2 + 6 = 10 (six degrees); people's means 4, 5, 6 (6); error 10 - 6 = 4 (four degrees).
TEST(Variance, IsThatOfAnExampleByHand) {
    const Variance v = analyse({{2.0, 5.0, 5.0}, {3.0, 4.0, 8.0}, {4.0, 6.0, 8.0}});
    EXPECT_NEAR(v.means[0].mean, 3.0, 1e-12);
    EXPECT_NEAR(v.means[2].mean, 7.0, 1e-12);
    EXPECT_NEAR(v.independent.f, 12.0 / (10.0 / 6.0), 1e-12);
    EXPECT_EQ(v.independent.within, 6.0);
    EXPECT_NEAR(v.repeated.f, 12.0, 1e-12);
    EXPECT_EQ(v.repeated.within, 4.0);
    EXPECT_NEAR(v.tukey[1].difference, 4.0, 1e-12);
    EXPECT_NEAR(v.tukey[1].q, 4.0 / std::sqrt(1.0 / 3.0), 1e-12);
    EXPECT_GE(v.epsilon, 0.5);
    EXPECT_LE(v.epsilon, 1.0);
    EXPECT_GE(v.correctedP, v.repeated.p);
}

TEST(Variance, HasThePapersDegreesOfFreedom) {
    Thresholds values;
    for (int person = 0; person < 12; ++person)
        values.push_back({100.0 + person, 16.0 + 0.1 * person * person, 250.0 - person, 15.0 + (person % 3)});
    const Variance v = analyse(values);
    EXPECT_EQ(v.repeated.between, 3.0);
    EXPECT_EQ(v.repeated.within, 33.0);
    EXPECT_EQ(v.independent.within, 44.0);
    EXPECT_EQ(v.tukey.size(), 6u);
}

TEST(Variance, RefusesWhatItCannotAnalyse) {
    EXPECT_THROW((void)analyse({}), Error);
    EXPECT_THROW((void)analyse({{1.0, 2.0}}), Error);
    EXPECT_THROW((void)analyse({{1.0}, {2.0}}), Error);
    EXPECT_THROW((void)analyse({{1.0, 2.0}, {1.0}}), Error);
    EXPECT_THROW((void)analyse({{1.0, 2.0}, {1.0, std::nan("")}}), Error);
    const Variance flat = analyse({{1.0, 1.0}, {1.0, 1.0}});
    EXPECT_EQ(flat.repeated.p, 1.0) << "no difference and no error";
}

} // namespace
} // namespace touchstone::experiment
