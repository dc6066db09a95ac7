// What the window keeps: all of it comes back, and nothing that a broken file holds can harm.

#include "tests/support/program.h"
#include "workbench/window/window_memory.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <string>
#include <vector>

namespace touchstone::test::window_memory_tests {
namespace {

class WindowMemoryTest : public testing::Test {
  protected:
    WindowMemory readOf(const std::string& text) {
        std::ofstream(file_) << text;
        return readMemory(file_);
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "a/window.json";
};

TEST_F(WindowMemoryTest, ComesBackAsItWasButForTheForceSwitch) {
    WindowMemory memory;
    ASSERT_EQ(setSetting(memory.settings, "proxyRadius", "0.00125"), "");
    ASSERT_EQ(setSetting(memory.settings, "friction", "ho"), "");
    memory.settings.forceEnabled = false;
    memory.folds = {.left = true,
                    .right = false,
                    .bottom = true,
                    .leftWidth = 300.25f,
                    .rightWidth = 401.0f,
                    .bottomHeight = 321.5f};
    memory.charts = {false, true, false, true, true, false, false, false, true};
    memory.sound = {true, 0.25f};
    memory.uiScale = 1.37f;
    memory.introduced = true;
    memory.size = {1111, 777};
    memory.recent = {"/models/a b.glb", "/models/\u00e4.gltf"};
    ASSERT_TRUE(writeMemory(file_, memory)) << "its folder is made";
    memory.settings.forceEnabled = true;
    EXPECT_EQ(readMemory(file_), memory);
}

TEST_F(WindowMemoryTest, IsTheUsualOneWhereTheFileSaysNothing) {
    EXPECT_EQ(readMemory(file_), WindowMemory{}) << "not there";
    std::filesystem::create_directories(file_.parent_path());
    for (const char* text : {"", "{", "[1,2]", "null", "\xff\xfe", "{\"version\": 2, \"introduced\": true}",
                             "{\"introduced\": true}", "{\"version\": \"1\"}"})
        EXPECT_EQ(readOf(text), WindowMemory{}) << text;
}

TEST_F(WindowMemoryTest, KeepsWhatIsRightBesideWhatIsWrong) {
    std::filesystem::create_directories(file_.parent_path());
    const WindowMemory memory = readOf(
        "{\"version\": 1, \"introduced\": 3, \"folded\": {\"scene\": true, \"felt\": \"yes\"}, \"size\": "
        "[1e9, -4], "
        "\"charts\": [\"magic\", 3], \"charts_height\": -1e9, \"scene_width\": 12, \"felt_width\": \"wide\", "
        "\"sound\": {\"on\": 1, \"volume\": 7}, \"recent\": [7, \"/a.glb\", null], \"settings\": "
        "{\"friction\": \"ho\", \"stiffness\": \"-5\", "
        "\"proxyRadius\": 0.1, \"magic\": \"on\"}}");
    EXPECT_FALSE(memory.introduced);
    EXPECT_EQ(memory.folds, (PanelFolds{.left = true}));
    EXPECT_EQ(memory.charts, kFirstQuantities) << "none of them is known";
    EXPECT_EQ(readOf("{\"version\": 1, \"charts\": [\"x\", \"magic\", 3]}").charts,
              (ShownQuantities{0, 0, 0, 1}));
    EXPECT_EQ(memory.sound, (SoundChoice{false, 1.0f}));
    EXPECT_EQ(memory.size, glm::ivec2(0)) << "no whole numbers";
    EXPECT_EQ(memory.recent, std::vector<std::filesystem::path>{"/a.glb"});
    EXPECT_EQ(memory.settings.friction, FrictionMode::Ho);
    EXPECT_EQ(memory.settings.stiffness, HapticSettings{}.stiffness);
    EXPECT_EQ(memory.settings.proxyRadius, HapticSettings{}.proxyRadius);
    EXPECT_EQ(readOf("{\"version\": 1, \"size\": [99999999, 5]}").size, glm::ivec2(16384, 320));
    EXPECT_EQ(readOf("{\"version\": 1, \"size\": [99999999999999, 700]}").size.y, 700);
}

TEST_F(WindowMemoryTest, WarnsOfAFileThatItDoesNotTake) {
    std::filesystem::create_directories(file_.parent_path());
    const auto warningOf = [&](const std::string& text) {
        std::ofstream(file_) << text;
        std::string warning;
        (void)readMemory(file_, &warning);
        return warning;
    };
    EXPECT_EQ(warningOf(R"({"version": 1, "ui_scale": 1.5})"), "");
    EXPECT_NE(warningOf(R"({"version": 7, "ui_scale": 2})").find("its version is 7, not 1"),
              std::string::npos);
    EXPECT_NE(warningOf(R"({"version": 1e300})").find("its version is"), std::string::npos);
    EXPECT_NE(warningOf(R"({"ui_scale": 2})").find("no version"), std::string::npos);
    EXPECT_NE(warningOf("[1]").find("no version"), std::string::npos);
    EXPECT_NE(warningOf("{ \"version\": 1, \"folded\"").find("cannot be read"), std::string::npos);
    std::filesystem::remove(file_);
    std::string warning;
    (void)readMemory(file_, &warning);
    EXPECT_EQ(warning, "") << "the first run";
}

TEST_F(WindowMemoryTest, ClampsAnAbsurdUiScaleAndWarns) {
    std::filesystem::create_directories(file_.parent_path());
    for (const auto& [text, scale] :
         {std::pair("0", 0.75f), std::pair("-1", 0.75f), std::pair("1e9", 4.0f), std::pair("1e999", 4.0f),
          std::pair("null", 1.0f), std::pair("\"2\"", 1.0f), std::pair("[2]", 1.0f)}) {
        std::ofstream(file_) << R"({"version": 1, "introduced": true, "ui_scale": )" << text << "}";
        std::string warning;
        const WindowMemory memory = readMemory(file_, &warning);
        EXPECT_NE(warning, "") << text;
        if (std::string_view(text) == "1e999") // the reader refuses the number and with it the file
            continue;
        EXPECT_EQ(memory.uiScale, scale) << text;
        EXPECT_TRUE(memory.introduced) << text;
    }
}

TEST_F(WindowMemoryTest, NamesEachFileOnceNewestFirst) {
    WindowMemory memory;
    for (int i = 0; i < 20; ++i)
        memory.opened("/m" + std::to_string(i));
    memory.opened("/m15");
    ASSERT_EQ(memory.recent.size(), WindowMemory::kMaxRecent);
    EXPECT_EQ(memory.recent[0], "/m15");
    EXPECT_EQ(memory.recent[1], "/m19");
    EXPECT_EQ(std::ranges::count(memory.recent, std::filesystem::path("/m15")), 1);
}

} // namespace
} // namespace touchstone::test::window_memory_tests
