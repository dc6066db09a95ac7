#include "study/pareto.h"

#include <gtest/gtest.h>

namespace touchstone::study::pareto_test {
namespace {

ConfigurationResult point(double ns, double error, const char* ablation = "combination",
                          const char* scene = "torus") {
    ConfigurationResult configuration;
    configuration.scene = scene;
    configuration.ablation = ablation;
    configuration.step = {ns, 0.95 * ns, 1.05 * ns};
    configuration.errors.force.p99 = error;
    configuration.errors.compared = 1;
    return configuration;
}

std::vector<bool> front(std::vector<ConfigurationResult> configurations) {
    markPareto(configurations);
    std::vector<bool> on;
    for (const ConfigurationResult& configuration : configurations)
        on.push_back(configuration.pareto);
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

TEST(Pareto, ComparesWithinSceneAndAblation) {
    EXPECT_EQ(front({point(100, 5), point(200, 9, "friction"), point(200, 9, "combination", "sphere")}),
              (std::vector{true, true, true}));
}

TEST(Pareto, NeedsSomethingToCompare) {
    std::vector<ConfigurationResult> configurations{point(100, 0), point(200, 3), point(0, 1)};
    configurations[0].errors.compared = 0;
    EXPECT_EQ(front(configurations), (std::vector{false, true, false}));
}

} // namespace
} // namespace touchstone::study::pareto_test
