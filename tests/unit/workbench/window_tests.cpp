// The real window, driven as a person would: pointer and keys on a screen of its own.

#include "tests/unit/workbench/picture_size.h"
#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <set>
#include <utility>

namespace touchstone::test::window_tests {
namespace {

const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

bool touching(const Json& s) {
    return s["recent"]["in_contact"].get<bool>();
}

TEST_F(WindowTest, TheContactMethodCanBeChosenWhileTouching) {
    open(kDoughnut, {"--hand", "simulated", "--set", "texture=off"});
    const Json swept = until("the hand to touch", touching);
    ASSERT_EQ(swept["settings"]["contact"], "sweep");
    // The list drops down under its box, where there is room; the second line is the other method.
    display_.scroll(middleOf("budget"), -5);
    later();
    VirtualDisplay::Place choice = middleOf("contact");
    const auto height = swept["widgets"]["contact"]["height"].get<double>();
    display_.click(choice);
    later();
    choice.y += static_cast<int>(2.2 * height);
    display_.click(choice);
    until("the neighbourhood watch to be chosen",
          [](const Json& s) { return s["settings"]["contact"] == "neighbourhood"; });
    measured();
    until("the hand to press again",
          [](const Json& s) { return touching(s) && s["recent"]["mean_force_n"] > 0.05; });
    expectCleanEnd();
}

// It ended the program where the first model was not there yet.
TEST_F(WindowTest, AMissingFileChosenWhileTheFirstIsOnItsWayIsTold) {
    start(TOUCHSTONE_ASSETS "/torus_64800.glb", {"--hand", "simulated"});
    until("the window", [](const Json&) { return true; });
    openByPath("/no/such/model.glb");
    const Json s = until("the problem and a model", [](const Json& now) {
        return now["problem"] != "" && now["loading"] == false && now["model"] != "";
    });
    EXPECT_NE(s["problem"].get<std::string>().find("/no/such/model.glb"), std::string::npos);
    expectCleanEnd();
}

TEST_F(WindowTest, TheRecordButtonRecordsWhatReplaysToTheLastBit) {
    open(kDoughnut, {"--hand", "simulated"});
    until("the hand to touch", touching);
    display_.click(middleOf("record"));
    until("the recording to begin",
          [](const Json& s) { return s["recording"]["on"] == true && s["recording"]["seconds"] > 0.5; });
    // What is recorded depends on what is done meanwhile.
    display_.click(middleOf("friction"));
    until("friction to be off", [](const Json& s) { return s["settings"]["friction"] == "off"; });
    later();
    display_.click(middleOf("record"));
    const Json done =
        until("the recording to end", [](const Json& s) { return s["recording"]["on"] == false; });
    const std::string file = done["recording"]["file"], json = (scratch_ / "replay.json").string();
    EXPECT_TRUE(file.starts_with((scratch_ / "state").string())) << file;
    const ProgramResult replay = runProgram({TOUCHSTONE_BINARY, "replay", file, "--json", json});
    EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
    const Json figures = Json::parse(readFile(json));
    EXPECT_EQ(figures["cut_off"], false);
    EXPECT_GT(figures["contact"]["ticks"], 100);
    EXPECT_EQ(figures["replayed"], figures["ticks"]) << "it begins at a checkpoint";
    expectCleanEnd();
    for (const auto& kept : std::filesystem::directory_iterator(scratch_ / "state/touchstone/flight"))
        EXPECT_TRUE(kept.path().filename().string().starts_with("safety-latched-"))
            << kept.path() << ": no fault but of a machine that is too busy for a kilohertz, nothing kept";
}

TEST_F(WindowTest, ClickingTheFrictionToggleChangesTheForce) {
    open(kDoughnut, {"--hand", "simulated", "--set", "staticFriction=0.6", "--set", "dynamicFriction=0.5",
                     "--set", "texture=off"});
    until("the hand to touch", touching);
    measured();
    const Json on = until("the hand to press and rub", [](const Json& s) {
        return s["recent"]["mean_force_n"] > 0.05 && s["recent"]["mean_tangential_force_n"] > 0.02;
    });
    ASSERT_EQ(on["settings"]["friction"], "zilles");

    display_.click(middleOf("friction"));
    until("friction to be off", [](const Json& s) { return s["settings"]["friction"] == "off"; });
    measured();
    const Json off = until("the hand to press again",
                           [](const Json& s) { return touching(s) && s["recent"]["mean_force_n"] > 0.05; });
    EXPECT_LT(off["recent"]["mean_tangential_force_n"],
              0.1 * on["recent"]["mean_tangential_force_n"].get<double>());

    display_.click(middleOf("friction"));
    until("friction to be back as it was",
          [](const Json& s) { return s["settings"]["friction"] == "zilles"; });
    measured();
    until("the hand to rub once more",
          [](const Json& s) { return touching(s) && s["recent"]["mean_tangential_force_n"] > 0.02; });
    expectCleanEnd();
}

TEST_F(WindowTest, TheOtherTogglesAndTheSpaceKeyReachTheServo) {
    open(kDoughnut, {"--hand", "simulated"});
    display_.click(middleOf("texture"));
    until("texture to be off", [](const Json& s) { return s["settings"]["texture"] == "off"; });
    display_.click(middleOf("forceShading"));
    until("force shading to be off", [](const Json& s) { return s["settings"]["forceShading"] == "off"; });
    display_.key("space");
    until("the force to be off", [](const Json& s) { return s["settings"]["forceEnabled"] == "off"; });
    display_.key("space");
    until("the force to be on", [](const Json& s) { return s["settings"]["forceEnabled"] == "on"; });
    display_.click(middleOf("mouse"));
    until("the mouse to be the hand", [](const Json& s) { return s["hand"] == "mouse"; });
    expectCleanEnd();
}

TEST_F(WindowTest, PointingTouchesAndPressesAsHardAsTheWheelSays) {
    open(kDoughnut, {"--set", "texture=off"});
    const Json before = later();
    const auto pressed = [](const Json& s) { return s["tick"]["contacts"].get<int>() > 0; };
    // The tube of the doughnut, left of its hole.
    const VirtualDisplay::Place tube = inPicture(0.3, 0.5);
    display_.move(tube);
    until("the hand to be over the tube",
          [&](const Json& s) { return s["tick"]["hip"] != before["tick"]["hip"]; });
    EXPECT_FALSE(pressed(later())) << "it hovers";
    const auto force = [](const Json& s) {
        const auto f = s["tick"]["force"].get<std::vector<double>>();
        return std::hypot(f[0], f[1], f[2]);
    };
    display_.press();
    const double asked = before["mouse"]["press_n"];
    until("the asked force", [&](const Json& s) { return std::abs(force(s) - asked) < 0.1 * asked; });
    display_.scroll(tube, 3);
    until("more force", [&](const Json& s) {
        const double more = s["mouse"]["press_n"];
        return more > 1.5 * asked && std::abs(force(s) - more) < 0.1 * more;
    });
    display_.release();
    until("the hand to let go", [&](const Json& s) { return !pressed(s); });
    expectCleanEnd();
}

TEST_F(WindowTest, DraggingMovesAFreeHandInTheViewPlaneAndTheWheelInDepth) {
    open(kDoughnut);
    display_.key("g");
    until("the hand to be free", [](const Json& s) { return s["mouse"]["free"].get<bool>(); });
    const auto hip = [](const Json& s) {
        const auto v = s["tick"]["hip"].get<std::vector<double>>();
        return std::array<double, 3>{v[0], v[1], v[2]};
    };
    const auto distance = [](const std::array<double, 3>& a, const std::array<double, 3>& b) {
        return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
    };
    const auto start = hip(later());
    display_.drag(inPicture(0.4, 0.6), inPicture(0.4, 0.4));
    const auto dragged = hip(later());
    EXPECT_GT(distance(start, dragged), 0.01);
    EXPECT_GT(dragged[1], start[1]) << "up is up";
    display_.scroll(inPicture(0.4, 0.4), 5);
    auto pushed = hip(later()), before = dragged;
    for (int i = 0; i < 100 && distance(before, pushed) > 1e-8; ++i) // it comes to rest smoothly
        before = std::exchange(pushed, hip(later()));
    EXPECT_NEAR(distance(dragged, pushed), 0.010, 0.002) << "five notches of 2 mm";
    EXPECT_LT(pushed[2], dragged[2]) << "away from the user";
    display_.drag(inPicture(0.4, 0.4), inPicture(0.6, 0.5), 3);
    EXPECT_LT(distance(pushed, hip(later())), 1e-6) << "turning the view moves no hand";
    expectCleanEnd();
}

TEST_F(WindowTest, KeysLookFromTheSidesAndAtAll) {
    open(kDoughnut, {"--hand", "simulated"});
    const auto camera = [](const Json& s, const char* what) { return s["view"][what].get<double>(); };
    const Json first = later();
    const auto press = [&](const char* key, double yaw, double pitch) {
        display_.key(key);
        until(std::string("the view of key ") + key, [&](const Json& s) {
            return std::abs(camera(s, "yaw") - yaw) < 1e-9 && std::abs(camera(s, "pitch") - pitch) < 1e-9;
        });
    };
    constexpr double kQuarter = 1.5707963267948966;
    press("1", 0.0, 0.0);
    press("3", kQuarter, 0.0);
    press("7", 0.0, kQuarter);
    press("ctrl+3", -kQuarter, 0.0);
    display_.key("period");
    until("the probe to be near",
          [&](const Json& s) { return camera(s, "distance") < 0.5 * camera(first, "distance"); });
    // The mouse is not the hand here, so its left button turns the view, too, and the wheel zooms.
    display_.drag(inPicture(0.4, 0.5), inPicture(0.6, 0.5));
    until("the view to turn", [&](const Json& s) { return std::abs(camera(s, "yaw") + kQuarter) > 0.1; });
    const double before = camera(later(), "distance");
    display_.scroll(inPicture(0.4, 0.5), -2);
    until("the view to zoom", [&](const Json& s) { return camera(s, "distance") > 1.1 * before; });
    display_.key("Home");
    until("all to be seen",
          [&](const Json& s) { return camera(s, "distance") > 0.8 * camera(first, "distance"); });
    display_.key("t");
    const double yaw =
        camera(until("the turntable", [](const Json& s) { return s["view"]["turntable"] == true; }), "yaw");
    until("it to turn", [&](const Json& s) { return std::abs(camera(s, "yaw") - yaw) > 0.2; });
    expectCleanEnd();
}

TEST_F(WindowTest, EveryViewCanBeSavedWithMagnifierAndLegend) {
    open(kDoughnut, {"--hand", "simulated"});
    display_.key("m");
    until("the magnifier", [](const Json& s) { return s["view"]["magnifier"] == true; });
    std::string last = "shaded";
    std::set<std::string> seen{last};
    for (int i = 0; i < 10; ++i) {
        display_.key("v");
        const Json now = until("another view", [&](const Json& s) { return s["view"]["mode"] != last; });
        last = now["view"]["mode"];
        seen.insert(last);
    }
    EXPECT_EQ(seen.size(), 11u);
    for (const char* name : {"doughnut-perception-1.png", "doughnut-perception-2.png"}) {
        display_.key("F12");
        const Json saved = until("the picture", [&](const Json& s) {
            return s["view"]["picture"].get<std::string>().ends_with(name);
        });
        const std::filesystem::path file = scratch_ / "state/touchstone/pictures" / name;
        EXPECT_EQ(saved["view"]["picture"], "saved " + file.string());
        EXPECT_GT(std::filesystem::file_size(file), 10000u);
    }
    display_.key("o");
    until("no overlays", [](const Json& s) { return s["view"]["overlays"] == false; });
    display_.key("v");
    until("the look", [](const Json& s) { return s["view"]["mode"] == "shaded"; });
    expectCleanEnd();
}

/// Drawn anew, not taken from the screen: in the size of the window's picture, or in the one that was chosen.
TEST_F(WindowTest, SavesPicturesInTheirOwnSizeWhileTheServoGoesOn) {
    const std::filesystem::path folder = scratch_ / "state/touchstone/pictures";
    const auto saved = [&](const std::string& name) {
        display_.key("F12");
        until("the picture",
              [&](const Json& s) { return s["view"]["picture"] == "saved " + (folder / name).string(); });
        return pngSize(readFile(folder / name));
    };
    open(kDoughnut, {"--hand", "simulated", "--picture-size", "3840x2160"});
    const int ticks = later()["servo"]["ticks"];
    EXPECT_EQ(saved("doughnut-1.png"), (std::pair<uint32_t, uint32_t>(3840, 2160)));
    EXPECT_GT(later()["servo"]["ticks"], ticks);
    expectCleanEnd();

    open(kDoughnut);
    const Json shown = later()["widgets"].at("picture");
    const auto size = saved("doughnut-2.png");
    EXPECT_NEAR(size.first, shown["width"].get<double>(), 1.0);
    EXPECT_NEAR(size.second, shown["height"].get<double>(), 1.0);
    // A folder that takes no file costs the picture, not the window.
    std::filesystem::remove_all(folder);
    writeTextFile(folder, "in the way");
    display_.key("F12");
    until("the problem", [](const Json& s) {
        return s["view"]["picture"].get<std::string>().starts_with("the picture is not saved: ");
    });
    expectCleanEnd();
}

TEST_F(WindowTest, PointingRoundAnEdgeLiftsTheHandOff) {
    open(TOUCHSTONE_ASSETS "/box.glb");
    // From the right face to the front one and back, pressed all the while.
    display_.move(inPicture(0.62, 0.5));
    display_.press();
    for (const double x : {0.4, 0.62, 0.4}) {
        display_.move(inPicture(x, 0.5));
        until("the force that was asked for", [](const Json& s) {
            const auto f = s["tick"]["force"].get<std::vector<double>>();
            return std::abs(std::hypot(f[0], f[1], f[2]) - 0.6) < 0.06;
        });
    }
    display_.release();
    until("the air", [](const Json& s) { return !touching(s); });
    expectCleanEnd();
}

TEST_F(WindowTest, PushingAFreeHandIntoTheModelIsFelt) {
    open(TOUCHSTONE_ASSETS "/box.glb");
    display_.move(inPicture(0.5, 0.5));
    later(); // over the box, before it
    display_.key("g");
    measured();
    until("the air", [](const Json& s) { return !touching(s); });
    display_.scroll(inPicture(0.5, 0.5), 14);
    const Json pressed = until("a contact", touching);
    EXPECT_GT(pressed["recent"]["mean_force_n"], 0.0);
    expectCleanEnd();
}

TEST(WindowStart, AModelThatIsNotThereEndsItWithAMessage) {
    const VirtualDisplay display(640, 480);
    const ProgramResult result =
        runProgram({TOUCHSTONE_BINARY, "/no/such/model.glb", "--size", "640x480"}, display.environment());
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("/no/such/model.glb"), std::string::npos) << result.err;
}

} // namespace
} // namespace touchstone::test::window_tests
