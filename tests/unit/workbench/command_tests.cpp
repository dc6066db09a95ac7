// The command line as a user meets it: what it promises, what it refuses and with which words.

#include "tests/support/program.h"
#include "tests/unit/workbench/touch_files.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>

namespace touchstone::test::command_tests {
namespace {

namespace fs = std::filesystem;

const std::string kProgram = TOUCHSTONE_BINARY;
const std::string kPlane = TOUCHSTONE_ASSETS "/plane.glb";
const std::string kBox = TOUCHSTONE_ASSETS "/box.glb";
const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

/// A refusal: this status, a message on stderr with all these words, nothing on stdout.
void expectRefused(const ProgramResult& result, int status, const std::vector<std::string>& words) {
    EXPECT_EQ(result.status, status) << result.err;
    EXPECT_TRUE(result.out.empty()) << result.out;
    for (const std::string& word : words)
        EXPECT_TRUE(contains(result.err, word)) << "'" << word << "' is not in: " << result.err;
}

TEST(CommandLine, HelpNamesEveryCommandOptionAndSetting) {
    const ProgramResult result = runProgram({kProgram, "--help"});
    EXPECT_EQ(result.status, 0);
    EXPECT_TRUE(result.err.empty());
    for (const char* word :
         {"run",           "touch",         "render",         "inspect",         "devices",
          "--headless",    "bench",         "--largest",      "--check",         "--seconds",
          "--json",        "--screenshot",  "--record-ticks", "--path",          "--out",
          "--fit",         "--set",         "--size",         "--view",          "--hand",
          "--rate",        "--version",     "forceShading",   "friction",        "texture",
          "proxyRadius",   "stiffness",     "damping",        "iterationBudget", "forceEnabled",
          "--closed-loop", "--open-loop",   "--plant",        "study",           "--shard",
          "--ladder",      "compare",       "merge",          "--camera",        "--from",
          "--look-at",     "--picture-size"})
        EXPECT_TRUE(contains(result.out, word)) << word;
}

TEST(CommandLine, EveryCommandHasItsOwnHelp) {
    for (const char* command : {"run", "touch", "render", "inspect", "bench", "study", "devices"}) {
        const ProgramResult result = runProgram({kProgram, command, "--help"});
        EXPECT_EQ(result.status, 0) << command;
        EXPECT_FALSE(result.out.empty()) << command;
    }
    EXPECT_TRUE(contains(runProgram({kProgram, "touch", "--help"}).out, "proxyRadius"));
    EXPECT_TRUE(contains(runProgram({kProgram, "study", "merge", "--help"}).out,
                         "Usage: touchstone study merge [OPTIONS] PART..."));
    EXPECT_FALSE(contains(runProgram({kProgram, "bench", "--help"}).out, "--set")) << "it takes none";
}

TEST(CommandLine, SaysItsVersion) {
    EXPECT_EQ(runProgram({kProgram, "--version"}).out.substr(0, 11), "touchstone ");
}

TEST(CommandLine, WrongUsageIsStatusTwoWithARemedy) {
    const std::vector<std::vector<std::string>> wrong{
        {"--nonsense"},
        {"run"},
        {"run", kPlane, "--seconds", "soon"},
        {"run", kPlane, "--screenshot", "a.bmp"},
        {"run", kPlane, "--headless", "--seconds", "soon"},
        {"run", kPlane, "--headless", "--seconds", "-1"},
        {"run", kPlane, "--headless", "--rate", "50"},
        {"touch", kPlane},
        {"touch", kPlane, "--path", "a.csv", "--out", "b.csv", "--fit", "sideways"},
        {"touch", kPlane, "--path", "a.csv", "--stroke", "tap", "--out", "b.csv"},
        {"touch", kPlane, "--path", "a.csv", "--stroke-depth", "0.001", "--out", "b.csv"},
        {"touch", kPlane, "--stroke", "tap", "--stroke-speed", "5", "--out", "b.csv"},
        {"touch", kPlane, "--path", "a.csv", "--out", "b.csv", "--set", "stiffness"},
        {"touch", kPlane, "--path", "a.csv", "--out", "b.csv", "--set", "stiffness=soft"},
        {"touch", kPlane, "--path", "a.csv", "--out", "b.csv", "--set", "nothing=1"},
        {"touch", kPlane, "--path", "a.csv", "--out", "b.csv", "--plant", "mass=0.1"},
        {"touch", kPlane, "--path", "a.csv", "--out", "b.csv", "--closed-loop", "--plant", "mass=0"},
        {"touch", kPlane, "--path", "a.csv", "--out", "b.csv", "--closed-loop", "--plant", "delay=0.5"},
        {"touch", kPlane, "--path", "a.csv", "--out", "b.csv", "--closed-loop", "--plant", "weight=1"},
        {"run", kPlane, "--headless", "--open-loop", "--plant", "mass=0.1"},
        {"run", kPlane, "--headless", "--device", "udp", "--plant", "mass=0.1"},
        {"run", kPlane, "--headless", "--device", "udp", "--open-loop"},
        {"run", kPlane, "--headless", "--device", "udp", "--device", "udp"},
        {"run", kPlane, "--headless", "--device", "udp", "--device", "auto"},
        {"run", kPlane, "--headless", "--device", "hand", "--device", "hand", "--device", "hand", "--device",
         "hand", "--device", "hand"},
        {"run", kPlane, "--headless", "--record-ticks", "a", "--record-ticks", "b"},
        {"run", kPlane, "--headless", "--device", "hand", "--device", "hand", "--record-ticks", "a",
         "--record-ticks", "a"},
        {"render", kPlane},
        {"render", kPlane, "--out", "a.png", "--size", "640"},
        {"render", kPlane, "--out", "a.png", "--size", "0x480"},
        {"render", kPlane, "--out", "a.png", "--size", "640x480x"},
        {"render", kPlane, "--out", "a.png", "--size", "-640x480"},
        {"render", kPlane, "--out", "a.png", "--size", "100000x100000"},
        {"render", kPlane, "--out", "a.png", "--size", "16384x16384"},
        {"render", kPlane, "--out", "a.png", "--view", "smell"},
        {"render", kPlane, "--out", "a.gif"},
        {"render", kPlane, "--out", "a"},
        {"render", kPlane, "--out", "a.png", "--from", "within"},
        {"render", kPlane, "--out", "a.png", "--from", "top", "--camera", "0"},
        {"render", kPlane, "--out", "a.png", "--from", "top", "--camera-position", "1,1,1"},
        {"render", kPlane, "--out", "a.png", "--camera", "0", "--fov", "40"},
        {"render", kPlane, "--out", "a.png", "--fov", "0"},
        {"render", kPlane, "--out", "a.png", "--fov", "180"},
        {"render", kPlane, "--out", "a.png", "--fov", "nan"},
        {"render", kPlane, "--out", "a.png", "--look-at", "0,0,0"},
        {"render", kPlane, "--out", "a.png", "--camera-position", "1,2"},
        {"render", kPlane, "--out", "a.png", "--camera-position", "1,2,3,4"},
        {"render", kPlane, "--out", "a.png", "--camera-position", "1,2,inf"},
        {"render", kPlane, "--out", "a.png", "--camera-position", "1,2,three"},
        {"render", kPlane, "--out", "a.png", "--camera-position", "1,2,3", "--look-at", "1,2,3"},
        {"render", kPlane, "--out", "a.png", "--camera-position", "1,2,3", "--look-at", "0,0,0", "--up",
         "2,4,6"},
        {"render", kPlane, "--out", "a.png", "--camera-position", "1,2,3", "--look-at", "0,0,0", "--up",
         "0,0,0"},
        {"edit", kPlane, "--field", "stiffness=-3"},
        {"edit", kPlane, "--field", "stiffness=hard"},
        {"edit", kPlane, "--field", "stiffness=nan"},
        {"edit", kPlane, "--field", "forceShading=sometimes"},
        {"edit", kPlane, "--field", "smell=1"},
        {kPlane, "--picture-size", "0x0"},
        {"inspect"},
        {kPlane, kPlane},
    };
    for (std::vector<std::string> arguments : wrong) {
        arguments.insert(arguments.begin(), kProgram);
        expectRefused(runProgram(arguments), 2, {"touchstone: ", "--help"});
    }
}

// CLI::Range passes NaN, which is neither below nor above: `devices --force nan` would have pushed with it.
TEST(CommandLine, NoOptionTakesNaN) {
    const std::vector<std::vector<std::string>> commands{
        {"devices", "--test", "mouse", "--force", "nan"},
        {"devices", "--test", "mouse", "--seconds", "nan"},
        {"run", kPlane, "--headless", "--seconds", "nan"},
        {"run", kPlane, "--headless", "--rate", "nan"},
        {"touch", kPlane, "--out", "a", "--stroke", "circle", "--speed", "nan"},
        {"touch", kPlane, "--out", "a", "--stroke", "circle", "--depth", "NAN"},
        {"touch", kPlane, "--out", "a", "--stroke", "circle", "--sculpt", "carve", "--sculpt-radius", "nan"},
        {"touch", kPlane, "--out", "a", "--stroke", "circle", "--set", "maxForce=nan"},
        {"render", kPlane, "--out", "a.png", "--fov", "nan"},
        {"bench", "--seconds", "nan"},
        {"simplify", kPlane, "--threshold", "nan"},
        {"serve", "--rate", "nan"},
        {"serve", "--control", "nan"},
        {"serve", "--goal-power", "nan"}};
    for (const std::vector<std::string>& command : commands) {
        std::vector<std::string> arguments{kProgram};
        arguments.insert(arguments.end(), command.begin(), command.end());
        const ProgramResult result = runProgram(arguments);
        EXPECT_EQ(result.status, 2) << command[0] << ' ' << command[command.size() - 2] << ": " << result.err;
    }
}

TEST(CommandLine, AWrongEndingIsToldWithThoseThatAreWritten) {
    expectRefused(runProgram({kProgram, "render", kPlane, "--out", "a.gif"}), 2,
                  {"a.gif", ".png", ".jpg", ".jpeg"});
    expectRefused(runProgram({kProgram, "edit", kPlane, "--field", "stiffness=-3"}), 2,
                  {"stiffness", "-3", "range"});
}

TEST(CommandLine, AWrongSettingIsToldWithWhatIsAllowed) {
    const auto refuse = [](const std::string& assignment) {
        return runProgram({kProgram, "touch", kPlane, "--path", "a", "--out", "b", "--set", assignment}).err;
    };
    EXPECT_TRUE(contains(refuse("friction=sticky"), "zilles"));
    EXPECT_TRUE(contains(refuse("colour=red"), "proxyRadius"));
}

TEST(CommandLine, BadInputIsStatusOneAndNamesTheFile) {
    const ScratchFolder scratch;
    const std::string missing = (scratch / "missing.glb").string();
    const std::string text = (scratch / "notes.glb").string();
    const std::string empty = (scratch / "empty.glb").string();
    const std::string picture = (scratch / "out.png").string();
    writeTextFile(text, "this is not a model\n");
    writeTextFile(empty, "");
    for (const std::string& bad : {missing, text, empty, scratch.path().string()}) {
        expectRefused(runProgram({kProgram, "inspect", bad}), 1, {"touchstone: ", bad});
        expectRefused(runProgram({kProgram, "render", bad, "--out", picture}), 1, {bad});
        expectRefused(runProgram({kProgram, "run", bad, "--headless", "--seconds", "1"}), 1, {bad});
    }
    EXPECT_FALSE(fs::exists(picture));
}

TEST(CommandLine, ATruncatedModelIsRefused) {
    const ScratchFolder scratch;
    const std::string whole = readFile(kBox);
    for (const size_t length : {size_t{3}, size_t{12}, size_t{40}, whole.size() / 2, whole.size() - 1}) {
        const std::string cut = (scratch / "cut.glb").string();
        writeTextFile(cut, whole.substr(0, length));
        expectRefused(runProgram({kProgram, "inspect", cut}), 1, {cut});
    }
}

TEST(Window, WithoutADisplayItNamesTheHeadlessCommand) {
    expectRefused(runProgram({kProgram, kPlane}, {"DISPLAY=", "WAYLAND_DISPLAY="}), 1,
                  {"display", "touchstone run SCENE"});
    expectRefused(runProgram({kProgram, kPlane}, {"DISPLAY=:987", "WAYLAND_DISPLAY="}), 1,
                  {"touchstone run"});
}

/// What is wrong with the command line is said first, whether there is a display or not.
TEST(Window, AMissingFileOrDeviceIsToldWithoutADisplayToo) {
    const ScratchFolder scratch;
    const std::string missing = (scratch / "missing.glb").string();
    for (const char* display : {"DISPLAY=", "DISPLAY=:987"}) {
        const ProgramResult result = runProgram({kProgram, missing}, {display, "WAYLAND_DISPLAY="});
        expectRefused(result, 1, {missing, "no such file"});
        EXPECT_FALSE(contains(result.err, "display")) << result.err;
        expectRefused(runProgram({kProgram, scratch.path().string()}, {display, "WAYLAND_DISPLAY="}), 1,
                      {"is not a file"});
        expectRefused(runProgram({kProgram, kPlane, "--device", "nosuch"}, {display, "WAYLAND_DISPLAY="}), 1,
                      {"nosuch", "mouse", "hand", "udp", "WoodenHaptics", "touchstone devices"});
    }
}

TEST(CommandLine, AnUnknownDeviceIsToldWithWhatThereIs) {
    expectRefused(runProgram({kProgram, "run", kPlane, "--seconds", "1", "--device", "nosuch"}), 1,
                  {"nosuch", "hand (the simulated one)", "udp", "WoodenHaptics", "touchstone devices"});
    expectRefused(runProgram({kProgram, "run", kPlane, "--seconds", "1", "--device", "/dev/hidraw987"}), 1,
                  {"/dev/hidraw987", "no such HID node", "udp"});
    expectRefused(runProgram({kProgram, "devices", "--test", "nosuch"}), 1,
                  {"nosuch", "udp", "WoodenHaptics"});
}

TEST(Gpu, WithoutAVulkanDeviceItNamesThePackage) {
    const ScratchFolder scratch;
    const std::string picture = (scratch / "out.png").string();
    expectRefused(runProgram({kProgram, "render", kPlane, "--out", picture},
                             {"VK_ICD_FILENAMES=/nowhere.json", "VK_DRIVER_FILES=/nowhere.json"}),
                  1, {"Vulkan", "mesa-vulkan-drivers"});
    EXPECT_FALSE(fs::exists(picture));
}

/// A panorama of `height` rows in Radiance's format without run lengths: light from above.
std::string skyPanorama(int height) {
    std::string file = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
                       std::to_string(2 * height) + "\n";
    for (int row = 0; row < height; ++row)
        for (int column = 0; column < 2 * height; ++column)
            file +=
                2 * row < height ? std::string("\xff\x80\x20\x83", 4) : std::string("\x08\x08\x08\x80", 4);
    return file;
}

TEST(Gpu, AnEnvironmentFileLightsThePicture) {
    const ScratchFolder scratch;
    const std::string sky = (scratch / "sky.hdr").string(), picture = (scratch / "out.png").string();
    const std::string materials = TOUCHSTONE_ASSETS "/materials.glb";
    const auto rendered = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{kProgram, "render", materials, "--out", picture, "--size", "160x120"};
        words.insert(words.end(), more.begin(), more.end());
        const ProgramResult result = runProgram(words);
        EXPECT_EQ(result.status, 0) << result.err;
        return readFile(picture);
    };
    writeTextFile(sky, skyPanorama(16));
    const std::string plain = rendered({}), lit = rendered({"--environment", sky});
    EXPECT_EQ(rendered({}), plain);
    EXPECT_NE(lit, plain);
    EXPECT_EQ(rendered({"--environment", sky}), lit);

