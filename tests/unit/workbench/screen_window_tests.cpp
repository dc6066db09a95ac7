// What happens to the window and its graphics device: sizes, minimising, models that come and go, and devices
// that are lost. The validation layer must have nothing to say, and what is felt goes on.

#include "tests/support/device_loss.h"
#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <string>
#include <thread>
#include <vector>

namespace touchstone::test::screen_window_tests {
namespace {

const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

class ScreenWindowTest : public WindowTest {
  protected:
    std::string window() {
        std::string found = display_.xdotool({"search", "--name", "Touchstone"});
        return found.substr(0, found.find('\n'));
    }
    void resize(int width, int height) {
        display_.xdotool({"windowsize", window(), std::to_string(width), std::to_string(height)});
    }
    void iconify(bool iconic) {
        const std::string program =
            (std::filesystem::path(TOUCHSTONE_BINARY).parent_path() / "iconify_window").string();
        const ProgramResult result =
            runProgram({program, window(), iconic ? "on" : "off"}, display_.environment());
        ASSERT_EQ(result.status, 0) << result.err;
    }
    static void pause(int milliseconds) {
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
    }

    /// The program's end: nothing was wrong, also not while it ended.
    void expectSilentEnd() {
        expectCleanEnd();
        EXPECT_EQ(readFile(scratch_ / "log").find("validation"), std::string::npos)
            << readFile(scratch_ / "log");
    }

    /// The model is on the screen: the middle of the picture's left half is not the background, which is
    /// grey.
    bool modelIsSeen() {
        const Json rect = status()["widgets"].at("picture");
        const VirtualDisplay::Place place = inPicture(0.0, 0.0);
        const ScreenPicture screen = display_.screen();
        int coloured = 0;
        for (int x = place.x; x < place.x + rect["width"].get<int>(); x += 4)
            for (int y = place.y; y < place.y + rect["height"].get<int>(); y += 4) {
                if (x < 0 || y < 0 || x >= screen.width || y >= screen.height)
                    continue;
                const auto& pixel = screen.at(x, y);
                coloured += pixel[0] > pixel[2] + 40; // the doughnut is pink
            }
        return coloured > 500;
    }
};

TEST_F(ScreenWindowTest, AnySizeWillDo) {
    open(kDoughnut, {"--hand", "simulated"});
    const int sizes[][2]{{1270, 790}, {640, 400}, {300, 200}, {64, 64},  {16, 700}, {900, 9},
                         {1, 1},      {2, 2},     {1, 790},   {1200, 1}, {500, 90}, {1100, 700}};
    for (const auto& size : sizes) {
        resize(size[0], size[1]);
        pause(300);
        ASSERT_TRUE(program_->running()) << size[0] << " x " << size[1] << readFile(scratch_ / "log");
    }
    for (int i = 0; i < 30; ++i) { // faster than it can follow
        resize(300 + 25 * i, 780 - 20 * i);
        pause(20);
    }
    resize(1000, 780);
    const Json now = later();
    EXPECT_GT(now["widgets"]["picture"]["width"], 200.0);
    until("the model on the screen", [&](const Json&) { return modelIsSeen(); });
    expectSilentEnd();
}

TEST_F(ScreenWindowTest, AtRestThePictureHasTheWindowsResolution) {
    const auto stateIs = [this](const char* wanted) {
        return until(std::string("a picture that is ") + wanted,
                     [&](const Json& s) { return s["picture"]["state"] == wanted; });
    };
    // On a machine that has much else to do a kept picture, too, is smaller for some seconds.
    const auto waitForTheWhole = [this] {
        until("the window's resolution", [&](const Json& s) {
            const Json& place = s["widgets"]["picture"];
            return s["picture"]["state"] == "kept" && s["picture"]["refined_in_s"] > 0.0 &&
                   s["scene_size"][0].get<double>() == place["width"].get<double>() &&
                   s["scene_size"][1].get<double>() == place["height"].get<double>();
        });
    };
    open(kDoughnut, {"--hand", "simulated"});
    waitForTheWhole();
    EXPECT_TRUE(modelIsSeen());
    display_.key("t"); // the turntable
    stateIs("coarse");
    EXPECT_TRUE(modelIsSeen());
    display_.key("t");
    stateIs("kept");
    resize(800, 700);
    until("the new size", [](const Json& s) { return s["widgets"]["picture"]["width"] < 500.0; });
    waitForTheWhole();
    EXPECT_TRUE(modelIsSeen());
    // What moves by itself is drawn over it.
    openByPath(TOUCHSTONE_ASSETS "/moving.glb");
    until("the moving model", [](const Json& s) { return s["model"] == "moving.glb" && !s["loading"]; });
    // On a machine that has much else to do its resolution changes, and it begins anew; not by what moves.
    until("twenty moving pictures over a kept one", [](const Json& s) {
        return s["picture"]["state"] == "kept" && s["picture"]["frames"].get<int>() >= 20;
    });
    expectSilentEnd();
}

TEST_F(ScreenWindowTest, MinimisedItGoesOnTouchingAndComesBack) {
    open(kDoughnut, {"--hand", "simulated"});
    for (int i = 0; i < 3; ++i) {
        iconify(true);
        Json before;
        bool still = false;
        for (int tries = 0; tries < 30 && !still; ++tries) { // what was begun is drawn first
            before = status();
            pause(2000);
            still = status()["update"] == before["update"];
        }
        EXPECT_TRUE(still) << "nothing is drawn";
        iconify(false);
        const Json after = until("a picture", [&](const Json& s) { return s["update"] > before["update"]; });
        EXPECT_GT(after["servo"]["ticks"].get<int>(), before["servo"]["ticks"].get<int>() + 500)
            << "but what is felt went on";
        later();
    }
    // Unmapped without being told that it is minimised, and of no size while it is.
    display_.xdotool({"windowunmap", window()});
    pause(300);
    resize(1, 1);
    pause(300);
    display_.xdotool({"windowmap", window()});
    resize(1000, 780);
    later();
    until("the model on the screen", [&](const Json&) { return modelIsSeen(); });
    expectSilentEnd();
}

TEST_F(ScreenWindowTest, ModelsComeAndGoWhileItIsDrawn) {
    open(kDoughnut, {"--hand", "simulated"});
    display_.key("m");
    const std::vector<std::string> scenes{"/swatches.glb", "/moving.glb", "/table1_object4.glb",
                                          "/doughnut.glb"};
    for (int round = 0; round < 2; ++round)
        for (const std::string& scene : scenes) {
            display_.drop("Touchstone", TOUCHSTONE_ASSETS + scene);
            if (round == 0)
                until("the next model", [&](const Json& s) {
                    return !s["loading"].get<bool>() && "/" + s["model"].get<std::string>() == scene;
                });
            display_.key("v"); // another view while the next one comes
        }
    until("the last model",
          [](const Json& s) { return !s["loading"].get<bool>() && s["model"] == "doughnut.glb"; });
    resize(700, 500);
    later();
    expectSilentEnd();
}

TEST_F(ScreenWindowTest, QuitWhileAModelIsLoaded) {
    const ScratchFolder models;
    const std::string assets =
        (std::filesystem::path(TOUCHSTONE_BINARY).parent_path() / "touchstone_assets").string();
    const std::string model = (models / "torus.glb").string();
    ASSERT_EQ(runProgram({assets, "--shape", "torus", "--triangles", "400000", model}).status, 0);
    for (const int delay : {0, 300, 700, 1100}) {
        start(model);
        pause(delay);
        EXPECT_EQ(program_->stop(), 0) << readFile(scratch_ / "log");
        EXPECT_EQ(readFile(scratch_ / "log").find("validation"), std::string::npos)
            << readFile(scratch_ / "log");
    }
}

class DeviceLossWindowTest : public ScreenWindowTest {
  protected:
    DeviceLossWindowTest() { environment_ = loss_.environment(); }

