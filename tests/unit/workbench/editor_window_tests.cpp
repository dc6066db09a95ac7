// Unsaved materials in the real window: they are asked for before they are lost.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace touchstone::test {
namespace {

class EditorWindow : public WindowTest {
  protected:
    /// A copy of the doughnut with another friction.
    void edit() {
        std::filesystem::copy_file(TOUCHSTONE_ASSETS "/doughnut.glb", model_);
        open(model_.string(), {"--hand", "simulated"});
        display_.key("e");
        until("the editor", [](const Json& s) { return s["widgets"].contains("edit.staticFriction"); });
        slide("edit.staticFriction", 0.8);
        until("an edit", [](const Json& s) { return s["materials"]["edited"].get<bool>(); });
    }
    void askToQuit() {
        display_.key("ctrl+q");
        until("the question",
              [](const Json& s) { return s["leaving"].get<bool>() && s["widgets"].contains("leaveSave"); });
        later();
    }

    std::filesystem::path model_ = scratch_ / "doughnut.glb";
};

TEST_F(EditorWindow, UnsavedMaterialsAreAskedForAndSavedBeforeTheEnd) {
    edit();
    const std::string before = readFile(model_);
    askToQuit();
    display_.click(middleOf("leaveStay"));
    until("to stay", [](const Json& s) { return !s["leaving"].get<bool>(); });
    EXPECT_TRUE(readFile(model_) == before) << "nothing is written unasked";
    askToQuit();
    display_.click(middleOf("leaveSave"));
    EXPECT_EQ(program_->wait(), 0) << readFile(scratch_ / "log");
    EXPECT_TRUE(readFile(model_) != before) << "it was saved";
}

TEST_F(EditorWindow, SavingUnderAnothersNameAsksFirst) {
    edit();
    const std::filesystem::path other = scratch_ / "other.glb";
    std::filesystem::copy_file(TOUCHSTONE_ASSETS "/box.glb", other);
    const std::string before = readFile(other);
    display_.click(middleOf("saveAs"));
    until("the name to be asked for", [](const Json& s) { return s["widgets"].contains("target"); });
    later(); // the buttons have made room for it
    display_.click(middleOf("target"));
    display_.key("ctrl+a");
    display_.xdotool({"type", "--delay", "20", other.string()});
    later();
    display_.key("Return");
    later();
    EXPECT_TRUE(readFile(other) == before) << "it is there already";
    display_.click(middleOf("saveTarget"));
    until("it to be saved",
          [&](const Json& s) { return s["materials"]["notice"] == "saved to " + other.string(); });
    EXPECT_TRUE(readFile(other) != before);
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test