    // A file that is missing or no panorama: no picture in another light than was asked for.
    writeTextFile(sky, skyPanorama(16).substr(0, 60));
    fs::remove(picture);
    for (const std::string& bad : {sky, (scratch / "none.exr").string(), kBox})
        expectRefused(runProgram({kProgram, "render", materials, "--out", picture, "--environment", bad}), 1,
                      {bad});
    EXPECT_FALSE(fs::exists(picture));
}

class Touch : public testing::Test {
  protected:
    std::string path(const std::string& csv) {
        writeTextFile(scratch / "hip.csv", csv);
        return (scratch / "hip.csv").string();
    }
    std::string out() { return (scratch / "ticks.csv").string(); }
    ProgramResult touch(const std::string& scene, const std::string& csv,
                        const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments{kProgram, "touch", scene, "--path", path(csv), "--out", out()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return runProgram(arguments);
    }

    ScratchFolder scratch;
};

/// `rows` of a way along x, `interval` s apart, 5 mm from row to row and back again.
std::string sparsePath(int rows, double interval) {
    std::string csv = "t,x,y,z\n";
    for (int row = 0; row < rows; ++row)
        csv +=
            std::to_string(interval * row) + "," + std::to_string(0.01 + 0.005 * (row % 2)) + ",0.01,0.02\n";
    return csv;
}

TEST_F(Touch, APathOfTenRowsASecondIsDoneWithAWarning) {
    const ProgramResult sparse =
        touch(kPlane, sparsePath(11, 0.1), {"--json", (scratch / "f.json").string()});
    EXPECT_EQ(sparse.status, 0);
    for (const char* words : {"10 rows a second", "100 ms", "5 mm", "--rate 1000", "1000 Hz"})
        EXPECT_TRUE(contains(sparse.err, words)) << words << " is not in: " << sparse.err;
    EXPECT_NEAR(nlohmann::json::parse(readFile(scratch / "f.json"))["path_rate_hz"].get<double>(), 10.0,
                1e-9);
    EXPECT_EQ(readTable(out()).rows, 11u);

    const ProgramResult resampled = touch(kPlane, sparsePath(11, 0.1), {"--rate", "1000"});
    EXPECT_EQ(resampled.status, 0);
    for (const char* words : {"10 rows a second", "straight", "0.1 m/s"}) // from 0.05 to -0.05 m/s
        EXPECT_TRUE(contains(resampled.err, words)) << words << " is not in: " << resampled.err;
    EXPECT_EQ(readTable(out()).rows, 1001u);
    // Halfway between two rows the hand is halfway.
    EXPECT_NEAR(readTable(out())["hip_x"][50], 0.0125, 1e-12);

    EXPECT_EQ(touch(kPlane, sparsePath(11, 0.01)).err, "") << "100 rows a second are enough";
    EXPECT_EQ(touch(kPlane, sparsePath(1, 0.1)).err, "") << "a single row has no rate";
}

/// Straight down onto the plane y = 0 and 2 mm into it.
const std::string kDown = straightPath({0.01, 0.01, 0.02}, {0.01, -0.002, 0.02}, 400);

TEST_F(Touch, WritesTheColumnsOfTheDesignOneRowATick) {
    ASSERT_EQ(touch(kPlane, kDown).status, 0);
    const Table ticks = readTable(out());
    const std::vector<std::string> expected{"t",        "hip_x",     "hip_y",          "hip_z",
                                            "proxy_x",  "proxy_y",   "proxy_z",        "normal_x",
                                            "normal_y", "normal_z",  "force_x",        "force_y",
                                            "force_z",  "contacts",  "friction_state", "penetration",
                                            "step_ns",  "command_x", "command_y",      "command_z"};
    EXPECT_EQ(ticks.names, expected);
    EXPECT_EQ(ticks.rows, 400u);
    EXPECT_EQ(ticks["t"][399], 0.399);
    EXPECT_EQ(ticks["hip_y"][399], -0.002) << "full precision";
}

TEST_F(Touch, StrokesInPlaceOfAPath) {
    const auto stroke = [&](const std::string& name) {
        return runProgram({kProgram, "touch", kPlane, "--stroke", name, "--stroke-depth", "0.002", "--fit",
                           "workspace", "--set", "friction=off", "--set", "texture=off", "--out", out()});
    };
    for (const char* name :
         {"tour", "press", "tap", "slide", "circle", "zigzag", "spiral", "hold", "edge", "fast"}) {
        ASSERT_EQ(stroke(name).status, 0) << name;
        const std::vector<double> depth = readTable(out())["penetration"];
        EXPECT_NEAR(*std::ranges::max_element(depth), 0.002, 1e-4) << name;
        EXPECT_EQ(depth.front(), 0.0) << name;
    }
    expectRefused(stroke("caress"), 2, {"caress", "zigzag", "--help"});
}

TEST_F(Touch, OnAPlaneTheForceIsStiffnessTimesDepthAlongTheNormal) {
    constexpr double kRadius = 0.5e-3, kStiffness = 800.0;
    ASSERT_EQ(touch(kPlane, kDown,
                    {"--set", "stiffness=800", "--set", "friction=off", "--set", "proxyRadius=0.0005"})
                  .status,
              0);
    const Table ticks = readTable(out());
    size_t contacts = 0;
    for (size_t i = 0; i < ticks.rows; ++i) {
        const double depth = kRadius - ticks["hip_y"][i]; // the sphere rests kRadius above the plane
        if (depth < 1e-7) {
            EXPECT_EQ(ticks["contacts"][i], 0.0);
            EXPECT_EQ(ticks["force_y"][i], 0.0);
            EXPECT_EQ(ticks["normal_y"][i], 0.0);
            continue;
        }
        ++contacts;
        EXPECT_EQ(ticks["contacts"][i] > 0.0, true) << i;
        EXPECT_NEAR(ticks["force_y"][i], kStiffness * depth, kStiffness * 1e-8);
        EXPECT_NEAR(ticks["force_x"][i], 0.0, 1e-7);
        EXPECT_NEAR(ticks["force_z"][i], 0.0, 1e-7);
        EXPECT_NEAR(ticks["proxy_y"][i], kRadius, 1e-8);
        EXPECT_NEAR(ticks["penetration"][i], depth, 1e-8);
        EXPECT_NEAR(ticks["normal_y"][i], 1.0, 1e-9);
    }
    EXPECT_GT(contacts, 50u);
    EXPECT_NEAR(ticks["command_y"][399], ticks["force_y"][399], 1e-12)
        << "faded in long ago, within the limits";
}

TEST_F(Touch, InTheClosedLoopTheHandYieldsAsTwoSpringsSay) {
    // The path stops 2 mm under the plane. What the hand's spring and the wall's share is known; the sensor
    // sees it in its own steps, and friction is off so that the device comes to rest there.
    std::string csv = kDown;
    for (int tick = 400; tick < 1400; ++tick)
        csv += std::to_string(1e-3 * tick) + ",0.01,-0.002,0.02\n";
    const std::vector<std::string> options{"--closed-loop",
                                           "--plant",
                                           "coulombFriction=0",
                                           "--plant",
                                           "handStiffness=400",
                                           "--plant",
                                           "handDamping=12",
                                           "--plant",
                                           "resolution=0",
                                           "--set",
                                           "stiffness=800",
                                           "--json",
                                           (scratch / "f.json").string()};
    ASSERT_EQ(touch(kPlane, csv, options).status, 0);
    const Table ticks = readTable(out());
    const double depth = 0.002 * 400.0 / (400.0 + 800.0);
    EXPECT_NEAR(ticks["hip_y"][1399], -depth, 1.1e-7) << "but for the contact gap";
    EXPECT_NEAR(ticks["command_y"][1399], 800.0 * depth, 400.0 * 1.1e-7);
    const auto json = nlohmann::json::parse(readFile(scratch / "f.json"));
    EXPECT_EQ(json["loop"]["handStiffness"], 400.0);
    EXPECT_NEAR(json["loop"]["motor_work_j"].get<double>(), json["energy"]["command_given_j"].get<double>(),
                1e-12);
    const std::string first = readFile(out());
    ASSERT_EQ(touch(kPlane, csv, options).status, 0);
    EXPECT_EQ(withoutColumn(first, "step_ns"), withoutColumn(readFile(out()), "step_ns"));
}

TEST_F(Touch, TwoRunsAreByteIdenticalButForTheTime) {
    const std::string over = straightPath({-0.07, 0.03, 0.0}, {0.07, 0.008, 0.01}, 2000);
    ASSERT_EQ(touch(kDoughnut, over).status, 0);
    const std::string first = readFile(out());
    ASSERT_EQ(touch(kDoughnut, over).status, 0);
    EXPECT_EQ(withoutColumn(first, "step_ns"), withoutColumn(readFile(out()), "step_ns"));
    const Table ticks = readTable(out());
    double most = 0.0;
    for (const double contacts : ticks["contacts"])
        most = std::max(most, contacts);
    EXPECT_GT(most, 0.0) << "the path must touch for this to mean anything";
}

TEST_F(Touch, TheNeighbourhoodWatchIsAPointAndSaysSo) {
    const std::string json = (scratch / "figures.json").string();
    const ProgramResult result = touch(kPlane, kDown,
                                       {"--json", json, "--set", "contact=neighbourhood", "--set",
                                        "proxyRadius=0.001", "--set", "stiffness=800"});
    ASSERT_EQ(result.status, 0);
    EXPECT_TRUE(contains(result.err, "proxyRadius is ignored")) << result.err;
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(figures["settings"]["contact"], "neighbourhood");
    EXPECT_EQ(figures["setting_warnings"].size(), 1u);
    EXPECT_EQ(figures["flags"]["neighbourhood_missing"], 0);
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    EXPECT_EQ(figures["contact"]["proxy_on_mesh_share"], 1.0);
    const Table ticks = readTable(out());
    for (size_t i = 0; i < ticks.rows; ++i) {
        const double depth = -ticks["hip_y"][i]; // of a point, not of a sphere
        EXPECT_EQ(ticks["contacts"][i], depth > 0.0 ? 1.0 : 0.0) << i;
        EXPECT_NEAR(ticks["force_y"][i], 800.0 * std::max(depth, 0.0), 1e-9) << i;
    }
}

TEST_F(Touch, ReportsStepAndRayFloor) {
    const std::string json = (scratch / "figures.json").string();
    ASSERT_EQ(touch(kPlane, kDown, {"--json", json, "--set", "proxyRadius=0.001"}).status, 0);
    const auto figures = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(figures["ticks"], 400);
    EXPECT_EQ(figures["settings"]["proxyRadius"], "0.001");
    EXPECT_GT(figures["step"]["p50_ns"], 0);
    EXPECT_GE(figures["step"]["p99_ns"], figures["step"]["p50_ns"]);
    EXPECT_EQ(figures["step"]["count"], figures["contact"]["ticks"]);
    EXPECT_EQ(figures["step"]["all"]["count"], 400);
    EXPECT_GT(figures["ray_floor"]["p50_ns"], 0);
    EXPECT_EQ(figures["ray_floor"]["count"], figures["contact"]["ticks"]);
    EXPECT_EQ(figures["allocations_in_tick"], 0);
    EXPECT_EQ(figures["deallocations_in_tick"], 0);
    EXPECT_GE(figures["contact"]["proxy_on_mesh_share"], 0.99);
}

TEST_F(Touch, FitPutsTheModelIntoTheWorkspace) {
    // table1_object1 is a box of 0.1 m: fitted, its longest side is 0.15 m.
    const std::string box = TOUCHSTONE_ASSETS "/table1_object1.glb";
    const std::string down = straightPath({0.0, 0.09, 0.0}, {0.0, 0.06, 0.0}, 300);
    const auto firstContact = [&](const std::vector<std::string>& more) {
        EXPECT_EQ(touch(box, down, more).status, 0);
        const Table ticks = readTable(out());
        for (size_t i = 0; i < ticks.rows; ++i)
            if (ticks["contacts"][i] > 0.0)
                return ticks["hip_y"][i];
        return 0.0;
    };
    EXPECT_NEAR(firstContact({"--fit", "workspace"}), 0.075, 2e-4);
    EXPECT_EQ(firstContact({"--fit", "none"}), 0.0) << "its top is at 0.05 m, out of reach of this path";
}

TEST_F(Touch, ResamplesThePathAtARate) {
    ASSERT_EQ(touch(kPlane, kDown, {"--rate", "4000"}).status, 0);
    const Table ticks = readTable(out());
    EXPECT_EQ(ticks.rows, 399u * 4u + 1u);
    EXPECT_NEAR(ticks["t"][1], 0.00025, 1e-15);
    EXPECT_NEAR(ticks["hip_y"][4], readTable(path(kDown))["y"][1], 1e-12);
}

TEST_F(Touch, RefusesABadPathAndLeavesNothingBehind) {
    const std::vector<std::string> bad{
        "",
        "t,x,y,z\n",
        "t,x,y\n0,0,0\n",
        "t,x,y,z\n0,0,0\n",
        "t,x,y,z\n0,0,nan,0\n",
        "t,x,y,z\n0,0,zero,0\n",
        "t,x,y,z\n0,0,0,0\n0,0,0,0\n",
    };
    for (const std::string& csv : bad) {
        expectRefused(touch(kPlane, csv), 1, {"hip.csv"});
        EXPECT_FALSE(fs::exists(out())) << csv;
    }
    expectRefused(runProgram({kProgram, "touch", kPlane, "--path", "/no/such.csv", "--out", out()}), 1,
                  {"/no/such.csv"});
}

TEST_F(Touch, AFolderThatIsNotThereIsNamed) {
    const std::string nowhere = (scratch / "no").string() + "/ticks.csv";
    expectRefused(runProgram({kProgram, "touch", kPlane, "--path", path(kDown), "--out", nowhere}), 1,
                  {nowhere, "remedy"});
    // The report's folder is missing: the ticks must not stand there alone as if all had gone well.
    expectRefused(touch(kPlane, kDown, {"--json", (scratch / "no").string() + "/f.json"}), 1, {"f.json"});
    EXPECT_FALSE(fs::exists(out()));
    size_t files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(scratch.path()))
        ++files;
    EXPECT_EQ(files, 1u) << "only the path";
}

TEST_F(Touch, ASlowDeviceOfLateTicksStillObeysTheLimiter) {
    // 20 mm deep at 3000 N/m asks for 60 N.
    ASSERT_EQ(
        touch(kPlane, straightPath({0.0, 0.01, 0.0}, {0.0, -0.02, 0.0}, 600), {"--set", "stiffness=3000"})
            .status,
        0);
    const Table ticks = readTable(out());
    double most = 0.0, force = 0.0;
    for (size_t i = 0; i < ticks.rows; ++i) {
        most =
            std::max(most, std::hypot(ticks["command_x"][i], ticks["command_y"][i], ticks["command_z"][i]));
        force = std::max(force, ticks["force_y"][i]);
    }
    EXPECT_GT(force, 50.0) << "stage 7 says what the spring says";
    EXPECT_LE(most, 8.5);
    EXPECT_GT(most, 8.4);
}

TEST(Inspect, TellsWhatTheDoughnutIsAndWouldFeelLike) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "i.json").string();
    const ProgramResult result = runProgram({kProgram, "inspect", kDoughnut, "--json", json});
    ASSERT_EQ(result.status, 0) << result.err;
    const auto answer = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(answer["triangles"], 64800);
    EXPECT_EQ(answer["touchable"], true);
    EXPECT_EQ(answer["objects"][0]["closed"], true);
    EXPECT_GT(answer["tick_p50_ns"]["all"], 0);
    bool height = false;
    for (const auto& effect : answer["materials"][0]["effects"])
        if (effect["effect"] == "height map")
            height = effect["on"];
    EXPECT_TRUE(height);
    EXPECT_TRUE(contains(result.out, "2 of 2 images decoded"));
    EXPECT_GT(answer["materials"][0]["effects"][0]["memory_bytes"], 12 * 32400) << "normals of the shading";
    EXPECT_TRUE(contains(result.out, "64800 triangles"));
    EXPECT_TRUE(contains(result.out, "height map"));
}

