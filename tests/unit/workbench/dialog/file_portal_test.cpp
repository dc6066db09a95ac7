// The desktop's portal on a bus of the test's own: it answers, is cancelled, refuses, vanishes, hangs or is
// not there.

#include "tests/support/kept_environment.h"
#include "tests/unit/workbench/dialog/scripts.h"
#include "workbench/dialog/file_dialog.h"
#include "workbench/dialog/portal/file_uri.h"

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <optional>
#include <thread>

namespace touchstone::test::file_portal_test {
namespace {

using namespace std::chrono_literals;
using Stage = FileDialog::Stage;

class FilePortal : public testing::Test {
  protected:
    void SetUp() override {
        writeTextFile(scratch_ / "bus.conf",
                      "<!DOCTYPE busconfig PUBLIC \"-//freedesktop//DTD D-Bus Bus Configuration 1.0//EN\" "
                      "\"http://www.freedesktop.org/standards/dbus/1.0/busconfig.dtd\">\n"
                      "<busconfig><type>session</type><listen>unix:path=" +
                          (scratch_ / "bus").string() +
                          "</listen><policy context=\"default\"><allow send_destination=\"*\"/>"
                          "<allow receive_sender=\"*\"/><allow own=\"*\"/></policy></busconfig>\n");
        bus_.emplace(std::vector<std::string>{"/usr/bin/dbus-daemon", "--nofork", "--nosyslog",
                                              "--config-file=" + (scratch_ / "bus.conf").string()},
                     Environment{}, scratch_ / "bus.log");
        wait([&] { return std::filesystem::exists(scratch_ / "bus"); });
        setenv("DBUS_SESSION_BUS_ADDRESS", ("unix:path=" + (scratch_ / "bus").string()).c_str(), 1);
    }

    static void wait(const std::function<bool()>& holds) {
        for (int i = 0; i < 4000 && !holds(); ++i)
            std::this_thread::sleep_for(5ms);
        ASSERT_TRUE(holds());
    }
    /// A portal that answers in this way.
    void portal(const std::string& answer) {
        portal_.reset();
        std::filesystem::remove(scratch_ / "portal.log"); // which said that the one before is ready
        portal_.emplace(std::vector<std::string>{std::filesystem::path(TOUCHSTONE_BINARY).parent_path() /
                                                     "portal_stand_in",
                                                 answer, scratch_ / "request"},
                        Environment{}, scratch_ / "portal.log");
        wait([&] {
            return std::filesystem::exists(scratch_ / "portal.log") &&
                   readFile(scratch_ / "portal.log").find("ready") != std::string::npos;
        });
    }
    void ask(FilePurpose purpose = FilePurpose::Open) {
        choice_.reset();
        dialog_.ask({.purpose = purpose,
                     .folder = scratch_.path() / "",
                     .name = purpose == FilePurpose::Open ? "" : "new.glb",
                     .ending = ".glb",
                     .places = {}});
        EXPECT_EQ(dialog_.stage(), Stage::Desktop);
    }
    void until(const std::function<bool()>& holds) {
        wait([&] {
            if (const auto choice = dialog_.update(0.0))
                choice_ = choice;
            return holds();
        });
    }

    Scripts scripts_;
    KeptEnvironment kept_;
    ScratchFolder scratch_;
    std::optional<BackgroundProgram> bus_, portal_;
    FileDialog dialog_;
    std::optional<FileChoice> choice_;
};

TEST_F(FilePortal, ItsChoiceIsTakenAndItIsToldFolderAndKinds) {
    portal("file:///models/a%20b%c3%bc.stl");
    scripts_.add("zenity", "echo /from/zenity.glb");
    ask();
    until([&] { return choice_.has_value(); });
    EXPECT_EQ(choice_->path, "/models/a bü.stl");
    const std::string request = readFile(scratch_ / "request");
    EXPECT_TRUE(request.starts_with("OpenFile\n\nOpen - Touchstone\nhandle_token\ntouchstone_")) << request;
    const std::string folder = scratch_.path().string() + "/";
    EXPECT_NE(request.find("current_folder\nbytes " + std::to_string(folder.size() + 1) + " " + folder),
              std::string::npos)
        << request;
    EXPECT_NE(request.find("filters\nModels and recordings\n*.glb\n*.GLB\n"), std::string::npos) << request;
    EXPECT_NE(request.find("Recordings\n*.tsrec\n*.TSREC\nAll files\n*\n"), std::string::npos) << request;
}

TEST_F(FilePortal, SavesUnderTheSuggestedName) {
    portal("file:///models/other");
    ask(FilePurpose::SaveMaterials);
    until([&] { return choice_.has_value(); });
    EXPECT_EQ(choice_->path, "/models/other.glb");
    const std::string request = readFile(scratch_ / "request");
    EXPECT_TRUE(request.starts_with("SaveFile\n")) << request;
    EXPECT_NE(request.find("current_name\nnew.glb\n"), std::string::npos) << request;
}

TEST_F(FilePortal, CancellingClosesAndAFailureGivesWayToTheBrowser) {
    scripts_.add("zenity", "echo /from/zenity.glb");
    portal("cancel");
    ask();
    until([&] { return !dialog_.open(); });
    for (const char* broken : {"end", "vanish", "file:///one file:///two", "http://nowhere/a.glb"}) {
        SCOPED_TRACE(broken);
        portal(broken);
        ask();
        until([&] { return dialog_.stage() == Stage::Browser; });
        EXPECT_NE(dialog_.note(), "") << "it was seen, so it is said why another comes";
        dialog_.close();
    }
    EXPECT_FALSE(choice_);
}

TEST_F(FilePortal, WhereThereIsNoneTheNextDialogIsAsked) {
    scripts_.add("zenity", "echo /from/zenity.glb");
    ask(); // a bus without a portal
    until([&] { return choice_.has_value(); });
    EXPECT_EQ(choice_->path, "/from/zenity.glb");
    portal("refuse");
    ask();
    until([&] { return choice_.has_value(); });
    bus_.reset(); // an address at which there is no bus
    ask();
    until([&] { return choice_.has_value(); });

    std::filesystem::remove(scripts_.add("zenity", ""));
    ask();
    until([&] { return dialog_.stage() == Stage::Browser; });
    EXPECT_EQ(dialog_.note(), "") << "as on a desktop without any dialog";
    setenv("TOUCHSTONE_FILE_DIALOG", "portal", 1);
    ask();
    until([&] { return dialog_.stage() == Stage::Browser; });
    EXPECT_NE(dialog_.note(), "") << "it was asked for";
}

TEST_F(FilePortal, AHangingOneIsLeft) {
    portal("wait");
    ask();
    wait([&] { return dialog_.update(0.0) || std::filesystem::exists(scratch_ / "request"); });
    dialog_.browse();
    EXPECT_EQ(dialog_.stage(), Stage::Browser);
}

TEST(FileUri, NamesLocalFilesAlone) {
    EXPECT_EQ(pathOfUri("file:///a%20b/%C3%bc%25.glb"), "/a b/ü%.glb");
    EXPECT_EQ(pathOfUri("file://localhost/a"), "/a");
    for (const char* other : {"", "file:", "file:/a", "file://host/a", "http:///a", "/a", "file:///a%2",
                              "file:///a%", "file:///a%zz", "file:///a%+1", "file:///a%00b"})
        EXPECT_FALSE(pathOfUri(other)) << other;
}

} // namespace
} // namespace touchstone::test::file_portal_test
