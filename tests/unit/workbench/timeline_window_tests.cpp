// Recordings in the window: made, found in the list, looked at, touched again, verified and left; and files
// that are broken or whose model is gone.

#include "tests/unit/workbench/touch_files.h"
#include "tests/unit/workbench/window_test.h"
#include "touchstone/touchstone.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

namespace touchstone::test::timeline_window_tests {
namespace {

const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

class TimelineWindow : public WindowTest {
  protected:
    static const Json& timeline(const Json& s) { return s["timeline"]; }
    static bool looking(const Json& s) { return s["timeline"]["looking"] == true; }

    /// A place on the timeline, as a share of its length.
    VirtualDisplay::Place onTimeline(double share) {
        const Json rect = status()["widgets"].at("timeline");
        return {corner_.x + static_cast<int>(rect["x"].get<double>() + share * rect["width"].get<double>()),
                corner_.y + static_cast<int>(rect["y"].get<double>() + 0.6 * rect["height"].get<double>())};
    }
    [[nodiscard]] Json cursor(const std::function<bool(int64_t)>& holds) {
        return until("the cursor",
                     [&](const Json& s) { return holds(timeline(s)["cursor_tick"].get<int64_t>()); });
    }
    /// A straight stroke over a copy of a scene, recorded by `touch`.
    void touchOffline(const std::filesystem::path& scene, const std::filesystem::path& recording) {
        writeTextFile(scratch_ / "hip.csv", straightPath({-0.05, 0.0, 0.09}, {0.05, 0.02, 0.0}, 1500));
        const ProgramResult result = runProgram(
            {TOUCHSTONE_BINARY, "touch", scene.string(), "--path", (scratch_ / "hip.csv").string(), "--out",
             (scratch_ / "ticks.csv").string(), "--record", recording.string(), "--fit", "workspace"});
        ASSERT_EQ(result.status, 0) << result.err;
    }
    /// Some seconds of the simulated hand, begun and ended by F9.
    std::string record() {
        open(kDoughnut, {"--hand", "simulated"});
        until("the hand to touch", [](const Json& s) { return s["recent"]["in_contact"].get<bool>(); });
        const auto place = [](const Json& s) {
            Json rect = s["widgets"]["record"];
            rect.erase("note");
            return rect;
        };
        const Json before = place(later());
        display_.key("F9");
        const Json during =
            until("three seconds", [](const Json& s) { return s["recording"]["seconds"] > 3.0; });
        EXPECT_EQ(place(during), before) << "its label changes, not its place";
        display_.key("F9");
        return until("the end",
                     [](const Json& s) { return s["recording"]["on"] == false; })["recording"]["file"];
    }
    void lookAtTheOneInTheList(const std::string& file) {
        display_.click(middleOf("recorded"));
        const std::string row = "recording:" + std::filesystem::path(file).filename().string();
        const Json listed = until("the list", [&](const Json& s) { return s["widgets"].contains(row); });
        EXPECT_EQ(timeline(listed)["list"][0]["model"], "doughnut.glb");
        EXPECT_GT(timeline(listed)["list"][0]["seconds"], 2.9);
        display_.click(middleOf(row));
    }
};

TEST_F(TimelineWindow, WhatWasRecordedIsLookedAtTouchedAgainVerifiedAndLeft) {
    const std::string file = record();
    const auto pushed = [](const Json& s) { return s["tick"]["command_n"] > 0.05; };
    until("the device to be driven", pushed);
    lookAtTheOneInTheList(file);
    const Json open = until("the recording",
                            [](const Json& s) { return looking(s) && timeline(s)["tick_complete"] == true; });
    const auto ticks = timeline(open)["ticks"].get<int64_t>();
    EXPECT_GT(ticks, 3000);
    EXPECT_EQ(timeline(open)["cursor_tick"], 0);
    EXPECT_EQ(timeline(open)["model_is_open"], true);
    EXPECT_EQ(timeline(open)["file"], file);
    EXPECT_TRUE(open["widgets"].contains("backToLive"));
    for (int i = 0; i < 4; ++i) {
        const Json s = later();
        EXPECT_EQ(s["tick"]["command_n"], 0.0) << "the live hand touches, and nothing pushes back";
    }
    // Scrubbed with the pointer.
    display_.drag(onTimeline(0.2), onTimeline(0.5));
    // By its time: where the servo has passed over deadlines, half of the ticks are not half of it.
    const auto share = [](const Json& s) {
        return timeline(s)["cursor_s"].get<double>() / timeline(s)["length_s"].get<double>();
    };
    until("the cursor in the middle", [&](const Json& s) { return std::abs(share(s) - 0.5) < 0.02; });
    const Json shown = until("the tick to be touched again", [](const Json& s) {
        return timeline(s)["tick_complete"] == true && timeline(s)["tick"]["number"] > 0;
    });
    EXPECT_NEAR(timeline(shown)["force_n"].get<double>(),
                std::hypot(timeline(shown)["tick"]["force"][0].get<double>(),
                           timeline(shown)["tick"]["force"][1].get<double>(),
                           timeline(shown)["tick"]["force"][2].get<double>()),
                1e-4);
    // By keys, once the pointer has let go.
    const auto at = timeline(later())["cursor_tick"].get<int64_t>();
    display_.key("Left");
    const auto back = timeline(cursor([&](int64_t c) { return c < at; }))["cursor_tick"].get<int64_t>();
    EXPECT_GE(back, at - 20) << "a tick, or some where the key was held for long";
    display_.key("shift+Right");
    (void)cursor([&](int64_t c) { return c >= back + 90; });
    const double yaw = later()["view"]["yaw"];
    display_.key("Home");
    (void)cursor([](int64_t c) { return c == 0; });
    EXPECT_EQ(later()["view"]["yaw"], yaw) << "those keys are not the camera's now";
    // Played between two marks.
    display_.click(onTimeline(0.4));
    (void)cursor([](int64_t c) { return c > 0; });
    display_.key("a");
    until("a mark", [](const Json& s) { return timeline(s)["begin_tick"] > 0; });
    display_.click(onTimeline(0.7));
    until("the cursor behind the middle", [&](const Json& s) { return share(s) > 0.5; });
    display_.key("b");
    const Json loop = until("a loop", [](const Json& s) { return timeline(s)["loops"] == true; });
    display_.key("k");
    const auto begin = timeline(loop)["begin_tick"].get<int64_t>(),
               end = timeline(loop)["end_tick"].get<int64_t>();
    std::set<int64_t> seen;
    for (int i = 0; i < 8; ++i) {
        const Json s = later();
        EXPECT_EQ(timeline(s)["playing"], true);
        seen.insert(timeline(s)["cursor_tick"].get<int64_t>());
    }
    EXPECT_GE(*seen.begin(), begin);
    EXPECT_LE(*seen.rbegin(), end);
    EXPECT_GT(seen.size(), 4u) << "it goes on";
    display_.key("k");
    until("a pause", [](const Json& s) { return timeline(s)["playing"] == false; });
    display_.key("shift+a");
    until("no loop", [](const Json& s) { return timeline(s)["loops"] == false; });

    display_.click(middleOf("verify"));
    const Json verified =
        until("the verdict", [](const Json& s) { return timeline(s)["verified"] != nullptr; });
    EXPECT_EQ(timeline(verified)["verified"]["equal"], true) << timeline(verified);
    EXPECT_EQ(timeline(verified)["verified"]["text"],
              "equal to the last bit in " + std::to_string(ticks) + " ticks");

    // The same hand without friction: less force, all of it along the normal.
    display_.click(middleOf("friction"));
    until("no friction", [](const Json& s) { return s["settings"]["friction"] == "off"; });
    const auto list = [](const Json& s) { return s["widgets"].at("recordings"); };
    const Json place = list(later());
    display_.click(middleOf("touchAgain"));
    EXPECT_EQ(list(until("it to run", [](const Json& s) { return timeline(s)["again"]["running"] == true; })),
              place)
        << "Stop does not push List from under the pointer";
    const Json again = until("it to be touched again", [](const Json& s) {
        return timeline(s)["again"]["running"] == false && timeline(s)["again"]["ticks"] > 1000;
    });
    EXPECT_GT(timeline(again)["again"]["now_n"], 0.05);
    EXPECT_LT(timeline(again)["again"]["now_n"], timeline(again)["again"]["recorded_n"]);
    EXPECT_EQ(again["tick"]["command_n"], 0.0);

    display_.key("Escape");
    const Json live = until("the live hand", [&](const Json& s) { return !looking(s) && pushed(s); });
    EXPECT_FALSE(live["widgets"].contains("backToLive"));
    EXPECT_TRUE(live["widgets"].contains("charts"));
    expectCleanEnd();
}

TEST_F(TimelineWindow, RecordingsAreRenamedAndDeletedAndWhatCannotBeIsTold) {
    const std::filesystem::path folder = scratch_ / "state/touchstone/recordings";
    std::filesystem::create_directories(folder);
    for (const char* name : {"one.tsrec", "two.tsrec"})
        touchOffline(TOUCHSTONE_ASSETS "/box.glb", folder / name);
    open(TOUCHSTONE_ASSETS "/box.glb");
    display_.click(middleOf("recorded"));
    const auto rows = [](const std::string& with, const std::string& without) {
        return [=](const Json& s) {
            return s["widgets"].contains("recording:" + with + ".tsrec") &&
                   !s["widgets"].contains("recording:" + without + ".tsrec");
        };
    };
    const auto shown = [](const char* name) {
        return [=](const Json& s) { return s["widgets"].contains(name); };
    };
    const auto outcome = [this](const std::string& text, bool failed) {
        return until(text, [&](const Json& s) {
            return s["list"]["outcome"].get<std::string>().find(text) != std::string::npos &&
                   s["list"]["failed"] == failed;
        });
    };
    const auto rename = [&](const std::string& from, const std::string& to) {
        display_.click(middleOf("rename:" + from + ".tsrec"));
        until("the name's field", shown("recordingName"));
        later();
        display_.xdotool({"type", "--delay", "20", to});
        display_.key("Return");
    };
    until("both", rows("one", "none"));
    until("both", rows("two", "none"));
    rename("one", "two");
    outcome("there is another two.tsrec", true);
    rename("one", "x/y");
    outcome("no slash", true);
    rename("one", "ribs");
    outcome("renamed to ribs", false);
    until("the new name", rows("ribs", "one"));
    EXPECT_TRUE(std::filesystem::exists(folder / "ribs.tsrec"));

    display_.click(middleOf("delete:two.tsrec"));
    until("the question", shown("deleteNo"));
    display_.click(middleOf("deleteNo"));
    until("no question", [&](const Json& s) { return !shown("deleteNo")(s); });
    EXPECT_TRUE(std::filesystem::exists(folder / "two.tsrec"));
    display_.click(middleOf("delete:two.tsrec"));
    until("the question", shown("deleteYes"));
    display_.click(middleOf("deleteYes"));
    until("it to be gone", rows("ribs", "two"));
    EXPECT_FALSE(std::filesystem::exists(folder / "two.tsrec"));

    display_.click(middleOf("recording:ribs.tsrec"));
    until("it to be open", looking);
    display_.click(middleOf("recordings"));
    until("the list", shown("delete:ribs.tsrec"));
    display_.click(middleOf("delete:ribs.tsrec"));
    until("the question", shown("deleteYes"));
    display_.click(middleOf("deleteYes"));
    outcome("ribs.tsrec: is open", true);
    EXPECT_TRUE(std::filesystem::exists(folder / "ribs.tsrec"));
    expectCleanEnd();
}

TEST_F(TimelineWindow, WhatIsBrokenOrHasLostItsModelIsToldAndNothingElseChanges) {
    std::filesystem::copy_file(TOUCHSTONE_ASSETS "/box.glb", scratch_ / "mine.glb");
    const std::filesystem::path good = scratch_ / "good.tsrec", cut = scratch_ / "cut.tsrec",
                                bad = scratch_ / "bad.tsrec", gone = scratch_ / "gone.tsrec";
    touchOffline(scratch_ / "mine.glb", good);
    const std::string whole = readFile(good);
    writeTextFile(cut, whole.substr(0, whole.size() / 2));
    writeTextFile(bad, "this was no recording");
    std::filesystem::copy_file(TOUCHSTONE_ASSETS "/plane.glb", scratch_ / "away.glb");
    touchOffline(scratch_ / "away.glb", gone);
    std::filesystem::remove(scratch_ / "away.glb");

    open(kDoughnut);
    openByPath(bad.string());
    const Json told = until("the problem", [](const Json& s) { return s["problem"] != ""; });
    EXPECT_NE(told["problem"].get<std::string>().find("is no recording"), std::string::npos);
    EXPECT_FALSE(looking(told));
    EXPECT_EQ(told["model"], "doughnut.glb");

    openByPath(good.string());
    const Json opened = until("recording and model", [](const Json& s) {
        return looking(s) && s["model"] == "mine.glb" && timeline(s)["tick_complete"] == true;
    });
    EXPECT_EQ(timeline(opened)["ticks"], 1500);
    EXPECT_EQ(opened["problem"], "");
    openByPath(bad.string());
    const Json still = until("the problem", [](const Json& s) { return s["problem"] != ""; });
    EXPECT_EQ(timeline(still)["file"], good.string()) << "what was looked at is still there";

    display_.drop("Touchstone", cut);
    const Json half = until("what is left of it",
                            [&](const Json& s) { return looking(s) && timeline(s)["file"] == cut.string(); });
    EXPECT_LT(timeline(half)["ticks"], 1500);
    EXPECT_NE(timeline(half)["notes"].dump().find("cut off"), std::string::npos);

    openByPath(gone.string());
    const Json curves =
        until("the curves", [&](const Json& s) { return timeline(s)["file"] == gone.string(); });
    const Json after = later();
    EXPECT_EQ(timeline(after)["model_is_open"], false);
    EXPECT_EQ(after["model"], "mine.glb");
    EXPECT_NE(timeline(after)["notes"].dump().find("away.glb was touched and is not there"),
              std::string::npos)
        << timeline(after)["notes"];
    display_.click(middleOf("backToLive"));
    until("the live hand", [](const Json& s) { return !looking(s); });
    expectCleanEnd();
}

TEST_F(TimelineWindow, UnsavedMaterialsAreAskedForBeforeItsModelIsOpened) {
    size_ = kTall;
    touchOffline(TOUCHSTONE_ASSETS "/box.glb", scratch_ / "r.tsrec");
    open(kDoughnut);
    display_.key("e");
    until("the editor", [](const Json& s) { return s["widgets"].contains("edit.staticFriction"); });
    slide("edit.staticFriction", 0.8);
    until("an edit", [](const Json& s) { return s["materials"]["edited"].get<bool>(); });
    display_.drop("Touchstone", scratch_ / "r.tsrec");
    const auto asked = [](const Json& s) {
        return s["leaving"].get<bool>() && s["widgets"].contains("leaveStay");
    };
    until("the question", asked);
    later();
    display_.click(middleOf("leaveStay"));
    const Json stayed = until("to stay", [](const Json& s) { return !s["leaving"].get<bool>(); });
    EXPECT_TRUE(looking(stayed)) << "its curves are shown";
    EXPECT_EQ(timeline(stayed)["model_is_open"], false);
    EXPECT_EQ(stayed["model"], "doughnut.glb");
    EXPECT_NE(timeline(stayed)["notes"].dump().find("box.glb was touched and is not open"),
              std::string::npos);
    display_.key("e"); // out of the way
    until("no editor", [](const Json& s) { return !s["widgets"].contains("edit.staticFriction"); });
    display_.click(middleOf("openModel"));
    until("the question", asked);
    later();
    display_.click(middleOf("leaveDiscard"));
    until("its model",
          [](const Json& s) { return s["model"] == "box.glb" && timeline(s)["model_is_open"] == true; });
    expectCleanEnd();
}

TEST_F(TimelineWindow, IsOpenedFromTheCommandLine) {
    touchOffline(TOUCHSTONE_ASSETS "/moving.glb", scratch_ / "r.tsrec");
    open((scratch_ / "r.tsrec").string());
    const Json opened = until("recording and model", [](const Json& s) {
        return looking(s) && s["model"] == "moving.glb" && timeline(s)["tick_complete"] == true;
    });
    EXPECT_EQ(timeline(opened)["ticks"], 1500);
    expectCleanEnd();

    writeTextFile(scratch_ / "bad.tsrec", "this was no recording");
    Environment environment = display_.environment();
    environment.emplace_back("XDG_STATE_HOME=" + (scratch_ / "state").string());
    const ProgramResult bad = runProgram({TOUCHSTONE_BINARY, (scratch_ / "bad.tsrec").string()}, environment);
    EXPECT_EQ(bad.status, 1);
    EXPECT_NE(bad.err.find("bad.tsrec: is no recording"), std::string::npos) << bad.err;
}

/// The balls of a cradle swing while the hand is far: they are shown where they were at the cursor's time,
/// and at its beginning again where they began.
TEST_F(TimelineWindow, ShowsTheBodiesOfTheTimeUnderTheCursor) {
    touchOffline(TOUCHSTONE_ASSETS "/cradle.glb", scratch_ / "r.tsrec");
    open((scratch_ / "r.tsrec").string());
    const auto known = [](const Json& s) {
        return looking(s) && timeline(s)["tick_complete"] == true && !timeline(s)["bodies"].empty();
    };
    until("recording, model and bodies", known);
    const auto lookAt = [&](double share) {
        display_.click(onTimeline(share));
        later();
        return timeline(until("the bodies there", known));
    };
    const auto farthest = [](const Json& a, const Json& b) {
        double most = 0.0;
        EXPECT_EQ(a["bodies"].size(), b["bodies"].size());
        for (size_t body = 0; body < a["bodies"].size(); ++body)
            for (size_t axis = 0; axis < 3; ++axis)
                most = std::max(most, std::abs(a["bodies"][body][axis].get<double>() -
                                               b["bodies"][body][axis].get<double>()));
        return most;
    };
    const Json begin = lookAt(0.02), after = lookAt(0.6), again = lookAt(0.02);
    EXPECT_GT(farthest(begin, after), 2e-3);
    EXPECT_EQ(begin["cursor_tick"], again["cursor_tick"]);
    EXPECT_EQ(farthest(begin, again), 0.0);
    expectCleanEnd();
}

/// A client lifts the box while a simulated hand strokes it: it is shown where it was at the cursor's time.
TEST_F(TimelineWindow, ShowsMovedObjectsOfTheTimeUnderTheCursor) {
    const std::string file = (scratch_ / "r.tsrec").string();
    {
        const ts::Scene scene(TOUCHSTONE_ASSETS "/box.glb", TS_FIT_WORKSPACE);
        ts_object_info box = TS_STRUCT(ts_object_info);
        ts::check(ts_scene_object(scene.get(), 0, &box));
        ts_pose lifted = TS_STRUCT(ts_pose);
        std::copy_n(box.centre, 3, lifted.position);
        lifted.position[1] += 0.03;
        lifted.speed = 0.03;
        ts::Session session("stroke");
        session.touch(scene);
        session.record(file);
        session.start();
        session.run(0.5, [](const ts_state&) { return true; });
        session.move(0, lifted);
        session.run(1.5, [](const ts_state&) { return true; });
        session.stop();
        session.endRecording();
    }
    open(file);
    const auto lookAt = [&](double share, bool moved) {
        display_.click(onTimeline(share));
        later();
        return timeline(until("the objects there", [&](const Json& s) {
            return looking(s) && timeline(s)["tick_complete"] == true &&
                   timeline(s)["moved"].empty() != moved;
        }));
    };
    until("recording and model",
          [](const Json& s) { return looking(s) && timeline(s)["tick_complete"] == true; });
    const Json after = lookAt(0.95, true), before = lookAt(0.02, false), again = lookAt(0.95, true);
    EXPECT_EQ(after["moved"][0]["object"], 0);
    EXPECT_EQ(after["moved"], again["moved"]);
    const Json way = lookAt(0.35, true); // on its way, which takes a second
    EXPECT_LT(way["moved"][0]["position"][1], after["moved"][0]["position"][1]);
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::timeline_window_tests