TEST(Inspect, DecodesOnlyWhatTheHandReads) {
    const ProgramResult result = runProgram({kProgram, "inspect", TOUCHSTONE_ASSETS "/swatches.glb"});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "6 of 17 images decoded"));
}

TEST(Inspect, TellsWhatAProgramIsAndCosts) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "wood.json").string();
    const ProgramResult result =
        runProgram({kProgram, "inspect", TOUCHSTONE_ASSETS "/../programs/wood.glsl", "--json", json});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "parameter ringscale = [200.0], 1 to 2000 1/m  rings per metre"));
    const auto answer = nlohmann::json::parse(readFile(json));
    EXPECT_GT(answer["instructions"], 100);
    EXPECT_GT(answer["ns_per_tick"], 0.0);
    EXPECT_LT(answer["cost"], answer["budget"]);
    EXPECT_EQ(answer["flagged_share"], 0.0);
    EXPECT_EQ(answer["parameters"].size(), 10);
}

TEST(Inspect, RefusesWrongProgramsAtTheirLine) {
    const ScratchFolder scratch;
    const std::string wrong = (scratch / "wrong.glsl").string();
    std::ofstream(wrong)
        << "// one\nvoid touch(const in Touch before, inout Surface after) { after.force = colour; }\n";
    expectRefused(runProgram({kProgram, "inspect", wrong}), 1,
                  {"wrong.glsl: line 2: ", "undeclared identifier", "remedy: "});
    expectRefused(runProgram({kProgram, "inspect", (scratch / "none.glsl").string()}), 1, {"none.glsl"});
    std::ofstream(wrong)
        << "void touch(const in Touch before, inout Surface after) { after.force /= before.uv.x; }\n";
    const ProgramResult flagged = runProgram({kProgram, "inspect", wrong});
    EXPECT_EQ(flagged.status, 0) << flagged.err;
    EXPECT_TRUE(contains(flagged.out, "without a result at 100 %"));
    expectRefused(runProgram({kProgram, "inspect", wrong, "--iso", "3"}), 1, {"--iso"});
}

