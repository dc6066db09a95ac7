// The loops without a window.

#include "tests/support/eventually.h"
#include "tests/support/program.h"
#include "tests/unit/workbench/picture_size.h"
#include "tests/unit/workbench/touch_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <system_error>

namespace touchstone::test::run_tests {
namespace {

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";
const Environment kValidated{"TOUCHSTONE_VALIDATION=1", "DISPLAY=", "WAYLAND_DISPLAY="};

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
const nlohmann::json kNoLock; // null: the sanitizer stands in the counter's place
#else
const nlohmann::json kNoLock = 0;
#endif

TEST(Run, TicksTouchesAndDrawsWithoutAllocatingInTheTick) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "r.json").string(), shot = (scratch / "s.png").string(),
                      csv = (scratch / "t.csv").string();
    const ProgramResult result = runProgram({kProgram, "run", kDoughnut, "--seconds", "3", "--json", json,
                                             "--screenshot", shot, "--record-ticks", csv},
                                            kValidated);
    ASSERT_EQ(result.status, 0) << result.err;
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    EXPECT_EQ(figures["deallocations_in_tick"], 0);
    EXPECT_EQ(figures["locks_in_tick"], kNoLock);
    EXPECT_GT(figures["servo"]["ticks"], 100);
    EXPECT_TRUE(figures["servo"].contains("stolen_s"));
    for (const char* name : {"wake_histogram", "step_histogram"}) {
        const auto& histogram = figures[name];
        ASSERT_EQ(histogram["to_us"].size(), histogram["ticks"].size()) << name;
        uint64_t ticks = 0;
        for (const auto& bin : histogram["ticks"])
            ticks += bin.get<uint64_t>();
        EXPECT_EQ(ticks + figures["servo"]["dropped_records"].get<uint64_t>(), figures["servo"]["ticks"])
            << name;
    }
    for (const char* name : {"missed", "p50_us", "p99_us", "p999_us", "rate_hz", "scheduling"})
        EXPECT_TRUE(figures["servo"].contains(name)) << name;
    EXPECT_GT(figures["frames"]["count"], 0);
    EXPECT_GT(figures["frames"]["fps"], 0.0);
    EXPECT_GT(figures["step"]["p50_ns"], 0);
    double stages = 0.0;
    for (const auto& stage : figures["stages"]) {
        EXPECT_GT(stage["mean_ns"], 0.0) << figures["stages"];
        EXPECT_LE(stage["p50_ns"], stage["p99_ns"]);
        stages += stage["mean_ns"].get<double>();
    }
    EXPECT_EQ(figures["stages"].size(), 8u);
    EXPECT_LE(stages, figures["step"]["max_ns"].get<double>());
    EXPECT_GT(figures["contact"]["ticks"], 0);
    EXPECT_GE(figures["contact"]["proxy_on_mesh_share"], 0.95);
    EXPECT_GT(figures["force"]["max_n"], 0.0);
    EXPECT_EQ(figures["loop"]["mass"], 0.075) << "the hand yields";
    EXPECT_LT(figures["loop"]["coulomb_loss_j"], 0.1);
    EXPECT_GT(figures["loop"]["coulomb_loss_j"], 0.0);
    if (figures["servo"]["skipped"] == 0) { // else a force was held for longer than a tick
        EXPECT_LT(figures["energy"]["most_balance_j"], 1e-3);
    }
    EXPECT_EQ(figures["flags"]["force_fault"], 0);
    EXPECT_EQ(figures["gpu"]["validation_active"], true);
    EXPECT_EQ(figures["gpu"]["validation_messages"], 0) << result.err;
    EXPECT_EQ(pngSize(readFile(shot)), (std::pair<uint32_t, uint32_t>(800, 450)));
    const Table ticks = readTable(csv);
    EXPECT_EQ(ticks.rows + figures["servo"]["dropped_records"].get<size_t>(),
              figures["servo"]["ticks"].get<size_t>());
}

