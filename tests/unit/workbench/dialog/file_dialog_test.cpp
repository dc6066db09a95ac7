// The desktop's dialog, and the window's browser where it fails.

#include "tests/unit/workbench/dialog/scripts.h"
#include "workbench/dialog/file_dialog.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <thread>

namespace touchstone::test::file_dialog_test {
namespace {

using Stage = FileDialog::Stage;

class FileDialogTest : public testing::Test {
  protected:
    void ask(const std::string& zenity, FilePurpose purpose = FilePurpose::Open) {
        scripts_.add("zenity", zenity);
        dialog_.ask({.purpose = purpose,
                     .folder = scratch_.path(),
                     .name = "new.glb",
                     .ending = ".glb",
                     .places = {}});
    }
    /// Updates until this holds.
    void until(const std::function<bool()>& holds) {
        for (int i = 0; i < 2000 && !holds(); ++i) {
            if (const auto choice = dialog_.update(0.0))
                choice_ = choice;
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        ASSERT_TRUE(holds());
    }
    Scripts scripts_;
    ScratchFolder scratch_;
    FileDialog dialog_;
    std::optional<FileChoice> choice_;
};

TEST_F(FileDialogTest, TheDesktopsChoiceIsTaken) {
    ask("echo /models/a.stl");
    EXPECT_EQ(dialog_.stage(), Stage::Desktop);
    EXPECT_FALSE(dialog_.covers()) << "the hand goes on";
    until([&] { return choice_.has_value(); });
    EXPECT_EQ(choice_->path, "/models/a.stl");
    EXPECT_FALSE(dialog_.open());
    EXPECT_FALSE(dialog_.update(0.0)) << "once";
}

TEST_F(FileDialogTest, ACancelledOneClosesAndABrokenOneGivesWayToTheBrowser) {
    ask("sleep 0.4; exit 1");
    until([&] { return !dialog_.open(); });
    for (const char* broken : {"kill -KILL $$", "echo nonsense", "exit 255", "cat /dev/zero"}) {
        ask(broken);
        until([&] { return dialog_.stage() == Stage::Browser; });
        EXPECT_NE(dialog_.note(), "") << broken;
        EXPECT_EQ(dialog_.browser().folder(), scratch_.path());
        dialog_.close();
    }
    EXPECT_FALSE(choice_);
}

TEST_F(FileDialogTest, AHangingOneIsLeft) {
    ask("exec sleep 1000");
    until([&] { return dialog_.stage() == Stage::Desktop; });
    dialog_.browse();
    EXPECT_EQ(dialog_.stage(), Stage::Browser);
    EXPECT_EQ(dialog_.note(), "");
    ask("echo /second.glb"); // while the first may still be ending
    until([&] { return choice_.has_value(); });
    EXPECT_EQ(choice_->path, "/second.glb");
    ask("exec sleep 1000");
    (void)dialog_.update(0.0);
} // and the destructor does not wait for it

TEST_F(FileDialogTest, WhatExistsIsNotReplacedUnasked) {
    setenv("TOUCHSTONE_FILE_DIALOG", "window", 1);
    writeTextFile(scratch_ / "new.glb", "old");
    ask("", FilePurpose::SaveMaterials);
    EXPECT_EQ(dialog_.stage(), Stage::Browser);
    dialog_.enter();
    EXPECT_EQ(dialog_.stage(), Stage::Replace);
    EXPECT_EQ(dialog_.target(), scratch_ / "new.glb");
    dialog_.replace(false);
    EXPECT_EQ(dialog_.stage(), Stage::Browser);
    dialog_.browser().setText("other");
    dialog_.enter();
    until([&] { return choice_.has_value(); });
    EXPECT_EQ(choice_->path, scratch_ / "other.glb");
    EXPECT_EQ(choice_->purpose, FilePurpose::SaveMaterials);
}

TEST_F(FileDialogTest, ANameThatGetsAnEndingIsAskedAboutAgain) {
    writeTextFile(scratch_ / "model.glb", "old");
    ask("echo '" + (scratch_ / "model").string() + "'", FilePurpose::SaveMaterials);
    until([&] { return dialog_.stage() == Stage::Replace; });
    EXPECT_FALSE(choice_);
    dialog_.replace(true);
    until([&] { return choice_.has_value(); });
    EXPECT_EQ(choice_->path, scratch_ / "model.glb");
}

} // namespace
} // namespace touchstone::test::file_dialog_test
