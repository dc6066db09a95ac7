// The desktop's dialogs are foreign programs: absent, killed, hanging or talking nonsense.

#include "tests/unit/workbench/dialog/scripts.h"
#include "workbench/dialog/desktop_dialog.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace touchstone::test::desktop_dialog_test {
namespace {

using End = ProcessAnswer::End;

ProcessAnswer ended(End end, int status, const std::string& output = "") {
    return {end, status, {output.begin(), output.end()}};
}

TEST(DesktopDialog, IsTheOneOfTheDesktop) {
    Scripts scripts;
    setenv("PATH", scripts.add("kdialog", "exit 1").parent_path().c_str(), 1);
    using enum DialogProgram::Kind;
    using Kinds = std::vector<DialogProgram::Kind>;
    const auto found = [] {
        Kinds kinds;
        for (const DialogProgram& program : installedDialogs())
            kinds.push_back(program.kind);
        return kinds;
    };
    EXPECT_EQ(found(), Kinds{Kdialog});
    scripts.add("zenity", "exit 1");
    EXPECT_EQ(found(), (Kinds{Zenity, Kdialog}));
    setenv("XDG_CURRENT_DESKTOP", "KDE", 1);
    EXPECT_EQ(found(), (Kinds{Kdialog, Zenity}));
    setenv("DBUS_SESSION_BUS_ADDRESS", "unix:path=/no such bus", 1);
    EXPECT_EQ(found(), (Kinds{Portal, Kdialog, Zenity}));
    setenv("TOUCHSTONE_FILE_DIALOG", "zenity", 1);
    EXPECT_EQ(found(), Kinds{Zenity});
    setenv("TOUCHSTONE_FILE_DIALOG", "portal", 1);
    EXPECT_EQ(found(), Kinds{Portal});
    setenv("TOUCHSTONE_FILE_DIALOG", "window", 1);
    EXPECT_EQ(found(), Kinds{});
    unsetenv("TOUCHSTONE_FILE_DIALOG");
    unsetenv("DBUS_SESSION_BUS_ADDRESS");
    setenv("PATH", "::relative:/no such folder", 1);
    EXPECT_EQ(found(), Kinds{});
}

TEST(DesktopDialog, IsGivenTheFolderAndTheKinds) {
    const FileRequest open{
        .purpose = FilePurpose::Open, .folder = "/models", .name = {}, .ending = {}, .places = {}};
    const std::vector<std::string> zenity = dialogArguments(DialogProgram::Kind::Zenity, open);
    EXPECT_NE(std::ranges::find(zenity, "/models/"), zenity.end());
    EXPECT_NE(std::ranges::find(zenity, "Recordings | *.tsrec *.TSREC"), zenity.end());
    EXPECT_EQ(std::ranges::find(zenity, "--save"), zenity.end());
    const FileRequest save{.purpose = FilePurpose::SaveMaterials,
                           .folder = "/models",
                           .name = "a.glb",
                           .ending = ".glb",
                           .places = {}};
    const std::vector<std::string> kdialog = dialogArguments(DialogProgram::Kind::Kdialog, save);
    EXPECT_EQ(kdialog.back(), "/models/a.glb");
    EXPECT_NE(std::ranges::find(kdialog, "--getsavefilename"), kdialog.end());
}

TEST(DesktopDialog, OnlyAPathIsAnAnswer) {
    EXPECT_EQ(answerOf(ended(End::Exited, 0, "/a b/ü.glb\n"), 5.0).path, "/a b/ü.glb");
    EXPECT_EQ(answerOf(ended(End::Exited, 0, "/a b/ü.glb"), 0.0).path, "/a b/ü.glb");
    for (const ProcessAnswer& cancelled : {ended(End::Exited, 1), ended(End::Stopped, 0)}) {
        const DialogAnswer answer = answerOf(cancelled, 5.0);
        EXPECT_TRUE(answer.path.empty());
        EXPECT_TRUE(answer.problem.empty());
    }
    for (const ProcessAnswer& broken :
         {ended(End::Exited, 0), ended(End::Exited, 0, "\n"), ended(End::Exited, 0, "relative"),
          ended(End::Exited, 0, "/one\n/two\n"), ended(End::Exited, 0, std::string("/a\0b", 4)),
          ended(End::Exited, 255), ended(End::Killed, 9), ended(End::TooLong, 0, "/a"),
          ended(End::NotStarted, 0)}) {
        const DialogAnswer answer = answerOf(broken, 5.0);
        EXPECT_TRUE(answer.path.empty());
        EXPECT_FALSE(answer.problem.empty());
    }
    EXPECT_FALSE(answerOf(ended(End::Exited, 1), 0.01).problem.empty())
        << "it was never seen: no display, say";
}

} // namespace
} // namespace touchstone::test::desktop_dialog_test