TEST(Inspect, TellsWhatTheNeighbourhoodWatchWouldCost) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "box.json").string();
    ASSERT_EQ(runProgram({kProgram, "inspect", kBox, "--json", json}).status, 0);
    const auto answer = nlohmann::json::parse(readFile(json));
    EXPECT_EQ(answer["neighbourhood"]["memory_bytes"], 12 * 24);
    EXPECT_EQ(answer["neighbourhood"]["border_edges"], 0);
    EXPECT_EQ(answer["neighbourhood"]["non_manifold_edges"], 0);
}

TEST(Bench, PrintsEveryFigureBesideItsBound) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "bench.json").string();
    const ProgramResult result =
        runProgram({kProgram, "bench", "--largest", "64800", "--rounds", "1", "--json", json});
    ASSERT_EQ(result.status, 0) << result.err;
    for (const char* words :
         {"torus 64,800, r = 0.0 mm", "of 6, ", "of 12, ", "1,000 objects take",
          "allocations and frees in ticks: 0, met", "Number of polygons", "| 12 | 456 | 1,800 | 64,800 |",
          "neighbourhood watch", "1000 moving objects, r = 0.5 mm", "two boxes, r = 0.0 mm",
          "| 3328 triangles | ", "| 11858 triangles | "})
        EXPECT_TRUE(contains(result.out, words)) << words;
    EXPECT_FALSE(contains(result.out, "1,000,000")) << "larger than was asked for";
    const auto figures = nlohmann::json::parse(readFile(json));
    for (const char* part : {"fast", "growth"})
        for (const auto& configuration : figures[part]) {
            EXPECT_EQ(configuration["allocations_in_tick"], 0) << configuration["name"];
            EXPECT_EQ(configuration["flagged_ticks"], 0) << configuration["name"];
            EXPECT_GT(configuration["ticks_in_contact"], 700) << configuration["name"];
            EXPECT_LE(configuration["step_p50_ns"], configuration["step_p99_ns"]);
            EXPECT_GT(configuration["ray_p50_ns"], 0);
        }
    for (const auto& configuration : figures["moving"]) {
        EXPECT_EQ(configuration["allocations_in_tick"], 0) << configuration["name"];
        EXPECT_GT(configuration["ticks_in_contact"], 300) << configuration["name"];
        EXPECT_LE(configuration["step_p99_ns"], configuration["step_worst_ns"]);
        EXPECT_EQ(configuration["pinched_ticks"] > 0, configuration["name"] == "two boxes")
            << configuration["name"];
        EXPECT_EQ(configuration.contains("poses_p50_ns"), configuration["name"] != "1000 objects")
            << configuration["name"];
    }
    ASSERT_EQ(figures["fields"].size(), 2u);
    for (const auto& field : figures["fields"]) {
        EXPECT_GT(field["seconds_p50"], 0.0);
        EXPECT_GT(field["processor_seconds_p50"], 0.0);
        // As deep as a device pushes, the torus is no hole: more than the band about its surface.
        EXPECT_GT(field["bytes"], 5'000'000) << field["triangles"];
    }
    expectRefused(runProgram({kProgram, "bench", "slow"}), 2, {"fast", "growth", "moving", "fields"});
}

