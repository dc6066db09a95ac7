#include "engine/core/error.h"
#include "tests/unit/workbench/timeline/recordings.h"
#include "workbench/timeline/recording_files.h"
#include "workbench/timeline/recording_list.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

namespace touchstone::test::recording_files_test {
namespace {

class RecordingFiles : public testing::Test {
  protected:
    void SetUp() override {
        writeTextFile(file_, "one");
        writeTextFile(other_, "another");
    }
    /// What a refusal says; fails where there is none, or where it has changed anything.
    std::string refused(const std::function<void()>& action) {
        std::string text;
        try {
            action();
            ADD_FAILURE() << "was done";
        } catch (const Error& error) {
            text = error.what();
        }
        EXPECT_EQ(readFile(file_), "one");
        EXPECT_EQ(readFile(other_), "another");
        return text;
    }

    ScratchFolder folder_;
    std::filesystem::path file_ = folder_ / "a.tsrec", other_ = folder_ / "b.tsrec";
};

TEST_F(RecordingFiles, AreRenamedWithinTheirFolderAndKeepTheirEnding) {
    EXPECT_EQ(renameRecording(file_, "ribs, 2nd try"), folder_ / "ribs, 2nd try.tsrec");
    EXPECT_FALSE(std::filesystem::exists(file_));
    EXPECT_EQ(readFile(folder_ / "ribs, 2nd try.tsrec"), "one");
    EXPECT_EQ(renameRecording(folder_ / "ribs, 2nd try.tsrec", "Brötchen.tsrec"), folder_ / "Brötchen.tsrec");
    EXPECT_EQ(renameRecording(folder_ / "Brötchen.tsrec", "Brötchen"), folder_ / "Brötchen.tsrec");
}

TEST_F(RecordingFiles, ANameThatIsTakenOrNoNameIsRefused) {
    EXPECT_NE(refused([&] { renameRecording(file_, "b"); }).find("there is another b.tsrec"),
              std::string::npos);
    for (const std::string& name :
         {std::string(), std::string("  "), std::string("../a"), std::string("x/y"), std::string("a\nb"),
          std::string(".a"), std::string("live-7"), std::string(250, 'x')})
        EXPECT_NE(refused([&] { renameRecording(file_, name); }).find("is not renamed"), std::string::npos)
            << name;
    EXPECT_EQ(std::ranges::distance(std::filesystem::directory_iterator(folder_.path())), 2);
}

TEST_F(RecordingFiles, WhatIsGoneIsSaid) {
    EXPECT_NE(refused([&] { renameRecording(folder_ / "gone.tsrec", "c"); }).find("gone"), std::string::npos);
    EXPECT_NE(refused([&] { deleteRecording(folder_ / "gone.tsrec"); }).find("already gone"),
              std::string::npos);
    deleteRecording(file_);
    EXPECT_FALSE(std::filesystem::exists(file_));
}

TEST_F(RecordingFiles, AFolderThatMayNotBeWrittenKeepsThem) {
    // Root may write everywhere but here.
    const bool root = geteuid() == 0;
    const std::filesystem::path file = root ? "/sys/kernel/notes" : file_;
    ASSERT_EQ(chmod(folder_.path().c_str(), 0500), 0);
    EXPECT_NE(refused([&] { renameRecording(file, "c"); }).find("make its folder writable"),
              std::string::npos);
    EXPECT_NE(refused([&] { deleteRecording(file); }).find("make its folder writable"), std::string::npos);
    ASSERT_EQ(chmod(folder_.path().c_str(), 0700), 0);
}

TEST(RecordingReason, IsTheLastFaultNotedOfWhatTheFlightRecorderKept) {
    const ScratchFolder folder;
    const auto facts = [&](const char* command, std::vector<RecordedNote> notes) {
        std::vector<RecordedItem> items{recordingOrigin(command, 1000.0),
                                        ticksFrom(0.0, 100, [](size_t) { return 0.1; })};
        items.insert(items.end(), notes.begin(), notes.end());
        items.emplace_back(RecordedEnd{100});
        writeItems(folder / "r.tsrec", items);
        return recordingFacts(folder / "r.tsrec");
    };
    EXPECT_EQ(facts("flight recorder of window", {{3, "an older fault"}, {90, "the hand was lost"}}).reason,
              "the hand was lost");
    EXPECT_EQ(facts("flight recorder of window", {}).reason, "the program ended without closing");
    EXPECT_EQ(facts("window", {{90, "the hand was lost"}}).reason, "") << "somebody wanted it";
    EXPECT_EQ(facts("window", {}).problem, "");
}

} // namespace
} // namespace touchstone::test::recording_files_test
