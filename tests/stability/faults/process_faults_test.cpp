// Faults of the whole program: stopped for a second, killed while it records, a disk that is full.

#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <thread>

namespace touchstone::test {
namespace {

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

/// Ticks that a recording holds so far, as another process sees it.
std::vector<RecordedTick> ticksOf(const std::filesystem::path& file) {
    std::vector<RecordedTick> ticks;
    if (!std::filesystem::exists(file) || std::filesystem::file_size(file) < kFileHeaderSize)
        return ticks;
    for (RecordedItem& item : itemsOf(file))
        if (auto* block = std::get_if<RecordedTicks>(&item))
            ticks.insert(ticks.end(), block->ticks.begin(), block->ticks.end());
    return ticks;
}

class ProcessFaults : public testing::Test {
  protected:
    [[nodiscard]] std::vector<std::string> run(const std::string& seconds) const {
        return {kProgram,    "run",          kDoughnut,           "--headless",
                "--seconds", seconds,        "--record",          file_.string(),
                "--json",    json_.string(), "--flight-recorder", (scratch_ / "flight").string()};
    }
    /// Waits until the recording has more ticks than `count`.
    void waitForTicks(BackgroundProgram& program, size_t count) {
        for (int i = 0; i < 600 && ticksOf(file_).size() <= count; ++i) {
            ASSERT_TRUE(program.running()) << readFile(scratch_ / "log");
            std::this_thread::sleep_for(std::chrono::milliseconds(100));
        }
        ASSERT_GT(ticksOf(file_).size(), count);
    }
    /// As `replay` sees it: status 0, everything equal.
    nlohmann::json replay(bool cutOff) {
        const std::string answer = (scratch_ / "replay.json").string();
        const ProgramResult result = runProgram({kProgram, "replay", file_.string(), "--json", answer});
        EXPECT_EQ(result.status, 0) << result.out << result.err;
        EXPECT_EQ(result.err.find("is cut off") != std::string::npos, cutOff) << result.err;
        nlohmann::json figures = nlohmann::json::parse(readFile(answer));
        EXPECT_EQ(figures["cut_off"], cutOff);
        EXPECT_EQ(figures["equal"], true);
        return figures;
    }
    /// Of consecutive ticks: what the device was sent never exceeds what it may be sent.
    static void expectWithinLimits(const std::vector<RecordedTick>& ticks) {
        const DeviceLimits limits; // of the simulated hand
        for (size_t i = 0; i < ticks.size(); ++i) {
            ASSERT_LE(glm::length(ticks[i].command), limits.maxForce) << "tick " << i;
            if (i > 0) {
                ASSERT_LE(glm::length(ticks[i].command - ticks[i - 1].command),
                          limits.maxForceRate * ticks[i].dt + 1e-9)
                    << "tick " << i;
            }
        }
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec", json_ = scratch_ / "r.json";
};

TEST_F(ProcessFaults, StoppedForASecondInContact) {
    BackgroundProgram program(run("600"), {}, scratch_ / "log");
    waitForTicks(program, 1000);
    program.send(SIGSTOP);
    std::this_thread::sleep_for(std::chrono::seconds(1));
    program.send(SIGCONT);
    waitForTicks(program, ticksOf(file_).size() + 1000);
    EXPECT_EQ(program.stop(), 0) << readFile(scratch_ / "log");
    const std::vector<RecordedTick> ticks = ticksOf(file_);
    expectWithinLimits(ticks);
    double longest = 0.0;
    for (const RecordedTick& tick : ticks)
        longest = std::max(longest, tick.dt);
    EXPECT_GT(longest, 0.9) << "the second is one tick, told to the step";
    const auto figures = nlohmann::json::parse(readFile(json_));
    EXPECT_EQ(figures["flags"]["force_fault"], 0);
    EXPECT_EQ(replay(false)["ticks"], figures["servo"]["ticks"]);
}

TEST_F(ProcessFaults, KilledWhileItRecords) {
    std::vector<RecordedTick> before;
    {
        BackgroundProgram program(run("600"), {}, scratch_ / "log");
        waitForTicks(program, 2000);
        before = ticksOf(file_);
        program.send(SIGKILL);
        EXPECT_EQ(program.wait(), 128 + SIGKILL);
    }
    const std::vector<RecordedTick> after = ticksOf(file_);
    ASSERT_GE(after.size(), before.size()) << "what had been there is there";
    // A recording grows with every picture: from block to block less than a second.
    size_t largest = 0;
    for (const RecordedItem& item : itemsOf(file_))
        if (const auto* block = std::get_if<RecordedTicks>(&item))
            largest = std::max(largest, block->ticks.size());
    EXPECT_LE(largest, 256u);
    const nlohmann::json figures = replay(true);
    EXPECT_EQ(figures["replayed"], after.size());
    EXPECT_GT(figures["contact"]["ticks"], 100);
    // The flight recorder's files outlived it too; the next start keeps them and says so.
    const ProgramResult next = runProgram({kProgram, "run", kDoughnut, "--headless", "--seconds", "0.5",
                                           "--flight-recorder", (scratch_ / "flight").string()});
    EXPECT_EQ(next.status, 0) << next.err;
    EXPECT_NE(next.err.find("crash-"), std::string::npos) << next.err;
    size_t crashes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(scratch_ / "flight")) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("safety-latched-"))
            continue; // of a machine that is too busy for a kilohertz
        EXPECT_TRUE(name.starts_with("crash-")) << entry.path();
        EXPECT_EQ(runProgram({kProgram, "replay", entry.path().string()}).status, 0);
        ++crashes;
    }
    EXPECT_EQ(crashes, 1u);
}

