// What somebody who looks at a recording is shown, whatever has become of its model.

#include "assets/volumes.h"
#include "devices/mouse/mouse_device.h"
#include "engine/load/scene_loader.h"
#include "tests/unit/workbench/timeline/recordings.h"
#include "workbench/timeline/timeline_controller.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <optional>
#include <thread>

namespace touchstone::test::desk_test {
namespace {

class ControllerTest : public testing::Test {
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
        rig.steps(4000);
        rig.finish();
        lived_ = rig.records;
    }
    void openModel(const std::filesystem::path& path) {
        opened_ = loadModel(path, Fit::Workspace, {});
        identity_ = identify(*opened_.haptic, *opened_.scene, Fit::Workspace);
    }
    void turn() {
        now_ += 0.03;
        controller_.update({.now = now_,
                            .model = opened_.scene != nullptr ? &opened_ : nullptr,
                            .open = opened_.scene != nullptr ? &identity_ : nullptr,
                            .live = &live_,
                            .settings = settings_ ? &*settings_ : nullptr});
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    void turnUntil(const std::function<bool()>& holds) {
        bool held = false;
        for (int i = 0; i < 10000 && !(held = holds()); ++i)
            turn();
        ASSERT_TRUE(held);
    }
    [[nodiscard]] bool notes(const std::string& text) const {
        return std::ranges::any_of(controller_.notes(), [&](const std::string& note) {
            return note.find(text) != std::string::npos;
        });
    }

    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec", model_ = scratch_ / "mine.glb";
    std::vector<TickRecord> lived_;
    MouseDevice hand_;
    PlaybackDevice again_{hand_};
    TimelineController controller_{again_, {scratch_.path()}};
    Model opened_;
    SceneIdentity identity_;
    std::optional<HapticSettings> settings_;
    ForceHistory live_{100};
    double now_ = 0.0;
};

TEST_F(ControllerTest, AsksForTheModelAndShowsTheTickUnderTheCursor) {
    record(Fit::Workspace);
    controller_.open(file_);
    EXPECT_TRUE(controller_.opening());
    turnUntil([&] { return controller_.looking(); });
    EXPECT_FALSE(controller_.opening());
    EXPECT_EQ(controller_.takeModelWanted(), std::filesystem::canonical(model_));
    EXPECT_EQ(controller_.takeModelWanted(), std::nullopt) << "told once";
    EXPECT_FALSE(controller_.modelIsOpen());
    turn();
    EXPECT_TRUE(notes("mine.glb was touched and is not open"));
    openModel(model_);
    turn();
    EXPECT_TRUE(controller_.modelIsOpen());
    EXPECT_TRUE(controller_.notes().empty());
    controller_.playback().step(3000);
    turnUntil([&] { return controller_.tickComplete(); });
    EXPECT_EQ(controller_.tick().output.proxy, lived_[3000].output.proxy);
    EXPECT_EQ(controller_.tick().output.planeCount, lived_[3000].output.planeCount);
    EXPECT_EQ(controller_.settings(), HapticSettings{});
    controller_.leave();
    EXPECT_FALSE(controller_.looking());
    turn();
    EXPECT_FALSE(controller_.looking());
}

TEST_F(ControllerTest, WhatIsOpenAlreadyIsNotAskedFor) {
    record(Fit::Workspace);
    openModel(model_);
    controller_.open(file_);
    turnUntil([&] { return controller_.looking(); });
    EXPECT_EQ(controller_.takeModelWanted(), std::nullopt);
    EXPECT_TRUE(controller_.modelIsOpen());
}

TEST_F(ControllerTest, AModelThatIsFittedOtherwiseIsTouchedWhereItWasTouched) {
    record(Fit::None);
    openModel(model_);
    controller_.open(file_);
    turnUntil([&] { return controller_.looking(); });
    controller_.playback().step(3000);
    turnUntil([&] { return controller_.tickComplete(); });
    const Similarity openFromRecorded =
        opened_.workspaceFromScene * workspaceFromScene(*opened_.scene, Fit::None).inverse();
    const glm::dvec3 recorded = lived_[3000].output.proxy, shown = controller_.tick().output.proxy;
    EXPECT_LT(glm::distance(shown, openFromRecorded.point(recorded)), 1e-12);
    EXPECT_GT(glm::distance(shown, recorded), 1e-3) << "the two are not the same place";
    EXPECT_LT(glm::distance(shown, overTheDoughnut(lived_[3000].time)), 3e-3) << "on the glaze";
}

TEST_F(ControllerTest, AVolumeSaysAtWhichValueItWasTouched) {
    const std::filesystem::path path = scratch_ / "ball.nrrd";
    {
        const std::vector<std::byte> bytes =
            assets::nrrdOf(assets::makeVolume("ball", glm::ivec3(24), "int16"));
        std::ofstream(path, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    LoadOptions options;
    options.iso = 60.0;
    const Model touched = loadModel(path, Fit::Workspace, options);
    const SceneIdentity identity = identify(*touched.haptic, *touched.scene, Fit::Workspace);
    RecordedServo rig([](double time) { return at({0.0, 0.05 - 0.01 * time, 0.0}); });
    rig.recorder.start(file_, "test");
    rig.offer({touched.scene, touched.haptic, identity});
    rig.steps(1000);
    rig.finish();
    opened_ = touched;
    identity_ = identity;
    controller_.open(file_);
    turnUntil([&] { return controller_.looking(); });
    turn();
    EXPECT_TRUE(controller_.modelIsOpen());
    EXPECT_TRUE(controller_.notes().empty()) << controller_.notes()[0];
    options.iso = 150.0;
    opened_ = loadModel(path, Fit::Workspace, options);
    identity_ = identify(*opened_.haptic, *opened_.scene, Fit::Workspace);
    turn();
    EXPECT_TRUE(controller_.modelIsOpen());
    EXPECT_TRUE(notes("it was touched with the surface at 60"));
    EXPECT_FALSE(notes("materials"));
}

TEST_F(ControllerTest, AModelThatIsGoneOrOtherwiseSaysSo) {
    record(Fit::Workspace);
    std::filesystem::rename(model_, scratch_ / "elsewhere");
    openModel(TOUCHSTONE_ASSETS "/box.glb");
    controller_.open(file_);
    turnUntil([&] { return controller_.looking(); });
    turn();
    EXPECT_EQ(controller_.takeModelWanted(), std::nullopt);
    EXPECT_FALSE(controller_.modelIsOpen());
    EXPECT_TRUE(notes("is not there: only the curves are shown"));
    EXPECT_GT(controller_.timeline().force().over(0, controller_.timeline().size()).most, 0.1f);

    std::filesystem::copy_file(TOUCHSTONE_ASSETS "/torus_64800.glb", model_);
    controller_.open(file_);
    turnUntil([&] { return controller_.takeModelWanted().has_value(); });
    openModel(model_);
    turn();
    EXPECT_TRUE(controller_.modelIsOpen());
    EXPECT_TRUE(notes("mine.glb has changed since it was touched"));
    controller_.verify();
    turnUntil([&] { return !controller_.verdict().empty(); });
    EXPECT_FALSE(controller_.verdictEqual());
    EXPECT_NE(controller_.verdict().find("differs first"), std::string::npos) << controller_.verdict();
    EXPECT_NE(controller_.verdict().find("what is felt is not the same"), std::string::npos)
        << controller_.verdict();
}

TEST_F(ControllerTest, WhatCannotBeOpenedLeavesWhatIsLookedAt) {
    record(Fit::Workspace);
    controller_.open(file_);
    turnUntil([&] { return controller_.looking(); });
    controller_.playback().step(1234);
    writeTextFile(scratch_ / "bad.tsrec", "hm");
    controller_.open(scratch_ / "bad.tsrec");
    std::optional<Error> problem;
    turnUntil([&] { return (problem = controller_.takeProblem()).has_value(); });
    EXPECT_EQ(problem->problem(), "is no recording of Touchstone");
    EXPECT_TRUE(controller_.looking());
    EXPECT_EQ(controller_.playback().cursor(), 1234u);
    controller_.open(file_);
    controller_.cancelOpening();
    for (int i = 0; i < 50; ++i)
        turn();
    EXPECT_FALSE(controller_.opening());
    EXPECT_EQ(controller_.playback().cursor(), 1234u) << "it was given up";
}

TEST_F(ControllerTest, ComparesTheRecordingWithTheChosenSettings) {
    record(Fit::Workspace);
    controller_.open(file_);
    turnUntil([&] { return controller_.looking(); });
    const Timeline& then = controller_.timeline();
    settings_ = then.settingsOf(0);
    settings_->forceEnabled = false; // the key changes no contact
    turn();
    EXPECT_EQ(controller_.comparison().result(), nullptr) << "nobody asked";
    controller_.compare(true);
    turnUntil([&] { return controller_.comparison().result() != nullptr; });
    const ComparedTouch* compared = controller_.comparison().result();
    EXPECT_EQ(compared->change, "");
    EXPECT_GT(compared->figures.ticks(), 100u);
    EXPECT_EQ(compared->figures.maxDifference(), 0.0);
    ASSERT_EQ(compared->force.size(), then.size());
    for (size_t i = 0; i < then.size(); ++i)
        ASSERT_EQ(compared->force[i], then.force()[i]) << i;
    settings_->stiffness = 200.0;
    turnUntil([&] { return controller_.comparison().result()->change != ""; });
    compared = controller_.comparison().result();
    EXPECT_EQ(compared->change, settingsDifference(then.settingsOf(0), compared->settings));
    EXPECT_LT(compared->figures.other().mean, 0.9 * compared->figures.recorded().mean);
    EXPECT_NE(compared->text().find("with " + compared->change), std::string::npos) << compared->text();
    controller_.compare(false);
    EXPECT_EQ(controller_.comparison().result(), nullptr);
    controller_.compare(true);
    std::filesystem::remove(model_);
    controller_.leave();
    EXPECT_FALSE(controller_.comparison().wanted());
}

TEST_F(ControllerTest, AComparisonWithoutItsModelSaysWhy) {
    record(Fit::Workspace);
    std::filesystem::remove(model_);
    controller_.open(file_);
    turnUntil([&] { return controller_.looking(); });
    settings_.emplace();
    controller_.compare(true);
    turnUntil([&] { return !controller_.comparison().problem().empty(); });
    EXPECT_NE(controller_.comparison().problem().find("is not there"), std::string::npos)
        << controller_.comparison().problem();
    for (int i = 0; i < 20; ++i)
        turn();
    EXPECT_FALSE(controller_.comparison().busy()) << "it is not tried for ever";
}

TEST_F(ControllerTest, MayBeLeftAtAnyMoment) {
    record(Fit::Workspace);
    for (int turns = 0; turns < 40; turns += 3) {
        controller_.open(file_);
        turnUntil([&] { return controller_.looking(); });
        controller_.verify();
        settings_ = HapticSettings{};
        controller_.compare(true);
        controller_.touchAgain();
        controller_.playback().play(true);
        for (int i = 0; i < turns; ++i)
            turn();
        controller_.leave();
        turn();
        ASSERT_FALSE(controller_.looking());
        ASSERT_FALSE(controller_.again().running());
        ASSERT_FALSE(controller_.verifying());
    }
}

} // namespace
} // namespace touchstone::test::desk_test
