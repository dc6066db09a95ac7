#include "devices/simulated/replay_device.h"
#include "engine/core/error.h"
#include "tests/support/allocation_counter.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace touchstone::replay_device_test {
namespace {

HipPath parsed(const std::string& text) {
    std::istringstream in(text);
    return readHipPath(in, "HIP.csv");
}

/// Expects an Error at `place` whose problem holds `problem`, and that it names the file and a remedy.
void expectRefused(const std::string& text, const std::string& place, const std::string& problem) {
    try {
        (void)parsed(text);
        ADD_FAILURE() << "accepted: " << text;
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), "HIP.csv");
        EXPECT_EQ(error.place(), place) << text;
        EXPECT_NE(error.problem().find(problem), std::string::npos) << error.what();
        EXPECT_FALSE(error.remedy().empty()) << error.what();
    }
}

TEST(HipPath, ReadsColumnsInAnyOrderAndEveryDigit) {
    const HipPath path =
        parsed("x,t,z,y,note\r\n1,0,3,2,a\r\n\r\n+1.5 , 0.001,-3e-3, 0.1000000000000000055,b\r\n");
    ASSERT_EQ(path.times.size(), 2u);
    EXPECT_EQ(path.times[1], 0.001);
    EXPECT_EQ(path.positions[0], glm::dvec3(1, 2, 3));
    EXPECT_EQ(path.positions[1], glm::dvec3(1.5, 0.1, -0.003));
}

TEST(HipPath, ToleratesAByteOrderMarkAndNoFinalNewline) {
    EXPECT_EQ(parsed("\xEF\xBB\xBFt,x,y,z\n0,1,2,3").times.size(), 1u);
}

TEST(HipPath, NamesThePlaceOfWhatItRefuses) {
    expectRefused("", "line 1", "empty");
    expectRefused("t,x,y\n0,1,2\n", "line 1, column z", "header");
    expectRefused("t,x,y,z,x\n0,1,2,3,4\n", "line 1, column x", "twice");
    expectRefused("t,x,y,z\n", "line 1", "no sample");
    expectRefused("t,x,y,z\n0,1,2,3\n0.001,1,2\n", "line 3", "3 values");
    expectRefused("t,x,y,z\n0,1,2,3\n0.001,1,2,3,4\n", "line 3", "5 values");
    expectRefused("t,x,y,z\n0,1,2,3\n0.001,1,deep,3\n", "line 3, column y", "\"deep\" is not a number");
    expectRefused("t,x,y,z\n0,1,2,3\n0.001,1,,3\n", "line 3, column y", "not a number");
    expectRefused("t,x,y,z\n0,1,2,3\n0.001,1,2 3,3\n", "line 3, column y", "not a number");
    expectRefused("t,x,y,z\n0,1,2,3\n\n0.001,1,2,1e999\n", "line 4, column z", "not");
}

TEST(HipPath, RefusesWhatIsNotFinite) {
    for (const char* bad : {"nan", "NaN", "inf", "-inf", "infinity"})
        expectRefused(std::string("t,x,y,z\n0,") + bad + ",2,3\n", "line 2, column x", "not finite");
}

TEST(HipPath, RefusesTimesThatDoNotIncrease) {
    expectRefused("t,x,y,z\n0,1,2,3\n0.002,1,2,3\n0.001,1,2,3\n", "line 4, column t", "does not increase");
    expectRefused("t,x,y,z\n0,1,2,3\n0,1,2,3\n", "line 3, column t", "does not increase");
}

TEST(HipPath, SaysWhenThereIsNoSuchFile) {
    EXPECT_THROW((void)readHipPath(std::filesystem::path("/nowhere/HIP.csv")), Error);
    EXPECT_THROW((void)readHipPath(std::filesystem::temp_directory_path()), Error);
}

TEST(HipPath, ReadsFromAFile) {
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / ("touchstone hip " + std::to_string(::getpid()) + ".csv");
    std::ofstream(file) << "t,x,y,z\n0,1,2,3\n";
    EXPECT_EQ(readHipPath(file).positions.at(0), glm::dvec3(1, 2, 3));
    std::filesystem::remove(file);
}

TEST(ReplayDevice, GoesStraightBetweenSamplesAndRestsAtTheEnds) {
    ReplayDevice replay(parsed("t,x,y,z\n5,0,0,0\n5.001,0.001,0,0\n5.003,0.001,0.004,0\n"));
    EXPECT_NEAR(replay.duration(), 0.003, 1e-12);
    EXPECT_EQ(replay.sample(0.0).position, glm::dvec3(0.0));
    EXPECT_EQ(replay.sample(-1.0).position, glm::dvec3(0.0));
    EXPECT_LT(glm::distance(replay.sample(0.0005).position, glm::dvec3(0.0005, 0, 0)), 1e-12);
    EXPECT_LT(glm::distance(replay.sample(0.002).position, glm::dvec3(0.001, 0.002, 0)), 1e-12);
    EXPECT_EQ(replay.sample(9.0).position, glm::dvec3(0.001, 0.004, 0));
    EXPECT_TRUE(replay.sample(9.0).valid);
}

TEST(ReplayDevice, AllocatesNothing) {
    ReplayDevice replay(parsed("t,x,y,z\n0,0,0,0\n1,1,1,1\n"));
    const uint64_t before = test::allocationsOnThisThread();
    glm::dvec3 sum(0.0);
    for (int tick = 0; tick < 1000; ++tick)
        sum += replay.sample(tick * 0.001).position;
    EXPECT_EQ(test::allocationsOnThisThread(), before);
    EXPECT_NEAR(sum.x, 499.5, 1e-9);
}

} // namespace
} // namespace touchstone::replay_device_test