TEST(Bench, RunsTheProtocolOfTheSeedsTable) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "protocol.json").string();
    const ProgramResult result =
        runProgram({kProgram, "bench", "protocol", "--seconds", "0.1", "--runs", "2", "--json", json});
    ASSERT_EQ(result.status, 0) << result.err;
    for (const char* words :
         {"2 runs of 0.1 s", "| 8, 18, 12 | 239, 695, 456 | 902, 2700, 1800 | 32402, 97200, 64800 |",
          "| [000 Table I] | 12 to 13 |", "| neighbourhood watch |", "| sweep |"})
        EXPECT_TRUE(contains(result.out, words)) << words;
    const auto figures = nlohmann::json::parse(readFile(json))["protocol"];
    ASSERT_EQ(figures.size(), 8u);
    for (const auto& object : figures) {
        ASSERT_EQ(object["runs"].size(), 2u);
        for (const auto& run : object["runs"]) {
            EXPECT_GE(run["seconds"], 0.1);
            EXPECT_EQ(run["rate_hz"], run["ticks"].get<double>() / run["seconds"].get<double>());
            // 0.2 s of the hand's time pass in the air.
            EXPECT_GT(run["ticks_in_contact"], run["ticks"].get<double>() - 300.0) << object["scene"];
        }
    }
    expectRefused(runProgram({kProgram, "bench", "protocol", "--runs", "0"}), 2, {"--runs"});
}

