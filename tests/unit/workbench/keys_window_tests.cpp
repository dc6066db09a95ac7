// Keys that are down for less than a frame, in the real window: none is lost, and the force key works
// whatever has the focus.

#include "haptics/recording/recording_reader.h"
#include "tests/support/sweep.h"
#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <map>
#include <sstream>
#include <thread>
#include <utility>

namespace touchstone::test::keys_window_tests {
namespace {

const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

class KeysTest : public WindowTest {
  protected:
    /// A key that went down, s (CLOCK_MONOTONIC).
    struct Tap {
        double sent, taken; ///< by us, by the X server at the latest
    };
    /// Taps the keys in turn, `count` times all of them, 5 ms each.
    std::vector<Tap> tap(int count, int gapMs, const std::vector<std::string>& keys) {
        const std::string program =
            (std::filesystem::path(TOUCHSTONE_BINARY).parent_path() / "tap_key").string();
        std::vector<std::string> arguments{program, "5", std::to_string(gapMs), std::to_string(count)};
        arguments.insert(arguments.end(), keys.begin(), keys.end());
        const ProgramResult result = runProgram(arguments, display_.environment());
        EXPECT_EQ(result.status, 0) << result.err;
        std::vector<Tap> taps;
        std::istringstream lines(result.out);
        for (double sent = 0.0, taken = 0.0; lines >> sent >> taken;)
            taps.push_back({1e-9 * sent, 1e-9 * taken});
        return taps;
    }
    static bool forceOn(const Json& s) { return s["settings"]["forceEnabled"] == "on"; }
    static bool forceOff(const Json& s) { return s["settings"]["forceEnabled"] == "off"; }

