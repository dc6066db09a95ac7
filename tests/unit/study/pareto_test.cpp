#include "study/pareto.h"

#include <gtest/gtest.h>

namespace touchstone::study {
namespace {

RungResult point(double ns, double error, const char* ladder = "combination", const char* scene = "torus") {
    RungResult rung;
    rung.scene = scene;
    rung.ladder = ladder;
    rung.step = {ns, 0.95 * ns, 1.05 * ns};
    rung.errors.force.p99 = error;
    rung.errors.compared = 1;
    return rung;
}

std::vector<bool> front(std::vector<RungResult> rungs) {
    markPareto(rungs);
    std::vector<bool> on;
    for (const RungResult& rung : rungs)
        on.push_back(rung.pareto);
    return on;
}

TEST(Pareto, IsWhatNothingBeatsInBoth) {
    EXPECT_EQ(front({point(100, 5), point(200, 3), point(150, 6), point(250, 3), point(300, 1)}),
              (std::vector{true, true, false, false, true}));
}

/// 104 is no more than 100, as far as the intervals tell: then the nearer one has it.
TEST(Pareto, HangsOnNothingThatTheIntervalsCannotTell) {
    EXPECT_EQ(front({point(100, 5), point(104, 3)}), (std::vector{false, true}));
    EXPECT_EQ(front({point(104, 5), point(100, 5)}), (std::vector{true, true}));
    EXPECT_EQ(front({point(100, 5), point(120, 5)}), (std::vector{true, false}));
}

TEST(Pareto, KeepsBothOfTwoThatAreAlike) {
    EXPECT_EQ(front({point(100, 5), point(100, 5), point(100, 6)}), (std::vector{true, true, false}));
}

TEST(Pareto, ComparesWithinSceneAndLadder) {
    EXPECT_EQ(front({point(100, 5), point(200, 9, "friction"), point(200, 9, "combination", "sphere")}),
              (std::vector{true, true, true}));
}

TEST(Pareto, NeedsSomethingToCompare) {
    std::vector<RungResult> rungs{point(100, 0), point(200, 3), point(0, 1)};
    rungs[0].errors.compared = 0;
    EXPECT_EQ(front(rungs), (std::vector{false, true, false}));
}

} // namespace
} // namespace touchstone::study
