// The browser without its widgets.

#include "tests/support/kept_environment.h"
#include "tests/support/program.h"
#include "workbench/dialog/file_browser.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <thread>

namespace touchstone::test::file_browser_test {
namespace {

namespace fs = std::filesystem;

class FileBrowserTest : public testing::Test {
  protected:
    FileBrowserTest() {
        fs::create_directory(scratch_ / "Folder");
        for (const char* name : {"b.glb", "A.STL", "notes.txt", "take.tsrec", ".hidden.glb"})
            writeTextFile(scratch_ / name, "12345");
        fs::create_symlink(scratch_ / "gone", scratch_ / "broken link.glb");
    }
    FileRequest request(FilePurpose purpose = FilePurpose::Open) {
        return {
            .purpose = purpose, .folder = scratch_.path(), .name = "new.glb", .ending = ".glb", .places = {}};
    }
    /// Until the folder has been read, or the next reading is due.
    void read() {
        now_ += 3.0;
        browser_.update(now_);
        for (int i = 0; i < 1000 && (browser_.reading() || i < 20); ++i) {
            browser_.update(now_);
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
    }
    std::string names() {
        std::string all;
        for (const FolderEntry& entry : browser_.shown())
            all += entry.name + (entry.folder ? "/ " : " ");
        return all;
    }
    KeptEnvironment kept_;
    ScratchFolder scratch_;
    FileBrowser browser_;
    double now_ = 0.0;
};

TEST_F(FileBrowserTest, ShowsFoldersAndFilesOfTheKind) {
    browser_.open(request());
    read();
    EXPECT_EQ(names(), "Folder/ A.STL b.glb take.tsrec ");
    EXPECT_EQ(browser_.shown().back().bytes, 5u);
    browser_.setKind(2);
    EXPECT_EQ(names(), "Folder/ take.tsrec ");
    browser_.setKind(3);
    EXPECT_EQ(names(), "Folder/ A.STL b.glb notes.txt take.tsrec ");
    browser_.setKind(0);
    browser_.setText("stl");
    EXPECT_EQ(names(), "A.STL ");
    browser_.setText(".h");
    EXPECT_EQ(names(), ".hidden.glb ");
    browser_.setText("/usr");
    EXPECT_EQ(names(), "Folder/ A.STL b.glb take.tsrec ") << "a path is no filter";
}

TEST_F(FileBrowserTest, EnterOpensWhatIsTypedOrChosen) {
    browser_.open(request());
    read();
    EXPECT_EQ(browser_.enter(), std::nullopt) << "nothing is chosen";
    browser_.setText("b.g");
    EXPECT_EQ(browser_.enter(), scratch_ / "b.glb") << "the first that fits";
    browser_.setText("");
    browser_.moveChoice(1);
    browser_.moveChoice(1);
    EXPECT_EQ(browser_.enter(), scratch_ / "A.STL");
    browser_.moveChoice(-1);
    EXPECT_EQ(browser_.enter(), std::nullopt);
    EXPECT_EQ(browser_.folder(), scratch_ / "Folder");
    read();
    EXPECT_EQ(names(), "");
    browser_.setText("..");
    EXPECT_EQ(browser_.enter(), std::nullopt);
    EXPECT_EQ(browser_.folder(), scratch_.path());
    EXPECT_EQ(browser_.text(), "");
    browser_.setText("Folder/../b.glb");
    EXPECT_TRUE(fs::equivalent(*browser_.enter(), scratch_ / "b.glb"));
    browser_.setText("no such file.glb");
    EXPECT_EQ(browser_.enter(), scratch_ / "no such file.glb") << "the loader says what is wrong";
    for (int i = 0; i < 100; ++i)
        browser_.goUp();
    EXPECT_EQ(browser_.folder(), "/");
}

TEST_F(FileBrowserTest, AHomeFolderMayBeTyped) {
    setenv("HOME", scratch_.path().c_str(), 1);
    EXPECT_EQ(typedPath(" ~ ", "/x"), scratch_.path());
    EXPECT_EQ(typedPath("~/b.glb", "/x"), scratch_ / "b.glb");
    EXPECT_EQ(typedPath("~root/b.glb", "/x"), "/root/b.glb");
    EXPECT_EQ(typedPath("~no such user/b.glb", "/x"), "/x/~no such user/b.glb");
    EXPECT_EQ(typedPath("b~.glb", "/x"), "/x/b~.glb");
    EXPECT_EQ(typedPath("", "/x"), "");
    browser_.open(request());
    browser_.setText("~/b.glb");
    EXPECT_EQ(browser_.enter(), scratch_ / "b.glb");
}

TEST_F(FileBrowserTest, AFolderMayVanishOrBeUnreadable) {
    browser_.open(request());
    browser_.goTo(scratch_ / "Folder");
    read();
    EXPECT_EQ(browser_.contents().problem, "");
    fs::remove(scratch_ / "Folder");
    read();
    EXPECT_NE(browser_.contents().problem, "");
    EXPECT_EQ(browser_.folder(), scratch_ / "Folder") << "it may come back";
    fs::create_directory(scratch_ / "Folder");
    writeTextFile(scratch_ / "Folder/c.ply", "");
    read();
    EXPECT_EQ(browser_.contents().problem, "");
    EXPECT_EQ(names(), "c.ply ");
    browser_.goTo(scratch_ / "b.glb");
    read();
    EXPECT_NE(browser_.contents().problem, "") << "a file";
    browser_.goUp();
    read();
    EXPECT_EQ(browser_.contents().problem, "");
}

TEST_F(FileBrowserTest, AChoiceSurvivesWhatIsNew) {
    browser_.open(request());
    read();
    browser_.choose(2);
    writeTextFile(scratch_ / "a new one.glb", "");
    read();
    ASSERT_TRUE(browser_.chosen());
    EXPECT_EQ(browser_.shown()[*browser_.chosen()].name, "b.glb");
    fs::remove(scratch_ / "b.glb");
    read();
    EXPECT_FALSE(browser_.chosen());
}

TEST_F(FileBrowserTest, ANameToSaveToIsSuggestedAndGetsItsEnding) {
    browser_.open(request(FilePurpose::SaveMaterials));
    read();
    EXPECT_EQ(browser_.enter(), scratch_ / "new.glb");
    browser_.setText("other");
    EXPECT_EQ(names(), "Folder/ A.STL b.glb ") << "a name is no filter";
    EXPECT_EQ(browser_.enter(), scratch_ / "other.glb");
    browser_.choose(2);
    EXPECT_EQ(browser_.text(), "b.glb");
    browser_.setText(scratch_.path().string() + "/Folder");
    EXPECT_EQ(browser_.enter(), std::nullopt);
    EXPECT_EQ(browser_.folder(), scratch_ / "Folder");
    EXPECT_EQ(browser_.text(), "new.glb");
    browser_.setText("");
    EXPECT_EQ(browser_.enter(), std::nullopt);
}

TEST_F(FileBrowserTest, PlacesExistAndStandOnce) {
    setenv("HOME", scratch_.path().c_str(), 1);
    fs::create_directory(scratch_ / "Downloads");
    const std::vector<fs::path> samples{scratch_ / "Folder/a.glb"},
        recent{scratch_ / "Folder/x.glb", "/no such folder/y.glb", scratch_ / "z.glb"};
    std::string all;
    for (const FilePlace& place : usualPlaces(samples, recent))
        all += place.name + " ";
    EXPECT_EQ(all, "Home Downloads Samples ");
}

} // namespace
} // namespace touchstone::test::file_browser_test
