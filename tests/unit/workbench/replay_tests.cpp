// `touch --record` and `replay` as a user meets them.

#include "tests/support/program.h"
#include "tests/unit/workbench/touch_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>

namespace touchstone::test {
namespace {

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kAssets = TOUCHSTONE_ASSETS;

class Replay : public testing::Test {
  protected:
    /// Touches a copy of a scene, so that a test may change it.
    void record(const std::string& asset, const std::vector<std::string>& more = {}) {
        std::filesystem::copy_file(kAssets + "/" + asset, scene_,
                                   std::filesystem::copy_options::overwrite_existing);
        writeTextFile(scratch_ / "hip.csv", straightPath({-0.05, 0.0, 0.09}, {0.05, 0.02, 0.0}, 1500));
        std::vector<std::string> arguments{kProgram,
                                           "touch",
                                           scene_.string(),
                                           "--path",
                                           (scratch_ / "hip.csv").string(),
                                           "--out",
                                           (scratch_ / "touched.csv").string(),
                                           "--record",
                                           file_.string(),
                                           "--fit",
                                           "workspace"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const ProgramResult result = runProgram(arguments);
        ASSERT_EQ(result.status, 0) << result.err;
    }
    ProgramResult replay(const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{kProgram, "replay", file_.string(), "--json", json_.string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        std::filesystem::remove(json_);
        return runProgram(arguments);
    }
    [[nodiscard]] nlohmann::json figures() const { return nlohmann::json::parse(readFile(json_)); }
    [[nodiscard]] static bool says(const std::string& text, const std::string& what) {
        return text.find(what) != std::string::npos;
    }

    ScratchFolder scratch_;
    std::filesystem::path scene_ = scratch_ / "scene.glb", file_ = scratch_ / "r.tsrec",
                          json_ = scratch_ / "r.json";
};

TEST_F(Replay, GivesTheSameTicksToTheLastDigit) {
    const std::vector<std::vector<std::string>> variants{{},
                                                         {"--closed-loop"},
                                                         {"--set", "contact=neighbourhood"},
                                                         {"--set", "friction=ho", "--rate", "2500"}};
    for (const char* asset : {"doughnut.glb", "moving.glb"})
        for (const std::vector<std::string>& variant : variants) {
            record(asset, variant);
            const std::string again = (scratch_ / "again.csv").string();
            const ProgramResult result = replay({"--out", again});
            ASSERT_EQ(result.status, 0) << result.out << result.err;
            EXPECT_TRUE(says(result.out, "replayed, all equal")) << result.out;
            EXPECT_EQ(result.err, "");
            EXPECT_EQ(withoutColumn(readFile(again), "step_ns"),
                      withoutColumn(readFile(scratch_ / "touched.csv"), "step_ns"));
            EXPECT_EQ(figures()["equal"], true);
            EXPECT_EQ(figures()["first_difference"], nullptr);
            EXPECT_EQ(figures()["recorded_by"]["same_build"], true);
            EXPECT_EQ(figures()["recorded_by"]["same_processor"], true);
            EXPECT_EQ(figures()["scenes"][0]["feels_the_same"], true);
            EXPECT_GT(figures()["contact"]["ticks"], 10);
        }
}

TEST_F(Replay, RecordingChangesNothing) {
    record("doughnut.glb");
    const std::string with = readFile(scratch_ / "touched.csv");
    ASSERT_EQ(runProgram({kProgram, "touch", scene_.string(), "--path", (scratch_ / "hip.csv").string(),
                          "--out", (scratch_ / "touched.csv").string(), "--fit", "workspace"})
                  .status,
              0);
    EXPECT_EQ(withoutColumn(readFile(scratch_ / "touched.csv"), "step_ns"), withoutColumn(with, "step_ns"));
}

TEST_F(Replay, ASceneThatFeelsOtherwiseIsSaidAndTheFirstTickNamed) {
    record("doughnut.glb");
    std::filesystem::copy_file(kAssets + "/torus_64800.glb", scene_,
                               std::filesystem::copy_options::overwrite_existing);
    const ProgramResult result = replay();
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(says(result.err, "has changed since it was touched: what is felt is not the same"))
        << result.err;
    EXPECT_TRUE(says(result.out, "differs first, in the stage '")) << result.out;
    EXPECT_EQ(figures()["equal"], false);
    EXPECT_GT(figures()["differing"], 0);
    EXPECT_TRUE(figures()["first_difference"]["stage"].is_string());
    EXPECT_EQ(figures()["scenes"][0]["same_file"], false);
    EXPECT_EQ(figures()["scenes"][0]["feels_the_same"], false);
}

TEST_F(Replay, ASceneThatOnlyLooksOtherwiseIsSaidToo) {
    record("doughnut.glb");
    // Another generator's name in the JSON, as long as ours: other bytes, the same model.
    std::string bytes = readFile(scene_);
    const size_t at = bytes.find("\"generator\":\"");
    ASSERT_NE(at, std::string::npos);
    bytes[at + 13] = bytes[at + 13] == 'X' ? 'Y' : 'X';
    writeTextFile(scene_, bytes);
    const ProgramResult result = replay();
    EXPECT_EQ(result.status, 0) << result.out << result.err;
    EXPECT_TRUE(says(result.err, "has changed since it was touched, but nothing that is felt")) << result.err;
    EXPECT_EQ(figures()["scenes"][0]["same_file"], false);
    EXPECT_EQ(figures()["scenes"][0]["feels_the_same"], true);
}

TEST_F(Replay, ASceneThatIsGoneIsAskedForAndTakenFromElsewhere) {
    record("moving.glb");
    const std::filesystem::path moved = scratch_ / "elsewhere.glb";
    std::filesystem::rename(scene_, moved);
    const ProgramResult gone = replay();
    EXPECT_EQ(gone.status, 1);
    EXPECT_TRUE(says(gone.err, scene_.string() + ": the scene that was touched is not there")) << gone.err;
    EXPECT_TRUE(says(gone.err, "--scene")) << gone.err;
    EXPECT_FALSE(std::filesystem::exists(json_)) << "nothing half written";
    const ProgramResult found = replay({"--scene", moved.string()});
    EXPECT_EQ(found.status, 0) << found.out << found.err;
    // Recording and scene taken elsewhere together find each other.
    std::filesystem::create_directory(scratch_ / "other");
    std::filesystem::rename(moved, scratch_ / "other/scene.glb");
    std::filesystem::rename(file_, scratch_ / "other/r.tsrec");
    file_ = scratch_ / "other/r.tsrec";
    EXPECT_EQ(replay().status, 0);
}

TEST_F(Replay, AFileThatIsCutOffIsReplayedAsFarAsItGoes) {
    record("doughnut.glb");
    const std::string bytes = readFile(file_);
    writeTextFile(file_, bytes.substr(0, bytes.size() * 2 / 3));
    const ProgramResult result = replay();
    EXPECT_EQ(result.status, 0) << result.out << result.err;
    EXPECT_TRUE(says(result.err, "is cut off")) << result.err;
    EXPECT_EQ(figures()["cut_off"], true);
    EXPECT_GT(figures()["replayed"], 500);
    EXPECT_LT(figures()["replayed"], 1500);
}

TEST_F(Replay, ADamagedFileIsNotTakenForAWholeOne) {
    record("doughnut.glb");
    std::string bytes = readFile(file_);
    bytes[bytes.size() / 2] = static_cast<char>(bytes[bytes.size() / 2] ^ 1);
    writeTextFile(file_, bytes);
    const ProgramResult result = replay();
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(says(result.err, "spoilt as far as byte")) << result.err;
    EXPECT_EQ(figures()["equal"], true) << "what is left is equal";
    EXPECT_EQ(figures()["gaps"], 1);
    EXPECT_GT(figures()["replayed"], 100);
    EXPECT_LT(figures()["replayed"], figures()["ticks"]) << "there is no checkpoint behind the gap";
}

TEST_F(Replay, NothingToReplayIsNoSuccess) {
    record("doughnut.glb");
    const std::string bytes = readFile(file_);
    writeTextFile(file_, bytes.substr(0, 100)); // the header and half a chunk
    const ProgramResult empty = replay();
    EXPECT_EQ(empty.status, 1);
    EXPECT_TRUE(says(empty.out, "there are no ticks in it")) << empty.out;
    std::string spoilt = bytes;
    const size_t state = bytes.find("STAT");
    ASSERT_NE(state, std::string::npos);
    spoilt[state + 30] = static_cast<char>(spoilt[state + 30] ^ 1);
    writeTextFile(file_, spoilt);
    const ProgramResult headless = replay();
    EXPECT_EQ(headless.status, 1);
    EXPECT_TRUE(says(headless.out, "none of its ticks can be replayed")) << headless.out << headless.err;
    EXPECT_TRUE(says(headless.err, "spoilt")) << headless.err;
}

TEST_F(Replay, WhatIsNoRecordingSaysSo) {
    writeTextFile(file_, "t,x,y,z\n0,0,0,0\n");
    const ProgramResult text = replay();
    EXPECT_EQ(text.status, 1);
    EXPECT_TRUE(says(text.err, file_.string() + ": is no recording of Touchstone")) << text.err;
    file_ = scratch_ / "nothing";
    EXPECT_TRUE(says(replay().err, "No such file")) << replay().err;
    EXPECT_EQ(runProgram({kProgram, "replay"}).status, 2);
}

TEST_F(Replay, TouchSaysWhereItCannotRecord) {
    file_ = "/dev/full";
    writeTextFile(scratch_ / "hip.csv", straightPath({-0.05, 0.0, 0.09}, {0.05, 0.02, 0.0}, 1500));
    const ProgramResult result =
        runProgram({kProgram, "touch", kAssets + "/moving.glb", "--path", (scratch_ / "hip.csv").string(),
                    "--out", (scratch_ / "touched.csv").string(), "--record", "/dev/full"});
    EXPECT_EQ(result.status, 1);
    EXPECT_TRUE(says(result.err, "/dev/full: recording failed: No space left")) << result.err;
    EXPECT_FALSE(std::filesystem::exists(scratch_ / "touched.csv")) << "nothing half written";
}

} // namespace
} // namespace touchstone::test
