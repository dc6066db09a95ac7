// `touchstone study` as a user meets it. What it finds is held by tests/unit/study.

#include "tests/support/program.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>

namespace touchstone::test::study_command_tests {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kBox = TOUCHSTONE_ASSETS "/box.glb";

class StudyCommand : public testing::Test {
  protected:
    StudyCommand() : folder_(fs::temp_directory_path() / ("touchstone study " + std::to_string(::getpid()))) {
        fs::remove_all(folder_);
        fs::create_directories(folder_);
    }
    ~StudyCommand() override { fs::remove_all(folder_); }

    [[nodiscard]] std::string in(const std::string& name) const { return (folder_ / name).string(); }
    /// The contact ablation alone, as few ticks as there can be.
    [[nodiscard]] ProgramResult study(std::vector<std::string> arguments, const std::string& out) const {
        arguments.insert(arguments.begin(), {kProgram, "study"});
        arguments.insert(arguments.end(),
                         {"--out", in(out), "--ladder", "contact", "--quick", "--rounds", "2"});
        return runProgram(arguments);
    }
    [[nodiscard]] Json json(const std::string& out) const {
        return Json::parse(std::ifstream(in(out) + "/study.json"));
    }
    static std::set<std::string> scenes(const Json& study) {
        std::set<std::string> names;
        for (const Json& configuration : study["rungs"])
            names.insert(configuration["scene"]);
        return names;
    }

    fs::path folder_;
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

TEST_F(StudyCommand, ListsItsAblations) {
    const ProgramResult result = runProgram({kProgram, "study", "--list"});
    EXPECT_EQ(result.status, 0) << result.err;
    for (const char* word :
         {"contact", "shading", "texture", "friction", "torus", "wedge", "proxyRadius=0.0005"})
        EXPECT_TRUE(contains(result.out, word)) << word;
}

TEST_F(StudyCommand, RefusesWhatItDoesNotUnderstand) {
    const std::vector<std::vector<std::string>> wrong{{"plane"},
                                                      {"plane", "--out", in("a"), "--shard", "3/2"},
                                                      {"plane", "--out", in("a"), "--shard", "0/2"},
                                                      {"plane", "--out", in("a"), "--shard", "1"},
                                                      {"plane", "--out", in("a"), "--rounds", "1"},
                                                      {"compare", "one.json"}};
    for (std::vector<std::string> arguments : wrong) {
        arguments.insert(arguments.begin(), {kProgram, "study"});
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.status, 2) << result.err;
        EXPECT_TRUE(contains(result.err, "remedy")) << result.err;
    }
    const ProgramResult ablation =
        runProgram({kProgram, "study", "plane", "--out", in("a"), "--ladder", "jacob"});
    EXPECT_EQ(ablation.status, 1);
    EXPECT_TRUE(contains(ablation.err, "jacob")) << ablation.err;
    EXPECT_FALSE(fs::exists(in("a")));
}

TEST_F(StudyCommand, WritesWhatItFound) {
    const ProgramResult result = study({"plane", kBox}, "both");
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(fs::exists(in("both") + "/study.csv"));
    const Json found = json("both");
    EXPECT_EQ(scenes(found), (std::set<std::string>{"plane 2", "box.glb"}));
    EXPECT_TRUE(found["problems"].empty());
    const Json& provenance = found["provenance"];
    for (const char* field : {"machine", "processor", "kernel", "compiler", "build_type", "commit", "date"})
        EXPECT_FALSE(provenance[field].get<std::string>().empty()) << field;
    EXPECT_TRUE(contains(provenance["command"], "study plane")) << provenance["command"];
    EXPECT_GE(found["noticeable"].size(), 5u);
}

TEST_F(StudyCommand, AModelAloneThatCannotBeStudiedIsStatusOne) {
    const ProgramResult result = study({in("missing.glb")}, "out");
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(contains(result.err, "missing.glb")) << result.err;
    EXPECT_TRUE(result.out.empty()) << result.out;
}

TEST_F(StudyCommand, AmongOthersItIsAProblemThatIsTold) {
    fs::create_directories(in("models") + "/deep");
    fs::copy_file(kBox, in("models") + "/deep/a box.GLB");
    std::ofstream(in("models") + "/broken.glb") << "no model";
    const ProgramResult result = study({in("models")}, "out");
    EXPECT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.err, "broken.glb")) << result.err;
    const Json found = json("out");
    EXPECT_EQ(scenes(found), std::set<std::string>{"a box.GLB"});
    ASSERT_EQ(found["problems"].size(), 1u);
    EXPECT_TRUE(contains(found["problems"][0], "broken.glb"));
}

TEST_F(StudyCommand, ShardsShareTheWorkAndMergeToTheWhole) {
    ASSERT_EQ(study({"plane", "wedge", "sphere", "--shard", "1/2"}, "one").status, 0);
    ASSERT_EQ(study({"sphere", "wedge", "plane", "--shard", "2/2"}, "two").status, 0);
    EXPECT_EQ(scenes(json("one")).size(), 2u);
    EXPECT_EQ(scenes(json("two")).size(), 1u);
    const ProgramResult merged =
        runProgram({kProgram, "study", "merge", in("one"), in("two"), "--out", in("all")});
    ASSERT_EQ(merged.status, 0) << merged.err;
    EXPECT_EQ(scenes(json("all")).size(), 3u);
    EXPECT_EQ(json("all")["rungs"].size(), json("one")["rungs"].size() + json("two")["rungs"].size());
}

TEST_F(StudyCommand, ComparesTheOrderOfTwoStudies) {
    ASSERT_EQ(study({"plane"}, "one").status, 0);
    const std::string file = in("one") + "/study.json";
    const ProgramResult same = runProgram({kProgram, "study", "compare", file, file});
    EXPECT_EQ(same.status, 0) << same.out;
    EXPECT_TRUE(contains(same.out, "errors differ in 0")) << same.out;
    Json first = json("one"), second = first;
    for (Json* study : {&first, &second}) {
        double ns = 100.0;
        for (Json& configuration : (*study)["rungs"]) {
            configuration["step_median_ns"] = {{"value", ns}, {"low", ns - 1.0}, {"high", ns + 1.0}};
            ns += study == &first ? 10.0 : -10.0;
        }
    }
    std::ofstream(in("first.json")) << first;
    std::ofstream(in("second.json")) << second;
    const ProgramResult turned =
        runProgram({kProgram, "study", "compare", in("first.json"), in("second.json")});
    EXPECT_EQ(turned.status, 1) << turned.err;
    EXPECT_TRUE(contains(turned.out, "plane 2, contact: ")) << turned.out;
}

} // namespace
} // namespace touchstone::test::study_command_tests