    void untilLost() {
        for (int i = 0; i < 300 && !loss_.lost(); ++i)
            pause(50);
        ASSERT_TRUE(loss_.lost());
    }

    DeviceLoss loss_{scratch_ / "loss"};
};

TEST_F(DeviceLossWindowTest, ItSaysSoAndGoesOn) {
    open(kDoughnut, {"--hand", "simulated"});
    until("a touch", [](const Json& s) { return s["tick"]["contacts"] > 0; });
    // Three within ten seconds would be too many.
    const auto now = [] { return std::chrono::steady_clock::now(); };
    std::array<std::chrono::steady_clock::time_point, 2> last{now() - std::chrono::minutes(1), last[0]};
    for (const std::string kind : {"submit", "present", "acquire", "wait", "surface"}) {
        std::this_thread::sleep_until(last[0] + std::chrono::seconds(12));
        const Json before = status();
        loss_.lose(kind, 5);
        untilLost();
        last = {last[1], now()};
        const Json told = until("a word about it", [](const Json& s) {
            return s["problem"].get<std::string>().find("graphics device was lost") != std::string::npos;
        });
        until("the model on the screen", [&](const Json&) { return modelIsSeen(); });
        EXPECT_GT(told["servo"]["ticks"], before["servo"]["ticks"]) << kind;
        const Json after = until("a touch", [](const Json& s) { return s["tick"]["contacts"] > 0; });
        EXPECT_EQ(after["model"], "doughnut.glb");
        later(); // a card takes its place in its second frame
        display_.click(middleOf("dismiss"));
        until("the word to be taken back", [](const Json& s) { return s["problem"] == ""; });
    }
    expectSilentEnd();
}

TEST_F(DeviceLossWindowTest, WhileAModelIsTakenIn) {
    open(kDoughnut, {"--hand", "simulated"});
    display_.drop("Touchstone", TOUCHSTONE_ASSETS "/swatches.glb");
    loss_.lose("submit", 9); // while it is taken in, or just before or behind
    untilLost();
    until("the next model",
          [](const Json& s) { return !s["loading"].get<bool>() && s["model"] == "swatches.glb"; });
    later();
    display_.drop("Touchstone", kDoughnut);
    until("the first model",
          [](const Json& s) { return !s["loading"].get<bool>() && s["model"] == "doughnut.glb"; });
    until("the model on the screen", [&](const Json&) { return modelIsSeen(); });
    expectSilentEnd();
}

TEST_F(DeviceLossWindowTest, AgainAndAgainIsTheEnd) {
    open(kDoughnut, {"--hand", "simulated"});
    loss_.lose("submit", 5, true);
    EXPECT_EQ(program_->wait(), 1);
    const std::string log = readFile(scratch_ / "log");
    EXPECT_NE(log.find("the graphics device was lost again and again"), std::string::npos) << log;
    EXPECT_NE(log.find("remedy"), std::string::npos) << log;
    EXPECT_EQ(log.find("validation"), std::string::npos) << log;
}

} // namespace
} // namespace touchstone::test::screen_window_tests