TEST(Inspect, APlainModelNeedsNoEffect) {
    const ScratchFolder scratch;
    const std::string json = (scratch / "i.json").string();
    ASSERT_EQ(runProgram({kProgram, "inspect", TOUCHSTONE_ASSETS "/torus_64800.glb", "--json", json}).status,
              0);
    const auto answer = nlohmann::json::parse(readFile(json));
    for (const auto& effect : answer["materials"][0]["effects"])
        if (effect["effect"] == "normal map" || effect["effect"] == "height map") {
            EXPECT_EQ(effect["on"], false);
            EXPECT_FALSE(effect["reason"].get<std::string>().empty());
        }
}

/// The first number after `label`, or -1.
double numberAfter(const std::string& text, const std::string& label) {
    const size_t at = text.find(label);
    return at == std::string::npos ? -1.0 : std::strtod(text.c_str() + at + label.size(), nullptr);
}

TEST(Simplify, WritesWhatItMeasuredAndReadsItAgain) {
    const ScratchFolder scratch;
    const std::string out = (scratch / "torus.glb").string();
    const std::string torus = TOUCHSTONE_ASSETS "/torus_64800.glb";
    const ProgramResult result = runProgram({kProgram, "simplify", torus, "--threshold", "5", "--out", out});
    ASSERT_EQ(result.status, 0) << result.err;
    EXPECT_TRUE(contains(result.out, "64800 triangles, nine smooth edges of ten within 2 degrees"))
        << result.out;
    const double kept = numberAfter(result.out, "within 5 degrees: ");
    EXPECT_GT(kept, 0.0);
    EXPECT_LT(kept, 0.75 * 64800.0) << result.out;
    EXPECT_LE(numberAfter(result.out, "nine of ten within "), 5.0);
    // 250 facets and more around the tube of 25 mm leave less than r (1 - cos 5 degrees).
    EXPECT_GT(numberAfter(result.out, "at most "), 0.0);
    EXPECT_LT(numberAfter(result.out, "at most "),
              25.0 * (1.0 - std::cos(5.0 * 3.14159265358979 / 180.0)) * 2.0);
    const ProgramResult again = runProgram({kProgram, "inspect", out});
    EXPECT_EQ(again.status, 0) << again.err;
    EXPECT_EQ(numberAfter(again.out, "\n  "), kept) << "the triangles of the file are those that were told";
    EXPECT_TRUE(contains(again.out, "'slate'")) << "materials keep their names";
    // Without a file it tells the same figures and writes nothing.
    const ProgramResult told = runProgram({kProgram, "simplify", torus, "--threshold", "5"});
    EXPECT_EQ(told.out, result.out.substr(0, result.out.find("saved to")));
}

