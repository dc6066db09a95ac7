// The program on a model whose animation moves objects into a hand that holds still.

#include "tests/support/program.h"
#include "tests/unit/workbench/touch_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::test::moving_scene_tests {
namespace {

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kMoving = TOUCHSTONE_ASSETS "/moving.glb";
constexpr double kLoop = 4.0, kStiffness = 800.0; // s, N/m
constexpr double kRounding = 1e-8;                // m: the file's floats

/// Half the box's height and where its centre is: 40 mm up and down again, at rest at both ends.
constexpr double kHalfHeight = 0.015, kPlateTop = -0.030;
double boxY(double time) {
    const double lap = std::fmod(time, kLoop), s = lap < 2.0 ? lap / 2.0 : (4.0 - lap) / 2.0;
    return -0.010 + 0.040 * s * s * (3.0 - 2.0 * s);
}

/// How far a point is outside of the box at a time; it turns about the vertical once a loop.
double outsideBox(double time, double x, double y, double z) {
    const double turned = -2.0 * std::numbers::pi * time / kLoop, c = std::cos(turned), s = std::sin(turned);
    return std::max({std::abs(c * x + s * z) - 0.030, std::abs(y - boxY(time)) - kHalfHeight,
                     std::abs(c * z - s * x) - 0.020});
}

class MovingScene : public testing::Test {
  protected:
    /// A hand that holds still at one place for two loops.
    Table touchAt(const std::vector<double>& hand, std::vector<std::string> more) {
        writeTextFile(scratch / "hip.csv", straightPath(hand, hand, 8001));
        std::vector<std::string> command{
            kProgram, "touch", kMoving,  "--path", (scratch / "hip.csv").string(),
            "--out",  ticks,   "--json", json};
        for (const std::string& setting : more)
            command.insert(command.end(), {"--set", setting});
        const ProgramResult result = runProgram(command);
        EXPECT_EQ(result.status, 0) << result.err;
        return readTable(ticks);
    }