    /// With the focus wherever it is.
    void expectSpaceTakesTheForceAway(const std::string& where) {
        until("the force to be on before " + where, forceOn);
        const int presses = later()["force_presses"];
        tap(1, 0, {"space"});
        const Json s = until("the force to be off: " + where, forceOff);
        EXPECT_EQ(s["force_presses"], presses + 1) << where;
    }
    void giveBack() {
        later();
        display_.click(middleOf("forceEnabled"));
        until("the force to be back", forceOn);
    }
};

TEST_F(KeysTest, EveryTapOfTheForceKeyTakesEffectUnderLoad) {
    const int count = repetitions(60, 200);
    const std::filesystem::path file = scratch_ / "taps.tsrec";
    open(kDoughnut, {"--hand", "simulated", "--stroke", "press", "--record", file.string()});
    until("the hand to press", [](const Json& s) { return s["recent"]["mean_force_n"] > 0.3; });
    std::vector<std::unique_ptr<BackgroundProgram>> load;
    for (int i = 0; i < 3; ++i)
        load.push_back(std::make_unique<BackgroundProgram>(
            std::vector<std::string>{"sh", "-c", "while :; do :; done"}, Environment{}, scratch_ / "load"));
    const double start = later()["servo"]["start_s"];
    const std::vector<Tap> taps = tap(count, 120, {"space"});
    ASSERT_EQ(taps.size(), static_cast<size_t>(count));
    load.clear();
    const Json s = until("all presses", [&](const Json& now) { return now["force_presses"] == count; });
    later();
    // Of several presses between two pictures none gives the force back: which it is now is the picture's
    // doing. Nor does any for some pictures after the watch thread was late, as it may be under load.
    until("the watch of the key", [](const Json& now) { return !now["force_key_late"].get<bool>(); });
    const bool on = forceOn(later());
    tap(1, 0, {"space"});
    until("one press to toggle", [&](const Json& now) { return forceOn(now) != on; });
    EXPECT_EQ(program_->stop(), 0);

    struct Tick {
        double time;
        bool on, commanded;
    };
    std::vector<Tick> ticks;
    std::map<uint32_t, bool> enabled;
    RecordingReader reader(file);
    while (const auto item = reader.next()) {
        if (const auto* settings = std::get_if<RecordedSettings>(&item->item))
            enabled[settings->number] = settings->settings.forceEnabled;
        if (const auto* block = std::get_if<RecordedTicks>(&item->item))
            for (const RecordedTick& tick : block->ticks)
                ticks.push_back(
                    {start + tick.time, enabled.at(tick.settings), glm::length(tick.command) > 0.0});
    }
    ASSERT_GT(ticks.size(), 50u * taps.size());
    int lost = 0;
    std::vector<std::pair<double, double>> untilOff; // s, with what the X server took
    std::vector<double> untilZero;
    for (const auto& [at, taken] : taps) {
        const auto begin = std::upper_bound(ticks.begin(), ticks.end(), at,
                                            [](double t, const Tick& tick) { return t < tick.time; });
        // Under this load the X server and tap_key may wait 45 ms: that is not the program's. Ticks and
        // not time, since a process that stands still sends no force.
        constexpr int kSoon = 50;
        auto off = begin;
        for (int made = 0; off != ticks.end() && off->on && made < kSoon; ++off)
            made += off->time > taken ? 1 : 0;
        if (off == ticks.end() || off->on) {
            ++lost;
            continue;
        }
        auto zero = off;
        while (zero != ticks.end() && zero->commanded)
            ++zero;
        if (begin == ticks.begin() || !std::prev(begin)->commanded || zero == ticks.end())
            continue; // it was off
        untilOff.emplace_back(off->time - at, taken - at);
        untilZero.push_back(zero->time - at);
    }
    EXPECT_EQ(lost, 0);
    ASSERT_GT(untilZero.size(), taps.size() / 20)
        << "the window gives the force back between taps, as fast as it draws";
    std::ranges::sort(untilOff);
    std::ranges::sort(untilZero);
    std::printf("%zu of %d taps took a force away\n", untilZero.size(), count);
    std::printf("to the tick without: median %.2f ms, most %.2f ms, of which at most %.2f ms in the X server "
                "and in tap_key\n",
                1e3 * untilOff[untilOff.size() / 2].first, 1e3 * untilOff.back().first,
                1e3 * untilOff.back().second);
    std::printf("to a command of zero: median %.2f ms, most %.2f ms\n", 1e3 * untilZero[untilZero.size() / 2],
                1e3 * untilZero.back());
}

TEST_F(KeysTest, TheForceKeyWorksWhateverHasTheFocus) {
    start(kDoughnut, {"--hand", "simulated"});
    until("the card", [](const Json& s) { return s["widgets"].contains("gotIt"); });
    expectSpaceTakesTheForceAway("the first run's card");
    giveBack();
    display_.click(middleOf("gotIt"));

    display_.key("ctrl+o");
    until("the menu", [](const Json& s) { return s["widgets"].contains("openPath"); });
    expectSpaceTakesTheForceAway("the path of a file");
    tap(1, 200, {"space"});
    EXPECT_TRUE(forceOff(later())) << "while a text is typed it only takes away";
    display_.key("Escape");
    display_.key("Escape");
    giveBack();

    for (const char* combo : {"contact", "stroke"}) {
        display_.click(middleOf(combo));
        later();
        expectSpaceTakesTheForceAway(std::string("the choice ") + combo);
        display_.key("Escape");
        giveBack();
    }
    for (const char* slider : {"strokeSpeed", "strokeDepth", "zoom"}) {
        display_.xdotool({"keydown", "ctrl"});
        display_.click(middleOf(slider));
        display_.xdotool({"keyup", "ctrl"});
        until("the field to be typed into", [](const Json& s) { return s["typing"] == true; });
        expectSpaceTakesTheForceAway(std::string("the number ") + slider);
        display_.key("Escape");
        giveBack();
    }
    const auto over = [&](const char* name, const char* key, const char* back) {
        display_.key(key);
        later();
        expectSpaceTakesTheForceAway(name);
        display_.key(back);
        giveBack();
    };
    over("help", "F1", "F1");
    over("the gallery", "ctrl+g", "ctrl+g");
    over("the walk through the panels", "F10", "F10");
    display_.key("e");
    later();
    display_.click(middleOf("viewMenu"));
    later();
    expectSpaceTakesTheForceAway("the view menu, with the material editor open");
    display_.key("Escape");
    giveBack();
    openByPath("/no/such/model.glb");
    until("the problem", [](const Json& s) { return s["problem"] != ""; });
    expectSpaceTakesTheForceAway("a problem's card");
    giveBack();
    expectCleanEnd();
}

TEST_F(KeysTest, TheForceKeyWorksInTheMaterialEditor) {
    size_ = kTall;
    const std::filesystem::path model = scratch_ / "doughnut.glb";
    std::filesystem::copy_file(kDoughnut, model);
    open(model.string(), {"--hand", "simulated"});
    display_.key("e");
    until("the editor", [](const Json& s) { return s["widgets"].contains("edit.staticFriction"); });
    slide("edit.staticFriction", 0.8);
    until("an edit", [](const Json& s) { return s["materials"]["edited"].get<bool>(); });
    for (const char* number : {"edit.staticFriction", "edit.stiffness"}) {
        display_.xdotool({"keydown", "ctrl"});
        display_.click(middleOf(number));
        display_.xdotool({"keyup", "ctrl"});
        until("a number to be typed", [](const Json& s) { return s["typing"] == true; });
        expectSpaceTakesTheForceAway(std::string("the editor's number ") + number);
        display_.key("Escape");
        giveBack();
    }
    for (const char* combo : {"edit.material", "edit.preset"}) {
        display_.click(middleOf(combo));
        later();
        expectSpaceTakesTheForceAway(std::string("the editor's choice ") + combo);
        display_.key("Escape");
        giveBack();
    }
    display_.click(middleOf("saveAs"));
    until("the name to be asked for", [](const Json& s) { return s["widgets"].contains("openPath"); });
    display_.click(middleOf("openPath"));
    until("a name to be typed", [](const Json& s) { return s["typing"] == true; });
    expectSpaceTakesTheForceAway("the name of the file to save");
    display_.key("Escape");
    giveBack();
    display_.key("ctrl+q");
    until("the question", [](const Json& s) { return s["leaving"].get<bool>(); });
    expectSpaceTakesTheForceAway("the question about unsaved materials");
    display_.key("Escape");
    until("to stay", [](const Json& s) { return !s["leaving"].get<bool>(); });
    giveBack();
    expectCleanEnd();
}

/// While a recording is looked at the force is off; Space then decides that it stays off with the live hand.
TEST_F(KeysTest, TheForceKeyWorksWhileARecordingIsLookedAt) {
    open(kDoughnut, {"--hand", "simulated"});
    until("the hand to touch", [](const Json& s) { return s["recent"]["in_contact"].get<bool>(); });
    display_.key("F9");
    until("a second", [](const Json& s) { return s["recording"]["seconds"] > 1.0; });
    display_.key("F9");
    const std::string file =
        until("the end", [](const Json& s) { return s["recording"]["on"] == false; })["recording"]["file"];
    const std::string row = "recording:" + std::filesystem::path(file).filename().string();
    const auto look = [&] {
        display_.click(middleOf("recorded"));
        until("the list", [&](const Json& s) { return s["widgets"].contains(row); });
        later();
        display_.click(middleOf(row));
        until("the recording", [](const Json& s) { return s["timeline"]["looking"] == true; });
        later();
    };
    for (const char* focus : {"picture", "speed", "timeline"}) {
        look();
        display_.click(middleOf(focus));
        later();
        expectSpaceTakesTheForceAway(std::string("the recording's ") + focus);
        for (int tries = 0; tries < 3 && later()["timeline"]["looking"] == true; ++tries)
            display_.key("Escape");
        const Json live = until(std::string("the live hand after ") + focus,
                                [](const Json& s) { return s["timeline"]["looking"] == false; });
        EXPECT_TRUE(forceOff(live)) << focus;
        giveBack();
    }
    expectCleanEnd();
}

TEST_F(KeysTest, ANumberThatIsTypedStopsNeitherTheForceKeyNorQuitting) {
    open(kDoughnut);
    display_.key("F8");
    until("the simulated hand", [](const Json& s) { return s["hand"] == "simulated"; });
    display_.key("F10"); // the keyboard walks through the panels
    later();
    display_.xdotool({"keydown", "ctrl"});
    display_.click(middleOf("strokeDepth"));
    display_.xdotool({"keyup", "ctrl"});
    until("a number to be typed", [](const Json& s) { return s["typing"] == true; });
    expectSpaceTakesTheForceAway("a number");
    tap(1, 0, {"ctrl+q"});
    for (int i = 0; i < 600 && program_->running(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_FALSE(program_->running());
}

TEST_F(KeysTest, NoTapIsLostHoweverManyComeInAFrame) {
    open(kDoughnut, {"--hand", "simulated"});
    const std::string before = later()["settings"]["texture"];
    // Taps take effect in their order, over several frames: what comes after the last of them follows all.
    // (That the texture is another is so after the first of seven, too.)
    const auto untilAllAreAnswered = [&](bool grid) {
        tap(1, 5, {"l"});
        return until("the grid", [=](const Json& s) { return s["view"]["grid"] == grid; });
    };
    tap(7, 5, {"F6"});
    EXPECT_NE(untilAllAreAnswered(true)["settings"]["texture"], before);
    EXPECT_NE(later()["settings"]["texture"], before);
    tap(9, 5, {"v"});
    EXPECT_EQ(untilAllAreAnswered(false)["view"]["mode"], "effects");
    EXPECT_EQ(later()["view"]["mode"], "effects");
    tap(1, 5, {"v", "m", "F6", "shift+v", "o"}); // in their order
    const Json s =
        until("the last of them", [](const Json& now) { return now["view"]["overlays"] == false; });
    EXPECT_EQ(s["view"]["mode"], "effects");
    EXPECT_EQ(s["view"]["magnifier"], true);
    EXPECT_EQ(s["settings"]["texture"], before);
    // Into a text, with an editing key between.
    display_.key("ctrl+o");
    until("the menu", [](const Json& now) { return now["widgets"].contains("openPath"); });
    tap(1, 5, {"slash", "a", "b", "c", "BackSpace", "d", "BackSpace", "BackSpace", "e"});
    later();
    tap(1, 5, {"Return"});
    until("what was typed to be looked for",
          [](const Json& now) { return now["problem"].get<std::string>().starts_with("/ae"); });
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::keys_window_tests
