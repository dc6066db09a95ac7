// The window around the picture: what is folded, opened, saved and kept, and figures that move with the
// configurations.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <thread>

namespace touchstone::test::layout_window_tests {
namespace {

const std::string kDoughnut = TOUCHSTONE_ASSETS "/doughnut.glb";

class LayoutTest : public WindowTest {
  protected:
    LayoutTest() { size_ = kTall; }
    /// The figures look back on some seconds: waits until they hold nothing of before.
    Json settled(const std::function<bool(const Json&)>& holds) {
        std::this_thread::sleep_for(std::chrono::seconds(5));
        return until("figures that are settled", holds);
    }
    /// Arrow by arrow, each towards it from where the keyboard is; a slow frame may take one for two.
    void walkTo(const std::string& widget) {
        for (int i = 0; i < 40; ++i) {
            const Json widgets = later()["widgets"];
            const Json &to = widgets.at(widget), from = widgets.value("focused", Json::object());
            if (from == to)
                return;
            const auto side = [&](const char* axis) {
                return to[axis].get<double>() - from.value(axis, 0.0);
            };
            if (std::abs(side("y")) > 4.0)
                display_.key(side("y") > 0.0 ? "Down" : "Up");
            else
                display_.key(side("x") > 0.0 ? "Right" : "Left");
        }
        FAIL() << "the arrows lead to no " << widget;
    }
};

TEST_F(LayoutTest, MovingARungMovesWhatItCostsAndHowFarFromExactItIs) {
    open(kDoughnut, {"--hand", "simulated", "--set", "textureFilter=bicubic", "--set", "friction=off"});
    const auto compared = [](const Json& s) { return s["error"]["ticks_in_contact"] > 500; };
    const Json exact = settled(compared);
    EXPECT_EQ(exact["error"]["position_m"]["p99"], 0.0);
    EXPECT_EQ(exact["error"]["force_n"]["p99"], 0.0);
    EXPECT_TRUE(exact["error"]["below_perception"]);
    double stages = 0.0;
    for (const auto& [name, stage] : exact["stages"].items())
        stages += name == "step" ? 0.0 : stage["p50_us"].get<double>();
    EXPECT_GT(stages, 0.0);
    EXPECT_GT(exact["stages"]["shading"]["p99_us"], 0.0);

    display_.click(middleOf("forceShading"));
    until("shading to be off", [](const Json& s) { return s["settings"]["forceShading"] == "off"; });
    const Json coarse = settled(compared);
    EXPECT_GT(coarse["error"]["position_m"]["p50"], 1e-7) << "the facets are felt";
    EXPECT_GT(coarse["error"]["direction_rad"]["p99"], 1e-3);
    EXPECT_NE(coarse["stages"]["shading"], exact["stages"]["shading"]);
    expectCleanEnd();
}

TEST_F(LayoutTest, PanelsFoldAwayAndThePictureTakesTheirRoom) {
    open(kDoughnut);
    const auto width = [](const Json& s) { return s["widgets"]["picture"]["width"].get<double>(); };
    const double narrow = width(status());
    display_.key("F2");
    const Json left =
        until("the scene to be folded", [](const Json& s) { return s["folded"]["scene"] == true; });
    EXPECT_GT(width(left), narrow + 150.0);
    EXPECT_FALSE(left["widgets"].contains("mouse"));
    display_.key("Tab");
    until("all to be folded", [](const Json& s) {
        return s["folded"]["scene"] == true && s["folded"]["felt"] == true && s["folded"]["charts"] == true;
    });
    display_.click(middleOf("fold:felt"));
    until("what is felt to be back", [](const Json& s) { return s["folded"]["felt"] == false; });
    display_.key("F1");
    until("the help", [](const Json& s) { return s["help"] == true; });
    display_.key("Escape");
    until("no help", [](const Json& s) { return s["help"] == false; });
    expectCleanEnd();
}

TEST_F(LayoutTest, SidePanelsAreMadeWiderByTheirEdgesAndKept) {
    open(kDoughnut);
    const auto picture = [](const Json& s, const char* of) {
        return s["widgets"]["picture"][of].get<double>();
    };
    const Json before = later();
    // An edge is 6 units wide; middleOf points 12 into a widget.
    const auto onEdge = [&](const char* edge) {
        const VirtualDisplay::Place place = middleOf(edge);
        return VirtualDisplay::Place{place.x - 9, place.y};
    };
    for (const auto& [edge, by] : {std::pair{"sceneEdge", 60}, std::pair{"feltEdge", -40}}) {
        const VirtualDisplay::Place from = onEdge(edge);
        display_.drag(from, {from.x + by, from.y});
    }
    until("wider panels", [&](const Json& s) {
        return picture(s, "x") > picture(before, "x") + 50.0 &&
               picture(s, "width") < picture(before, "width") - 85.0;
    });
    // Far beyond the other side: the picture keeps its least width. Then far to the left: the panel its own.
    const VirtualDisplay::Place edge = onEdge("sceneEdge");
    display_.drag(edge, {edge.x + 900, edge.y});
    EXPECT_GE(picture(later(), "width"), 320.0);
    const VirtualDisplay::Place far = onEdge("sceneEdge");
    display_.drag(far, {corner_.x, far.y});
    EXPECT_EQ(picture(later(), "x"), picture(before, "x"));
    const double width = picture(status(), "width");
    expectCleanEnd();
    open(kDoughnut);
    EXPECT_EQ(picture(later(), "width"), width) << "kept";
    expectCleanEnd();
}

TEST_F(LayoutTest, PanelsAreWalkedThroughByKeys) {
    open(kDoughnut);
    const auto yaw = [](const Json& s) { return s["view"]["yaw"].get<double>(); };
    display_.key("F10");
    until("the panels to have the arrows", [](const Json& s) { return s["walking"] == true; });
    const double before = yaw(later());
    walkTo("simulatedHand");
    display_.key("Return");
    until("another hand", [](const Json& s) { return s["hand"] == "simulated"; });
    EXPECT_EQ(yaw(status()), before) << "the arrows belong to the panels";
    display_.key("space");
    until("the force to be off", [](const Json& s) { return s["settings"]["forceEnabled"] == "off"; });
    EXPECT_EQ(status()["hand"], "simulated") << "space presses nothing";
    display_.key("Escape");
    until("the view to have the arrows", [](const Json& s) { return s["walking"] == false; });
    display_.key("Right");
    until("another view", [&](const Json& s) { return yaw(s) != before; });
    expectCleanEnd();
}

TEST_F(LayoutTest, WhatWasChosenIsThereInTheNextRun) {
    open(kDoughnut);
    // The card moves while the window finds its size, which takes longer beside other tests: a click where it
    // was meets nothing.
    for (int i = 0; i < 20 && status()["widgets"].contains("gotIt"); ++i) {
        display_.click(middleOf("gotIt"));
        std::this_thread::sleep_for(std::chrono::milliseconds(500));
    }
    until("the card to be gone", [](const Json& s) { return s["introduced"] == true; });
    display_.click(middleOf("friction"));
    until("friction to be off", [](const Json& s) { return s["settings"]["friction"] == "off"; });
    display_.key("F4");
    until("the charts to be folded", [](const Json& s) { return s["folded"]["charts"] == true; });
    expectCleanEnd();
    open(kDoughnut);
    const Json again = later();
    EXPECT_EQ(again["settings"]["friction"], "off");
    EXPECT_EQ(again["folded"]["charts"], true);
    EXPECT_EQ(again["introduced"], true);
    EXPECT_FALSE(again["widgets"].contains("gotIt"));
    expectCleanEnd();

    // What the command line says goes over that, also where it is the usual thing, and leaves the rest.
    open(kDoughnut, {"--set", "texture=off"});
    EXPECT_EQ(later()["settings"]["friction"], "off");
    EXPECT_EQ(status()["settings"]["texture"], "off");
    expectCleanEnd();
    open(kDoughnut, {"--set", "friction=zilles"});
    EXPECT_EQ(later()["settings"]["friction"], "zilles");
    EXPECT_EQ(status()["settings"]["texture"], "off") << "kept from the run before";
    expectCleanEnd();
    size_ = "1280x800"; // what a first run has; kept is 1000x780
    open(kDoughnut);
    EXPECT_NE(
        display_.xdotool({"search", "--onlyvisible", "--name", "Touchstone", "getwindowgeometry", "--shell"})
            .find("WIDTH=1280\nHEIGHT=800"),
        std::string::npos);
    expectCleanEnd();

    // A file that says nothing.
    std::ofstream(scratch_ / "state/touchstone/window.json") << "{ \"version\": 1, \"folded\": [";
    open(kDoughnut);
    EXPECT_EQ(later()["settings"]["friction"], "zilles");
    expectCleanEnd();
}

TEST_F(LayoutTest, TypeGrowsByKeysAsFarAsItFitsAndIsKept) {
    open(kDoughnut, {"--ui-scale", "1"});
    const auto height = [](const Json& s) { return s["widgets"]["file"]["height"].get<double>(); };
    const double before = height(later());
    display_.key("ctrl+shift+plus");
    const Json larger = until("larger type", [](const Json& s) { return s["ui_scale"]["scale"] == 1.25; });
    EXPECT_NEAR(height(larger), 1.25 * before, 2.0);
    EXPECT_EQ(larger["ui_scale"]["fits"], true);
    for (int i = 0; i < 3; ++i)
        display_.key("ctrl+shift+plus");
    const Json most = until("what does not fit", [](const Json& s) { return s["ui_scale"]["asked"] == 2.0; });
    EXPECT_EQ(most["ui_scale"]["scale"], 1.5) << "1000 x 780 has no more than 666 x 520 units";
    EXPECT_EQ(most["ui_scale"]["fits"], false);
    display_.key("ctrl+shift+minus");
    until("the one asked for before", [](const Json& s) { return s["ui_scale"]["asked"] == 1.75; });
    expectCleanEnd();
    open(kDoughnut);
    EXPECT_EQ(later()["ui_scale"]["asked"], 1.75) << "kept";
    expectCleanEnd();
}

TEST_F(LayoutTest, AnAbsurdScaleOrSizeIsRefusedOrClampedWithAWarning) {
    for (const char* scale : {"0", "-1", "1e9", "nan", "two"}) {
        const ProgramResult result = runProgram(
            {TOUCHSTONE_BINARY, kDoughnut, std::string("--ui-scale=") + scale}, display_.environment());
        EXPECT_EQ(result.status, 2) << scale;
        EXPECT_NE(result.err.find("write a number from 0.75 to 4"), std::string::npos) << result.err;
    }
    std::filesystem::create_directories(scratch_ / "state/touchstone");
    std::ofstream(scratch_ / "state/touchstone/window.json")
        << R"({"version": 1, "ui_scale": -1e9, "introduced": true})";
    size_ = "1x1";
    open(kDoughnut);
    const Json small = later();
    EXPECT_EQ(small["ui_scale"]["asked"], 0.75);
    EXPECT_EQ(small["introduced"], true);
    expectCleanEnd();
    EXPECT_NE(readFile(scratch_ / "log").find("UI scale"), std::string::npos);
    EXPECT_NE(readFile(scratch_ / "log").find("it is opened as 640x400"), std::string::npos);

    std::ofstream(scratch_ / "state/touchstone/window.json") << R"({"version": 7, "ui_scale": 3})";
    size_ = "8192x8192";
    open(kDoughnut);
    const Json large = later();
    EXPECT_EQ(large["ui_scale"]["asked"], 1.0);
    EXPECT_EQ(large["introduced"], false);
    expectCleanEnd();
    EXPECT_NE(readFile(scratch_ / "log").find("its version is 7, not 1"), std::string::npos);
    EXPECT_NE(readFile(scratch_ / "log").find("it is opened as 1280x800"), std::string::npos);
}

TEST_F(LayoutTest, AControlTellsWhatItDoesWhereThePointerRests) {
    open(kDoughnut);
    display_.move(middleOf("texture"));
    const Json told = until("the tooltip", [](const Json& s) { return s["tooltip"] != ""; });
    EXPECT_EQ(told["tooltip"], told["widgets"]["texture"]["note"]);
    EXPECT_NE(told["tooltip"].get<std::string>().find("--set texture="), std::string::npos);
    for (const auto& [name, rect] : told["widgets"].items())
        EXPECT_TRUE(name == "picture" || rect["note"] != "") << name;
    display_.move(inPicture(0.5, 0.5));
    until("no tooltip", [](const Json& s) { return s["tooltip"] == ""; });
    expectCleanEnd();
}

TEST_F(LayoutTest, AFileThatIsWrongIsToldAndTheOldModelStays) {
    open(kDoughnut);
    const std::string bad = (scratch_ / "bad.glb").string();
    std::ofstream(bad) << "this is no model";
    openByPath(bad);
    const Json told = until("the problem", [](const Json& s) { return s["problem"] != ""; });
    EXPECT_NE(told["problem"].get<std::string>().find("bad.glb"), std::string::npos);
    EXPECT_EQ(told["model"], "doughnut.glb");
    display_.click(middleOf("dismiss"));
    until("no problem", [](const Json& s) { return s["problem"] == ""; });
    openByPath(TOUCHSTONE_ASSETS "/box.glb");
    until("the box", [](const Json& s) { return s["model"] == "box.glb"; });
    expectCleanEnd();
}

TEST_F(LayoutTest, ChartsPauseAndAreSaved) {
    open(kDoughnut, {"--hand", "simulated"});
    until("some contact", [](const Json& s) { return s["recent"]["in_contact"].get<bool>(); });
    display_.key("p");
    until("the charts to stand", [](const Json& s) { return s["charts_paused"] == true; });
    const auto saved = [&](const std::string& button, const std::string& ending) -> std::string {
        display_.click(middleOf(button));
        return until("the file", [&](const Json& s) {
            return s["charts"]["saved"].get<std::string>().ends_with(ending);
        })["charts"]["saved"];
    };
    const std::string text = readFile(saved("saveCsv", ".csv"));
    EXPECT_TRUE(text.starts_with("t,force,tangential,penetration,energy,step,contact,recorded,surface_normal,"
                                 "surface_tangential,force_x,force_y,force_z\n"));
    EXPECT_GT(std::ranges::count(text, '\n'), 500);
    EXPECT_NE(text.find(",1,0,"), std::string::npos) << "in contact, not recorded";
    EXPECT_EQ(status()["notice"], "") << "a confirmation is no warning";
    EXPECT_TRUE(later()["widgets"].contains("chartOutcome")) << "it stands beside the buttons";
    EXPECT_GT(std::filesystem::file_size(saved("savePng", ".png")), 2000u);
    const std::string svg = readFile(saved("saveSvg", ".svg"));
    for (const char* words : {"tangential", "force, N", "time before the last tick, s"})
        EXPECT_NE(svg.find(words), std::string::npos) << words;
    expectCleanEnd();
}

// Beside other programs a frame took a tenth of a second, and a drag began where the pointer had gone in it:
// beside the edge.
TEST_F(LayoutTest, AnEdgeIsDraggedWithinOneFrameFromWhereItWasPressedToWhereItWasLetGo) {
    open(kDoughnut);
    const Json rect = restingPlace("chartsEdge");
    const VirtualDisplay::Place edge{
        corner_.x + static_cast<int>(rect["x"].get<double>() + 0.5 * rect["width"].get<double>()),
        corner_.y + static_cast<int>(rect["y"].get<double>() + 0.5 * rect["height"].get<double>())};
    const double before = status()["charts"]["height"];
    program_->send(SIGSTOP);
    display_.drag(edge, {edge.x, edge.y - 100});
    program_->send(SIGCONT);
    const Json taller =
        until("taller charts", [&](const Json& s) { return s["charts"]["height"] > before + 50.0; });
    EXPECT_NEAR(taller["charts"]["height"].get<double>(), before + 100.0, 4.0);
    expectCleanEnd();
}

TEST_F(LayoutTest, StripsAreChosenMadeTallerAndKept) {
    open(kDoughnut);
    const auto height = [](const Json& s) { return s["widgets"]["charts"]["height"].get<double>(); };
    const Json before = later();
    EXPECT_EQ(before["charts"]["shown"], (Json{"normal", "tangential", "depth"}));
    const Json edge = restingPlace("chartsEdge");
    const VirtualDisplay::Place from{
        corner_.x + static_cast<int>(edge["x"].get<double>() + 0.5 * edge["width"].get<double>()),
        corner_.y + static_cast<int>(edge["y"].get<double>() + 0.5 * edge["height"].get<double>())};
    display_.drag(from, {from.x, from.y - 100});
    const Json taller =
        until("taller strips", [&](const Json& s) { return height(s) > height(before) + 80.0; });
    EXPECT_LT(taller["widgets"]["picture"]["height"], before["widgets"]["picture"]["height"]);
    display_.click(middleOf("strips"));
    for (const char* name : {"strip:x", "strip:depth"}) {
        until("the menu", [&](const Json& s) { return s["widgets"].contains(name); });
        display_.click(middleOf(name));
    }
    until("other strips", [](const Json& s) {
        return s["charts"]["shown"] == Json{"normal", "tangential", "x"};
    });
    display_.key("Escape");
    // Far beyond the window's top: the picture keeps some room.
    const Json now = restingPlace("chartsEdge");
    const VirtualDisplay::Place edgeNow{from.x, corner_.y + static_cast<int>(now["y"].get<double>() + 3.0)};
    display_.drag(edgeNow, {from.x, corner_.y});
    EXPECT_GE(later()["widgets"]["picture"]["height"], 180.0);
    const double kept = status()["charts"]["height"];
    expectCleanEnd();
    open(kDoughnut);
    const Json again = later();
    EXPECT_EQ(again["charts"]["shown"], (Json{"normal", "tangential", "x"}));
    EXPECT_EQ(again["charts"]["height"], kept);
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::layout_window_tests
