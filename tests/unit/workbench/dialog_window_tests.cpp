// Files chosen and meshes opened in the real window.

#include "tests/support/mesh_files.h"
#include "tests/unit/workbench/window_test.h"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <thread>

namespace touchstone::test::dialog_window_tests {
namespace {

class DialogWindow : public WindowTest {
  protected:
    DialogWindow() {
        environment_.emplace_back("HOME=" + scratch_.path().string());
        write("Ring.STL", tetrahedronBinaryStl());
        write("notes.txt", bytesOf("no model"));
        write("broken.ply", tetrahedronBinaryPly("1000000000"));
    }
    void write(const std::string& name, const Bytes& bytes) {
        std::ofstream(scratch_ / name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    /// A zenity of the test's own, first in PATH.
    void useZenity(const std::string& script) {
        std::filesystem::create_directory(scratch_ / "bin");
        writeTextFile(scratch_ / "bin/zenity", "#!/bin/sh\n" + script + "\n");
        std::filesystem::permissions(scratch_ / "bin/zenity", std::filesystem::perms::owner_all);
        environment_.emplace_back("PATH=" + (scratch_ / "bin").string() + ":/usr/bin:/bin");
        environment_.emplace_back("TOUCHSTONE_FILE_DIALOG=zenity");
    }
    void untilRingIsOpen() {
        until("the mesh",
              [](const Json& s) { return s["model"] == "Ring.STL" && !s["loading"].get<bool>(); });
    }
    void browse() {
        display_.key("ctrl+o");
        until("the browser", [](const Json& s) { return s["widgets"].contains("openPath"); });
    }
};

TEST_F(DialogWindow, AMeshIsChosenInTheBrowserAndAProblemLeavesItThere) {
    open(TOUCHSTONE_ASSETS "/box.glb");
    browse();
    display_.xdotool({"type", "--delay", "20", "/"});
    display_.key("Return");
    until("the root", [](const Json& s) { return s["widgets"].contains("file:etc"); });
    display_.xdotool({"type", "--delay", "20", "~"});
    display_.key("Return");
    const Json home =
        until("the home folder", [](const Json& s) { return s["widgets"].contains("file:Ring.STL"); });
    EXPECT_FALSE(home["widgets"].contains("file:notes.txt")) << "no model";
    display_.xdotool({"type", "--delay", "20", "ring"});
    until("the filter", [](const Json& s) {
        return s["widgets"].contains("file:Ring.STL") && !s["widgets"].contains("file:broken.ply");
    });
    display_.key("Return");
    untilRingIsOpen();
    (void)display_.waitForWindow("Ring.STL");

    openByPath("~/broken.ply");
    const Json failed = until("the problem", [](const Json& s) { return s["problem"] != ""; });
    EXPECT_NE(failed["problem"].get<std::string>().find("broken.ply"), std::string::npos)
        << failed["problem"];
    EXPECT_EQ(failed["model"], "Ring.STL");
    expectCleanEnd();
}

// Beside other programs a frame took a quarter of a second, and a text field gets the keyboard two frames
// after it is asked for.
TEST_F(DialogWindow, WhatIsTypedBeforeTheFieldHasTheKeyboardIsNotLost) {
    open(TOUCHSTONE_ASSETS "/box.glb");
    program_->send(SIGSTOP);
    display_.key("ctrl+o");
    display_.xdotool({"type", "--delay", "20", "/"});
    display_.key("Return");
    display_.xdotool({"type", "--delay", "20", "~/"});
    display_.key("Return");
    display_.xdotool({"type", "--delay", "20", "ring"});
    program_->send(SIGCONT);
    until("the folder and the filter", [](const Json& s) {
        return s["widgets"].contains("file:Ring.STL") && !s["widgets"].contains("file:broken.ply");
    });
    display_.key("Return");
    untilRingIsOpen();
    expectCleanEnd();
}

// At two frames a second two clicks are taken by frames that lie further apart than a double click.
TEST_F(DialogWindow, ADoubleClickIsOneHoweverSlowTheFrames) {
    open(TOUCHSTONE_ASSETS "/box.glb");
    browse();
    until("the home folder", [](const Json& s) { return s["widgets"].contains("file:Ring.STL"); });
    const VirtualDisplay::Place ring = middleOf("file:Ring.STL");
    const std::jthread slow([&] {
        for (int frame = 0; frame < 16; ++frame) {
            program_->send(SIGSTOP);
            std::this_thread::sleep_for(std::chrono::milliseconds(400));
            program_->send(SIGCONT);
            std::this_thread::sleep_for(std::chrono::milliseconds(8));
        }
    });
    display_.xdotool({"mousemove", std::to_string(ring.x), std::to_string(ring.y), "click", "--repeat", "2",
                      "--delay", "100", "1"});
    untilRingIsOpen();
    expectCleanEnd();
}

TEST_F(DialogWindow, AfterAClickInTheBrowserOneTypesOn) {
    open(TOUCHSTONE_ASSETS "/box.glb");
    browse();
    until("the place", [](const Json& s) { return s["widgets"].contains("place:Home"); });
    display_.click(middleOf("place:Home"));
    until("the home folder", [](const Json& s) { return s["widgets"].contains("file:broken.ply"); });
    display_.xdotool({"type", "--delay", "20", "ring"});
    until("the filter", [](const Json& s) { return !s["widgets"].contains("file:broken.ply"); });
    display_.key("Return");
    untilRingIsOpen();
    expectCleanEnd();
}

TEST_F(DialogWindow, EscapePutsAwayTheHelpOverTheBrowserFirst) {
    open(TOUCHSTONE_ASSETS "/box.glb");
    browse();
    display_.key("F1");
    until("the help", [](const Json& s) { return s["help"] == true; });
    display_.key("Escape");
    until("no help", [](const Json& s) { return s["help"] == false; });
    EXPECT_TRUE(later()["widgets"].contains("openPath")) << "the browser lay below it";
    display_.key("Escape");
    until("no browser", [](const Json& s) { return !s["widgets"].contains("openPath"); });
    expectCleanEnd();
}

TEST_F(DialogWindow, AMeshIsDroppedAndSavedAsAGlb) {
    size_ = kTall;
    open(TOUCHSTONE_ASSETS "/box.glb");
    display_.drop("Touchstone", scratch_ / "Ring.STL");
    untilRingIsOpen();
    display_.key("e");
    until("the editor", [](const Json& s) { return s["widgets"].contains("edit.staticFriction"); });
    slide("edit.staticFriction", 0.8);
    until("an edit", [](const Json& s) { return s["materials"]["edited"].get<bool>(); });
    display_.key("ctrl+s"); // an STL has no place for it
    until("the name to be asked for", [](const Json& s) { return s["widgets"].contains("openPath"); });
    later();
    display_.key("ctrl+a");
    display_.xdotool({"type", "--delay", "20", "Bell.glb"});
    later();
    display_.key("Return");
    until("the new name", [](const Json& s) { return s["model"] == "Bell.glb"; });
    display_.key("F12");
    until("a picture of the new name",
          [&](const Json& s) { return s["view"]["picture"].get<std::string>().ends_with("/Bell-1.png"); });
    EXPECT_TRUE(readFile(scratch_ / "Bell.glb").starts_with("glTF"));
    EXPECT_TRUE(readFile(scratch_ / "Bell.glb").find("TOUCHSTONE_materials_haptic") != std::string::npos);
    expectCleanEnd();
}

TEST_F(DialogWindow, TheDesktopsDialogIsAskedAndMayHang) {
    // The first hangs, the second answers.
    useZenity("if [ -e '" + (scratch_ / "asked").string() + "' ]; then echo '" +
              (scratch_ / "Ring.STL").string() + "'; else touch '" + (scratch_ / "asked").string() +
              "'; exec sleep 1000; fi");
    open(TOUCHSTONE_ASSETS "/box.glb", {"--hand", "simulated"});
    display_.key("ctrl+o");
    until("the card", [](const Json& s) { return s["widgets"].contains("browseHere"); });
    const Json touching = until("touch to go on", [](const Json& s) { return s["tick"]["contacts"] > 0; });
    EXPECT_TRUE(touching["widgets"].contains("browseHere"));
    display_.click(middleOf("browseHere"));
    until("the browser", [](const Json& s) { return s["widgets"].contains("openPath"); });
    display_.key("Escape");
    until("nothing", [](const Json& s) { return !s["widgets"].contains("openPath"); });
    display_.key("ctrl+o");
    untilRingIsOpen();
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::dialog_window_tests