TEST(Simplify, RefusesWhatItCannotDoAndWritesNothing) {
    const ScratchFolder scratch;
    const std::string out = (scratch / "out.glb").string();
    expectRefused(runProgram({kProgram, "simplify", kBox, "--threshold", "5", "--out", out}), 1,
                  {kBox, "90", "triangles are needed"});
    EXPECT_FALSE(fs::exists(out));
    expectRefused(runProgram({kProgram, "simplify", (scratch / "no.glb").string(), "--threshold", "5"}), 1,
                  {"no.glb", "there is no such file"});
    expectRefused(runProgram({kProgram, "simplify", kDoughnut}), 2, {"--threshold", "required"});
    for (const char* angle : {"0", "-5", "91", "nan", "many"})
        expectRefused(runProgram({kProgram, "simplify", kDoughnut, "--threshold", angle}), 2,
                      {"--threshold"});
    expectRefused(runProgram({kProgram, "simplify", kDoughnut, "--threshold", "30", "--out", "a.obj"}), 2,
                  {"a.obj", ".glb"});
    const ProgramResult nowhere =
        runProgram({kProgram, "simplify", TOUCHSTONE_ASSETS "/torus_64800.glb", "--threshold", "5", "--out",
                    (scratch / "no" / "a.glb").string()});
    EXPECT_EQ(nowhere.status, 1);
    EXPECT_TRUE(contains(nowhere.err, "cannot be written")) << nowhere.err;
}

TEST(Devices, ListsWhatIsBuiltIn) {
    const ProgramResult result = runProgram({kProgram, "devices"});
    EXPECT_EQ(result.status, 0);
    EXPECT_TRUE(contains(result.out, "mouse"));
    EXPECT_TRUE(contains(result.out, "simulated hand"));
}

} // namespace
} // namespace touchstone::test::command_tests
