// `touchstone experiment` from the command line: simulated people, reports, studies of one's own.

#include "tests/support/program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>

namespace touchstone::test::experiment_command_tests {
namespace {

ProgramResult experiment(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {TOUCHSTONE_BINARY, "experiment"});
    return runProgram(arguments);
}

TEST(ExperimentCommand, RunsWholeStudiesWithSimulatedPeople) {
    const ScratchFolder folder;
    const std::string out = folder / "out", again = folder / "again";
    const ProgramResult result =
        experiment({"--observer", "--seed", "3", "--people", "4", "--attention", "tactile", "--out", out});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_NE(result.out.find("F(3,9)"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("257.3"), std::string::npos) << "the paper's";
    const auto report = nlohmann::json::parse(readFile(folder / "out" / "report.json"));
    EXPECT_EQ(report["people"], 4);
    EXPECT_GT(report["power"].size(), 3u);
    EXPECT_GT(report["conditions"][2]["mean"], report["conditions"][0]["mean"]) << "C3 > C1";
    ASSERT_EQ(
        experiment({"--observer", "--seed", "3", "--people", "4", "--attention", "tactile", "--out", again})
            .status,
        0);
    EXPECT_EQ(readFile(folder / "out" / "trials.csv"), readFile(folder / "again" / "trials.csv"))
        << "the same seed";
    EXPECT_EQ(experiment({"--observer", "--out", out}).status, 1) << "sessions are not overwritten";
}

TEST(ExperimentCommand, ReportsWhatItCanReadAndNamesTheRest) {
    const ScratchFolder folder;
    const std::string out = folder / "out";
    ASSERT_EQ(experiment({"--observer", "--people", "3", "--out", out}).status, 0);
    const std::filesystem::path one = folder / "out" / "person_02.session";
    const std::string text = readFile(one);
    writeTextFile(one, text.substr(0, text.size() - 9)); // cut off
    ProgramResult result = experiment({"--report", "--out", out});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("cut off"), std::string::npos) << result.err;
    writeTextFile(one, text.substr(0, 500) + "x" + text.substr(500));
    result = experiment({"--report", "--out", out});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("person_02.session: line 1"), std::string::npos) << result.err;
    EXPECT_NE(result.out.find("2 sessions"), std::string::npos) << "the others";
    EXPECT_EQ(experiment({"--report", "--out", folder / "nothing"}).status, 1);
}

TEST(ExperimentCommand, PrintsAStudyThatItReadsAgain) {
    const ScratchFolder folder;
    const ProgramResult printed = experiment({"--print-study"});
    ASSERT_EQ(printed.status, 0);
    writeTextFile(folder / "mine.json", printed.out);
    EXPECT_EQ(experiment({folder / "mine.json", "--print-study"}).status, 0);
    writeTextFile(folder / "broken.json", printed.out.substr(0, 200));
    const ProgramResult broken = experiment({folder / "broken.json", "--observer", "--out", folder / "out"});
    EXPECT_EQ(broken.status, 1);
    EXPECT_NE(broken.err.find("no JSON"), std::string::npos);
}

TEST(ExperimentCommand, TakesOneModeAtATime) {
    EXPECT_EQ(experiment({}).status, 2);
    EXPECT_EQ(experiment({"--observer"}).status, 2) << "without --out";
    EXPECT_EQ(experiment({"--observer", "--report", "--out", "/tmp"}).status, 2);
    EXPECT_EQ(experiment({"--observer", "--attention", "none", "--out", "/tmp"}).status, 2);
    EXPECT_EQ(experiment({"--help"}).status, 0);
}

} // namespace
} // namespace touchstone::test::experiment_command_tests