TEST_F(ProcessFaults, ACrashSaysWhereTheLastSecondsAre) {
    BackgroundProgram program(run("600"), {}, scratch_ / "log");
    waitForTicks(program, 500);
    program.send(SIGSEGV);
    EXPECT_EQ(program.wait(), 128 + SIGSEGV) << "it dies as it would have";
    const std::string said = readFile(scratch_ / "log");
    EXPECT_NE(said.find("touchstone: crashed"), std::string::npos) << said;
    EXPECT_NE(said.find((scratch_ / "flight/live-").string()), std::string::npos) << said;
    EXPECT_NE(said.find("bin/touchstone(+0x"), std::string::npos) << "the calls that led there: " << said;
    replay(true);
}

TEST_F(ProcessFaults, AFileThatMayNotGrowWhileItRecords) {
    std::vector<std::string> arguments = run("3");
    std::string line = "ulimit -f 300; exec";
    for (const std::string& argument : arguments)
        line += " '" + argument + "'";
    const ProgramResult result = runProgram({"bash", "-c", line});
    EXPECT_EQ(result.status, 1) << "the run itself went on to its end";
    EXPECT_NE(result.err.find(file_.string() + ": recording failed"), std::string::npos) << result.err;
    EXPECT_NE(result.err.find("remedy"), std::string::npos) << result.err;
    const auto figures = nlohmann::json::parse(readFile(json_));
    EXPECT_GT(figures["servo"]["ticks"], figures["recording"]["ticks"]);
    EXPECT_GE(figures["recording"]["problems"].size(), 1u);
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    const std::vector<RecordedTick> ticks = ticksOf(file_);
    EXPECT_GT(ticks.size(), 800u) << "what was recorded until then is there: 300 KB of 224 bytes";
    expectWithinLimits(ticks);
    EXPECT_EQ(replay(true)["replayed"], ticks.size());
}

TEST_F(ProcessFaults, AFullDisk) {
    file_ = "/dev/full";
    const ProgramResult result = runProgram(run("1"));
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("/dev/full: recording failed: No space left on device"), std::string::npos)
        << result.err;
    EXPECT_FALSE(std::filesystem::exists(json_)) << "said before it began";
}

} // namespace
} // namespace touchstone::test
