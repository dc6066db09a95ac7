// A study in shards under GNU parallel is the study, but for its times.

#include "study/report/report.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace touchstone::study::test {
namespace {

using touchstone::test::ProgramResult;
using touchstone::test::runProgram;
using touchstone::test::ScratchFolder;

/// Three files that can be touched, one that cannot, and a shape.
std::vector<std::string> what(const ScratchFolder& folder) {
    touchstone::test::writeTextFile(folder / "broken model.glb", "glTF it is not");
    std::vector<std::string> all{(folder / "broken model.glb").string(), "sphere"};
    for (const char* name : {"box.glb", "table1_object2.glb", "prism_smooth.glb"})
        all.push_back((std::filesystem::path(TOUCHSTONE_ASSETS) / name).string());
    return all;
}

/// All that a run finds again, whatever the times: what was measured and how far it was from the truth.
std::multiset<std::string> configurations(const StudyResult& result) {
    std::multiset<std::string> all;
    for (const ConfigurationResult& r : result.configurations)
        all.insert(r.scene + "; " + r.path + "; " + r.ablation + "; " + r.configuration + "; " + r.settings +
                   "; " + std::to_string(r.triangles) + "; " + std::to_string(r.errors.compared) + "; " +
                   std::to_string(1e12 * r.errors.force.p99));
    return all;
}

TEST(StudyShards, UnderGnuParallelMergeToTheWhole) {
    const ScratchFolder folder;
    std::vector<std::string> study{TOUCHSTONE_BINARY, "study"};
    for (const std::string& one : what(folder))
        study.push_back(one);
    for (const char* word : {"--ladder", "contact", "--ladder", "budget", "--quick", "--rounds", "2"})
        study.emplace_back(word);

    std::vector<std::string> whole = study;
    whole.insert(whole.end(), {"--out", (folder / "whole").string()});
    const ProgramResult once = runProgram(whole);
    ASSERT_EQ(once.status, 0) << once.err;

    std::vector<std::string> shards{"parallel", "--will-cite", "--quote", "-j2"};
    shards.insert(shards.end(), study.begin(), study.end());
    shards.insert(shards.end(),
                  {"--shard", "{}/3", "--out", (folder / "part").string() + "{}", ":::", "1", "2", "3"});
    const ProgramResult parallel = runProgram(shards);
    ASSERT_EQ(parallel.status, 0) << parallel.err << "\n(apt-get install parallel)";

    std::vector<std::string> merge{TOUCHSTONE_BINARY, "study", "merge"};
    for (const char* part : {"part1", "part2", "part3"}) {
        EXPECT_FALSE(std::filesystem::exists(folder / part / "plots")) << "plots are for the whole";
        merge.push_back((folder / part).string());
    }
    merge.insert(merge.end(), {"--out", (folder / "merged").string()});
    const ProgramResult merged = runProgram(merge);
    ASSERT_EQ(merged.status, 0) << merged.err;

    const StudyResult expected = readStudyJson(folder / "whole" / "study.json"),
                      found = readStudyJson(folder / "merged" / "study.json");
    EXPECT_GE(expected.configurations.size(), 12u);
    EXPECT_EQ(configurations(found), configurations(expected));
    ASSERT_EQ(expected.problems.size(), 1u);
    EXPECT_EQ(found.problems, expected.problems)
        << "the broken model, and nothing measured twice or elsewhere";
    size_t lines = 0;
    for (const char c : touchstone::test::readFile(folder / "merged" / "study.csv"))
        lines += c == '\n' ? 1 : 0;
    EXPECT_EQ(lines, 1 + expected.configurations.size());
    EXPECT_TRUE(std::filesystem::exists(folder / "merged" / "plots"));
}

TEST(StudyShards, MergeTellsAPartThatIsNone) {
    const ScratchFolder folder;
    touchstone::test::writeTextFile(folder / "study.json", "{}");
    const ProgramResult merged = runProgram(
        {TOUCHSTONE_BINARY, "study", "merge", folder.path().string(), "--out", (folder / "all").string()});
    EXPECT_EQ(merged.status, 1);
    EXPECT_NE(merged.err.find("study.json: format"), std::string::npos) << merged.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "all"));
}

} // namespace
} // namespace touchstone::study::test
