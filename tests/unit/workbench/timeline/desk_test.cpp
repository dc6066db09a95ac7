// What somebody who looks at a recording is shown, whatever has become of its model.

#include "devices/mouse/mouse_device.h"
#include "engine/load/scene_loader.h"
#include "tests/unit/workbench/timeline/recordings.h"
#include "workbench/timeline/timeline_desk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <thread>

namespace touchstone::test {
namespace {

class DeskTest : public testing::Test {
  protected:
    /// A stroke over a copy of the doughnut, in a workspace that it was fitted to or not.
    void record(Fit fit) {
        std::filesystem::copy_file(TOUCHSTONE_ASSETS "/doughnut.glb", model_);
        const auto source = loadScene(model_);
        const auto haptic = compileHapticScene(*source, workspaceFromScene(*source, fit), {});
        const Similarity placed =
            workspaceFromScene(*source, fit) * workspaceFromScene(*source, Fit::Workspace).inverse();
        RecordedServo rig([placed](double time) { return at(placed.point(overTheDoughnut(time))); });
        rig.recorder.start(file_, "test");
        rig.offer({source, haptic, identify(*haptic, *source, fit)});
        rig.ticks(4000);
        rig.finish();
        lived_ = rig.records;
    }
    void openModel(const std::filesystem::path& path) {
        opened_ = loadModel(path, Fit::Workspace, {});
        identity_ = identify(*opened_.haptic, *opened_.scene, Fit::Workspace);
    }
    void turn() {
        now_ += 0.03;
        desk_.update({.now = now_,
                      .model = opened_.scene != nullptr ? &opened_ : nullptr,
                      .open = opened_.scene != nullptr ? &identity_ : nullptr,
                      .live = &live_});
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    void turnUntil(const std::function<bool()>& holds) {
        bool held = false;
        for (int i = 0; i < 10000 && !(held = holds()); ++i)
            turn();
        ASSERT_TRUE(held);
    }
    [[nodiscard]] bool notes(const std::string& text) const {
        return std::ranges::any_of(
            desk_.notes(), [&](const std::string& note) { return note.find(text) != std::string::npos; });
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec", model_ = scratch_ / "mine.glb";
    std::vector<TickRecord> lived_;
    MouseDevice hand_;
    AgainHand again_{hand_};
    TimelineDesk desk_{again_, {scratch_.path()}};
    Model opened_;
    SceneIdentity identity_;
    ForceHistory live_{100};
    double now_ = 0.0;
};

TEST_F(DeskTest, AsksForTheModelAndShowsTheTickUnderTheCursor) {
    record(Fit::Workspace);
    desk_.open(file_);
    EXPECT_TRUE(desk_.opening());
    turnUntil([&] { return desk_.looking(); });
    EXPECT_FALSE(desk_.opening());
    EXPECT_EQ(desk_.takeModelWanted(), std::filesystem::canonical(model_));
    EXPECT_EQ(desk_.takeModelWanted(), std::nullopt) << "told once";
    EXPECT_FALSE(desk_.modelIsOpen());
    turn();
    EXPECT_TRUE(notes("mine.glb was touched and is not open"));
    openModel(model_);
    turn();
    EXPECT_TRUE(desk_.modelIsOpen());
    EXPECT_TRUE(desk_.notes().empty());
    desk_.playback().step(3000);
    turnUntil([&] { return desk_.tickComplete(); });
    EXPECT_EQ(desk_.tick().output.proxy, lived_[3000].output.proxy);
    EXPECT_EQ(desk_.tick().output.planeCount, lived_[3000].output.planeCount);
    EXPECT_EQ(desk_.settings(), HapticSettings{});
    desk_.leave();
    EXPECT_FALSE(desk_.looking());
    turn();
    EXPECT_FALSE(desk_.looking());
}

TEST_F(DeskTest, WhatIsOpenAlreadyIsNotAskedFor) {
    record(Fit::Workspace);
    openModel(model_);
    desk_.open(file_);
    turnUntil([&] { return desk_.looking(); });
    EXPECT_EQ(desk_.takeModelWanted(), std::nullopt);
    EXPECT_TRUE(desk_.modelIsOpen());
}

TEST_F(DeskTest, AModelThatIsFittedOtherwiseIsTouchedWhereItWasTouched) {
    record(Fit::None);
    openModel(model_);
    desk_.open(file_);
    turnUntil([&] { return desk_.looking(); });
    desk_.playback().step(3000);
    turnUntil([&] { return desk_.tickComplete(); });
    const Similarity openFromRecorded =
        opened_.workspaceFromScene * workspaceFromScene(*opened_.scene, Fit::None).inverse();
    const glm::dvec3 recorded = lived_[3000].output.proxy, shown = desk_.tick().output.proxy;
    EXPECT_LT(glm::distance(shown, openFromRecorded.point(recorded)), 1e-12);
    EXPECT_GT(glm::distance(shown, recorded), 1e-3) << "the two are not the same place";
    EXPECT_LT(glm::distance(shown, overTheDoughnut(lived_[3000].time)), 3e-3) << "on the glaze";
}

TEST_F(DeskTest, AModelThatIsGoneOrOtherwiseSaysSo) {
    record(Fit::Workspace);
    std::filesystem::rename(model_, scratch_ / "elsewhere");
    openModel(TOUCHSTONE_ASSETS "/box.glb");
    desk_.open(file_);
    turnUntil([&] { return desk_.looking(); });
    turn();
    EXPECT_EQ(desk_.takeModelWanted(), std::nullopt);
    EXPECT_FALSE(desk_.modelIsOpen());
    EXPECT_TRUE(notes("is not there: only the curves are shown"));
    EXPECT_GT(desk_.timeline().force().over(0, desk_.timeline().size()).most, 0.1f);

    std::filesystem::copy_file(TOUCHSTONE_ASSETS "/torus_64800.glb", model_);
    desk_.open(file_);
    turnUntil([&] { return desk_.takeModelWanted().has_value(); });
    openModel(model_);
    turn();
    EXPECT_TRUE(desk_.modelIsOpen());
    EXPECT_TRUE(notes("mine.glb has changed since it was touched"));
    desk_.verify();
    turnUntil([&] { return !desk_.verdict().empty(); });
    EXPECT_FALSE(desk_.verdictEqual());
    EXPECT_NE(desk_.verdict().find("differs first"), std::string::npos) << desk_.verdict();
    EXPECT_NE(desk_.verdict().find("what is felt is not the same"), std::string::npos) << desk_.verdict();
}

TEST_F(DeskTest, WhatCannotBeOpenedLeavesWhatIsLookedAt) {
    record(Fit::Workspace);
    desk_.open(file_);
    turnUntil([&] { return desk_.looking(); });
    desk_.playback().step(1234);
    writeTextFile(scratch_ / "bad.tsrec", "hm");
    desk_.open(scratch_ / "bad.tsrec");
    std::optional<Error> problem;
    turnUntil([&] { return (problem = desk_.takeProblem()).has_value(); });
    EXPECT_EQ(problem->problem(), "is no recording of Touchstone");
    EXPECT_TRUE(desk_.looking());
    EXPECT_EQ(desk_.playback().cursor(), 1234u);
    desk_.open(file_);
    desk_.cancelOpening();
    for (int i = 0; i < 50; ++i)
        turn();
    EXPECT_FALSE(desk_.opening());
    EXPECT_EQ(desk_.playback().cursor(), 1234u) << "it was given up";
}

TEST_F(DeskTest, MayBeLeftAtAnyMoment) {
    record(Fit::Workspace);
    for (int turns = 0; turns < 40; turns += 3) {
        desk_.open(file_);
        turnUntil([&] { return desk_.looking(); });
        desk_.verify();
        desk_.touchAgain();
        desk_.playback().play(true);
        for (int i = 0; i < turns; ++i)
            turn();
        desk_.leave();
        turn();
        ASSERT_FALSE(desk_.looking());
        ASSERT_FALSE(desk_.again().running());
        ASSERT_FALSE(desk_.verifying());
    }
}

} // namespace
} // namespace touchstone::test