    ScratchFolder scratch;
    std::string ticks = (scratch / "ticks.csv").string(), json = (scratch / "figures.json").string();
};

TEST_F(MovingScene, ABoxThatRisesTakesTheProxyOfAStillHandOnItsTop) {
    for (const double radius : {0.0, 0.5e-3})
        for (const char* friction : {"off", "zilles"}) {
            SCOPED_TRACE(friction + std::to_string(radius));
            const Table table =
                touchAt({0.012, 0.020, 0.005}, {"proxyRadius=" + std::to_string(radius), "stiffness=800",
                                                std::string("friction=") + friction});
            ASSERT_EQ(table.rows, 8001u);
            double highest = 0.0;
            for (size_t i = 0; i < table.rows; ++i) {
                const double t = table["t"][i], top = boxY(t) + kHalfHeight;
                const double depth = top + radius - 0.020;
                ASSERT_GE(outsideBox(t, table["proxy_x"][i], table["proxy_y"][i], table["proxy_z"][i]),
                          radius - kRounding)
                    << "through the box at " << t << " s";
                ASSERT_EQ(table["contacts"][i] > 0.0, depth > 0.0) << t;
                if (depth > 0.0) { // on the top, over two loops and the seam between them
                    ASSERT_NEAR(table["proxy_y"][i], top + radius, 1e-7) << t;
                    ASSERT_NEAR(table["force_y"][i], kStiffness * depth, kStiffness * 1e-7) << t;
                }
                highest = std::max(highest, depth);
            }
            EXPECT_NEAR(highest, 0.025 + radius, 1e-9) << "the box passes the hand by 25 mm";
            const auto figures = nlohmann::json::parse(readFile(json));
            EXPECT_EQ(figures["flags"]["object_jumped"], 0) << "the loop has no seam";
            EXPECT_EQ(figures["flags"]["pinched"], 0);
            EXPECT_EQ(figures["allocations_in_tick"], 0);
        }
}

TEST_F(MovingScene, ABoxThatTurnsAndSinksOntoAStillHandBesideItGoesThroughNoSurface) {
    for (const double radius : {0.0, 0.5e-3}) {
        // Beside the box at rest; a quarter of a loop later its long side comes by, a half later it is above,
        // then it comes down on the hand.
        const Table table = touchAt({0.004, 0.0, 0.028}, {"proxyRadius=" + std::to_string(radius)});
        size_t beside = 0, below = 0;
        for (size_t i = 0; i < table.rows; ++i) {
            const double t = table["t"][i];
            ASSERT_GE(outsideBox(t, table["proxy_x"][i], table["proxy_y"][i], table["proxy_z"][i]),
                      radius - kRounding)
                << "through the box at " << t << " s";
            ASSERT_GE(table["proxy_y"][i], kPlateTop + radius - kRounding) << "through the plate at " << t;
            beside +=
                table["contacts"][i] > 0.0 && std::hypot(table["force_x"][i], table["force_z"][i]) > 0.5;
            below += table["contacts"][i] > 0.0 && table["force_y"][i] < -0.5;
        }
        EXPECT_GT(beside, 200u);
        EXPECT_GT(below, 200u);
        EXPECT_EQ(table["contacts"].front(), 0.0);
        EXPECT_EQ(nlohmann::json::parse(readFile(json))["flags"]["object_jumped"], 0);
    }
}

TEST_F(MovingScene, RunsWithoutAWindow) {
    const ProgramResult result = runProgram({kProgram, "run", kMoving, "--headless", "--seconds", "3",
                                             "--json", json, "--screenshot", (scratch / "s.png").string()},
                                            {"TOUCHSTONE_VALIDATION=1", "DISPLAY=", "WAYLAND_DISPLAY="});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    EXPECT_EQ(figures["deallocations_in_tick"], 0);
    EXPECT_GT(figures["contact"]["ticks"], 0);
    EXPECT_GE(figures["contact"]["proxy_on_mesh_share"], 0.95);
    EXPECT_EQ(figures["flags"]["object_jumped"], 0);
    EXPECT_EQ(figures["flags"]["force_fault"], 0);
    EXPECT_GT(figures["frames"]["count"], 0);
    EXPECT_EQ(figures["gpu"]["validation_messages"], 0) << result.err;
}

TEST_F(MovingScene, InspectNamesTheAnimation) {
    const ProgramResult result = runProgram({kProgram, "inspect", kMoving});
    EXPECT_EQ(result.status, 0);
    EXPECT_NE(result.out.find("animation 'moving', 4.0 s"), std::string::npos) << result.out;
}

const std::string kBreathing = TOUCHSTONE_ASSETS "/breathing.glb";

TEST_F(MovingScene, AChosenAnimationIsTouchedAndReplayedToTheLastBit) {
    writeTextFile(scratch / "hip.csv", straightPath({-0.062, 0.036, 0.003}, {-0.062, 0.036, 0.003}, 4001));
    const std::string recording = (scratch / "r.tsrec").string();
    std::vector<std::string> proxies;
    for (const char* animation : {"bend and breathe", "1"}) {
        const ProgramResult result =
            runProgram({kProgram, "touch", kBreathing, "--animation", animation, "--set",
                        "animationSpeed=0.75", "--path", (scratch / "hip.csv").string(), "--out", ticks,
                        "--json", json, "--record", recording});
        EXPECT_EQ(result.status, 0) << result.err;
        EXPECT_EQ(result.err.find("only one of"), std::string::npos) << result.err;
        proxies.push_back(readFile(ticks));
        const ProgramResult replay = runProgram({kProgram, "replay", recording});
        EXPECT_EQ(replay.status, 0) << replay.err;
        EXPECT_NE(replay.out.find("all equal"), std::string::npos) << replay.out;
    }
    EXPECT_NE(proxies[0], proxies[1]);
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(figures["flags"]["pinched"], 0);
    EXPECT_EQ(figures["flags"]["force_fault"], 0);
}

TEST_F(MovingScene, ARunOnDeformingMeshesAllocatesNothingInItsTicksAndIsReplayed) {
    const std::string recording = (scratch / "r.tsrec").string();
    const ProgramResult result =
        runProgram({kProgram, "run", kBreathing, "--seconds", "2", "--json", json, "--record", recording,
                    "--screenshot", (scratch / "p.png").string()},
                   {"TOUCHSTONE_VALIDATION=1", "DISPLAY=", "WAYLAND_DISPLAY="});
    EXPECT_EQ(result.status, 0) << result.err;
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    EXPECT_EQ(figures["deallocations_in_tick"], 0);
    EXPECT_EQ(figures["gpu"]["validation_messages"], 0) << result.err;
    const ProgramResult replay = runProgram({kProgram, "replay", recording});
    EXPECT_EQ(replay.status, 0) << replay.err << replay.out;
}

TEST_F(MovingScene, AnAnimationThatIsNotThereIsRefusedWithThoseThatAre) {
    const ProgramResult result = runProgram({kProgram, "inspect", kBreathing, "--animation", "walk"});
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("0 'bend and breathe', 1 'twist'"), std::string::npos) << result.err;
    EXPECT_NE(runProgram({kProgram, "inspect", kBreathing}).out.find("number 1, deforms 1 meshes"),
              std::string::npos);
}

} // namespace
} // namespace touchstone::test::moving_scene_tests