/// With a clock it may be given some, where a deadline is passed over.
TEST(Run, ItsHandIsGivenNoEnergyWhereNoTickIsLate) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "r.json").string();
    const ProgramResult result =
        runProgram({kProgram, "touch", kDoughnut, "--fit", "workspace", "--closed-loop", "--stroke", "circle",
                    "--out", (scratch / "t.csv").string(), "--json", json});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_GT(figures["contact"]["ticks"], 1000);
    EXPECT_EQ(figures["loop"]["mass"], 0.075);
    EXPECT_LT(figures["energy"]["most_balance_j"], 1e-3);
}

TEST(Run, SettingsReachTheServo) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "r.json").string(), csv = (scratch / "t.csv").string();
    ASSERT_EQ(runProgram({kProgram, "run", kDoughnut, "--headless", "--seconds", "1", "--json", json, "--set",
                          "forceEnabled=off", "--record-ticks", csv})
                  .status,
              0);
    EXPECT_EQ(nlohmann::json::parse(readFile(json))["settings"]["forceEnabled"], "off");
    const Table ticks = readTable(csv);
    for (size_t i = 0; i < ticks.rows; ++i)
        ASSERT_EQ(ticks["command_y"][i], 0.0);
}

/// Two hands on objects that move: both touch, each has its own file, and the recording replays with both.
TEST(Run, DrivesTwoHandsInOneServo) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "r.json").string(), first = (scratch / "1.csv").string(),
                      second = (scratch / "2.csv").string(), recording = (scratch / "r.tsrec").string();
    const ProgramResult result = runProgram({kProgram,
                                             "run",
                                             TOUCHSTONE_ASSETS "/moving.glb",
                                             "--headless",
                                             "--seconds",
                                             "6",
                                             "--json",
                                             json,
                                             "--device",
                                             "hand",
                                             "--device",
                                             "hand",
                                             "--stroke",
                                             "press",
                                             "--record-ticks",
                                             first,
                                             "--record-ticks",
                                             second,
                                             "--record",
                                             recording,
                                             "--size",
                                             "160x90"});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto figures = nlohmann::json::parse(readFile(json));
    ASSERT_EQ(figures["hands"].size(), 2u);
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    EXPECT_EQ(figures["locks_in_tick"], kNoLock);
    for (const auto& hand : figures["hands"]) {
        EXPECT_GT(hand["contact"]["ticks"], 50) << hand;
        EXPECT_EQ(hand["flags"]["force_fault"], 0);
        EXPECT_EQ(hand["stroke"], "press");
    }
    EXPECT_EQ(figures["contact"], figures["hands"][0]["contact"]);
    EXPECT_NE(figures["hands"][0]["contact"], figures["hands"][1]["contact"]);
    const Table one = readTable(first), two = readTable(second);
    EXPECT_EQ(one.rows, two.rows);
    const ProgramResult replay = runProgram({kProgram, "replay", recording, "--json", json});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    EXPECT_EQ(nlohmann::json::parse(readFile(json))["hands"], 2);
}

TEST(Run, AnInterruptStillWritesWhatWasAskedFor) {
    const ScratchFolder scratch;
    const std::filesystem::path json = scratch / "r.json", recording = scratch / "r.tsrec";
    BackgroundProgram program({kProgram, "run", kDoughnut, "--headless", "--seconds", "600", "--json",
                               json.string(), "--record", recording.string()},
                              {}, scratch / "log");
    constexpr uintmax_t kSome = 100'000; // bytes: some hundred ticks
    EXPECT_TRUE(eventually([&] {
        std::error_code none;
        const uintmax_t size = std::filesystem::file_size(recording, none);
        return (!none && size > kSome) || !program.running();
    }));
    ASSERT_TRUE(program.running()) << readFile(scratch / "log");
    EXPECT_EQ(program.stop(), 0) << readFile(scratch / "log");
    EXPECT_GT(nlohmann::json::parse(readFile(json))["servo"]["ticks"], 0);
}

} // namespace
} // namespace touchstone::test::run_tests
