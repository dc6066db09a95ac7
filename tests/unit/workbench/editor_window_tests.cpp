// Unsaved materials in the real window: they are asked for before they are lost.

#include "tests/unit/workbench/window_test.h"

#include <gtest/gtest.h>

#include <filesystem>

namespace touchstone::test::editor_window_tests {
namespace {

class EditorWindow : public WindowTest {
  protected:
    EditorWindow() { size_ = kTall; }
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
    const auto saveAs = [&](const std::string& name) {
        display_.click(middleOf("saveAs"));
        until("the name to be asked for", [](const Json& s) { return s["widgets"].contains("openPath"); });
        later();
        display_.key("ctrl+a");
        display_.xdotool({"type", "--delay", "20", name});
        later();
        display_.key("Return");
    };
    saveAs(other.string());
    until("the question", [](const Json& s) { return s["widgets"].contains("fileReplace"); });
    later();
    EXPECT_TRUE(readFile(other) == before) << "it is there already";
    display_.key("Escape");
    until("the browser again", [](const Json& s) { return s["widgets"].contains("openPath"); });
    EXPECT_TRUE(readFile(other) == before);
    display_.key("Return");
    until("the question", [](const Json& s) { return s["widgets"].contains("fileReplace"); });
    later();
    display_.click(middleOf("fileReplace"));
    until("it to be saved",
          [&](const Json& s) { return s["materials"]["notice"] == "saved to " + other.string(); });
    EXPECT_TRUE(readFile(other) != before);
    until("the model's name", [](const Json& s) { return s["model"] == "other.glb"; });
    EXPECT_EQ(display_.waitForWindow("other.glb").x, corner_.x) << "the title names the new file";

    later();
    saveAs("third"); // in the same folder, with the ending of what was opened
    until("it to be saved", [&](const Json& s) { return s["model"] == "third.glb"; });
    EXPECT_TRUE(std::filesystem::exists(scratch_ / "third.glb"));
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::editor_window_tests
