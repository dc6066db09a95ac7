// A replay of a real servo's recording meets every bit; of a recording that was changed it names tick and
// stage.

#include "devices/device/workspace_map.h"
#include "engine/core/error.h"
#include "tests/support/program.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <cmath>
#include <csignal>
#include <random>
#include <thread>

namespace touchstone::test {
namespace {

class ReplayTest : public testing::Test {
  protected:
    ScratchFolder scratch_;
    std::filesystem::path file_ = scratch_ / "r.tsrec";
};

DeviceSample doughnutHand(double time) {
    return at(overTheDoughnut(time));
}

TEST_F(ReplayTest, ARunFromItsFirstTick) {
    RecordedServo rig(doughnutHand);
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    rig.ticks(6000);
    rig.finish();
    EXPECT_FALSE(rig.recorder.recording()) << "the file is complete before the recorder goes";
    const ReplayReport report = replayOf(file_, rig.scenes);
    expectEqualReplay(report);
    EXPECT_EQ(report.ticks, rig.servo.counters().ticks) << "every one";
    EXPECT_FALSE(report.cutOff);
    EXPECT_EQ(report.gaps, 0u);
    EXPECT_EQ(report.origin.command, "test");
    EXPECT_EQ(report.origin.rateHz, 4000.0);
    EXPECT_GT(rig.inContact(), 2000u);
    EXPECT_TRUE(rig.recorder.takeProblem().empty());
}

/// No file may grow beyond `bytes` during its lifetime, as on a disk that is full.
class SmallDisk {
  public:
    explicit SmallDisk(rlim_t bytes) {
        getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit small{bytes, before_.rlim_max};
        setrlimit(RLIMIT_FSIZE, &small);
    }
    ~SmallDisk() {
        setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    SmallDisk(const SmallDisk&) = delete;
    SmallDisk& operator=(const SmallDisk&) = delete;

  private:
    rlimit before_{};
    void (*handler_)(int) = std::signal(SIGXFSZ, SIG_IGN);
};

TEST_F(ReplayTest, ARecordingThatFailsEndsAndSaysSo) {
    RecordedServo rig(doughnutHand);
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    {
        const SmallDisk disk(100'000);
        rig.ticks(3000);
        rig.finish();
    }
    EXPECT_TRUE(rig.recorder.failed());
    EXPECT_FALSE(rig.recorder.recording());
    EXPECT_NE(rig.recorder.takeProblem(), "");
    EXPECT_EQ(rig.recorder.takeProblem(), "") << "once";
    const ReplayReport report = replayOf(file_, rig.scenes); // what was written before is whole
    EXPECT_FALSE(report.first.has_value());
    EXPECT_GT(report.replayed, 100u);
}

TEST_F(ReplayTest, OfATickWhoseStagesWereTimed) {
    ServoConfig config = RecordedServo::kQuick;
    config.stageTimes = true;
    RecordedServo rig(doughnutHand, config);
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    rig.ticks(6000);
    rig.finish();
    expectEqualReplay(replayOf(file_, rig.scenes)); // which takes no time
    EXPECT_GT(rig.inContact(), 2000u);
}

TEST_F(ReplayTest, FromTheMiddleOfARun) {
    RecordedServo rig(doughnutHand);
    rig.offer(touchedScene("doughnut.glb"));
    rig.ticks(5000);
    rig.recorder.start(file_, "test");
    rig.ticks(5000);
    rig.recorder.stop();
    rig.ticks(500);
    rig.finish();
    const ReplayReport report = replayOf(file_, rig.scenes);
    expectEqualReplay(report);
    EXPECT_GT(report.ticks, 4000u) << "it begins with the next tick, not with the next second";
    EXPECT_LT(report.ticks, rig.servo.counters().ticks - 5000u);
}

TEST_F(ReplayTest, ClutchAndZoomInContact) {
    // The hand goes round in contact while its workspace is zoomed and clutched at will.
    struct Hand {
        WorkspaceMap map;
        double last = 0.0;
    };
    const auto hand = std::make_shared<Hand>();
    RecordedServo rig([hand](double time) {
        DeviceSample sample = doughnutHand(time);
        hand->map.apply(
            sample,
            {.zoom = time < 0.3 ? 1.0 : std::exp(std::sin(5.0 * time)), .clutch = std::fmod(time, 0.7) > 0.6},
            time - hand->last);
        hand->last = time;
        return sample;
    });
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    rig.steps(12000);
    rig.finish();
    const ReplayReport report = replayOf(file_, rig.scenes);
    expectEqualReplay(report);
    EXPECT_EQ(report.ticks, rig.servo.counters().ticks);
    rig.expectWithinLimits();
    EXPECT_GT(rig.inContact(), 1000u);
    size_t mapped = 0, clutched = 0;
    for (const TickRecord& record : rig.records) {
        mapped += record.sample.mapping.workspaceFromDevice.scale != 1.0;
        clutched += record.sample.mapping.coupling == 0.0;
    }
    EXPECT_GT(mapped, 8000u);
    EXPECT_GT(clutched, 200u);
}

TEST_F(ReplayTest, ObjectsThatMoveAndASceneThatIsSwappedInContact) {
    std::atomic<bool> weak{false}; // another device
    RecordedServo rig([&](double time) {
        DeviceSample sample = doughnutHand(time);
        if (weak)
            sample.limits = {.maxForce = 2.0, .recommendedStiffness = 900.0};
        return sample;
    });
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    rig.ticks(3000);
    rig.offer(touchedScene("moving.glb"));
    rig.ticks(5000);
    rig.offer(floorScene(0.03f)); // the hand is under it
    rig.ticks(2000);
    weak = true;
    rig.offer(touchedScene("doughnut.glb"));
    rig.ticks(3000);
    rig.finish();
    const ReplayReport report = replayOf(file_, rig.scenes);
    expectEqualReplay(report);
    EXPECT_EQ(report.ticks, rig.servo.counters().ticks);
    rig.expectWithinLimits();
}

TEST_F(ReplayTest, MaterialsThatChangeWhileTheyAreTouched) {
    for (const char* file : {"doughnut.glb", "moving.glb"}) {
        TouchedScene scene = touchedScene(file);
        // In and out of the first object.
        RecordedServo rig([&, sphere = scene.haptic->restSpheres[0]](double time) {
            const double depth = 1.0 + 0.6 * std::cos(12.0 * time);
            return at(glm::dvec3(sphere) + sphere.w * depth * glm::normalize(glm::dvec3(0.3, 1.0, 0.2)));
        });
        rig.recorder.start(file_, "test");
        rig.offer(scene);
        rig.steps(1500);
        std::mt19937 random(5);
        const auto number = [&](float most) { return most * static_cast<float>(random() % 1000u) / 1000.0f; };
        for (int i = 0; i < 40; ++i) {
            scene = withChanged(scene, [&](HapticMaterial& haptic) {
                haptic.stiffness.value = 200.0f + number(2000.0f);
                haptic.damping.value = number(3.0f);
                haptic.staticFriction.value = number(1.0f);
                haptic.dynamicFriction.value = haptic.staticFriction.value;
                haptic.normalTextureInfluence.value = i % 3 == 0 ? 0.0f : number(1.0f);
                haptic.forceShading = i % 5 == 0 ? ShadingChoice::Off : ShadingChoice::Auto;
            });
            rig.offer(scene, SceneSwap::SameGeometry);
            rig.steps(120);
        }
        rig.finish();
        const ReplayReport report = replayOf(file_, rig.scenes);
        expectEqualReplay(report);
        EXPECT_EQ(report.ticks, rig.servo.counters().ticks);
        rig.expectWithinLimits();
        EXPECT_GT(rig.inContact(), 1000u) << file;
    }
}

/// A hand that presses on a floor and holds still.
TEST_F(ReplayTest, TouchGoesOnWhereOnlyTheMaterialChanges) {
    double height = 0.01;
    RecordedServo rig([&](double) { return at({0.01, height, 0.02}); });
    rig.recorder.start(file_, "test");
    TouchedScene scene = floorScene(0.0f);
    rig.offer(scene);
    rig.steps(1000);
    height = -0.002;
    rig.steps(1000);
    const auto force = [&] { return rig.records.back().output.force; };
    const glm::dvec3 before = force();
    const size_t ramping = rig.countOf(TickFlag::ForceRamping), first = rig.records.size();
    ASSERT_GT(glm::length(before), 1.0);
    rig.offer(withChanged(scene, [](HapticMaterial&) {}), SceneSwap::SameGeometry);
    rig.steps(500);
    EXPECT_EQ(force(), before) << "nothing has changed";
    scene = withChanged(scene, [](HapticMaterial& haptic) { haptic.stiffness.value = 1200.0f; });
    rig.offer(scene, SceneSwap::SameGeometry);
    rig.steps(500);
    EXPECT_NEAR(glm::length(force()), 1200.0 / 600.0 * glm::length(before), 1e-6 * glm::length(before));
    EXPECT_EQ(rig.countOf(TickFlag::ForceRamping), ramping) << "no force fades in";
    for (size_t i = first; i < rig.records.size(); ++i)
        ASSERT_GT(rig.records[i].output.contacts, 0u) << "tick " << rig.records[i].tick;
    rig.offer(scene); // another world, though it is the same
    rig.steps(1000);
    EXPECT_GT(rig.countOf(TickFlag::ForceRamping), ramping);
    // Behind another world the geometry is that one's.
    rig.offer(scene, SceneSwap::SameGeometry);
    rig.steps(200);
    rig.finish();
    rig.expectWithinLimits();
    expectEqualReplay(replayOf(file_, rig.scenes));
}

TEST_F(ReplayTest, SettingsThatChangeAllTheTimeForceOffAndOn) {
    RecordedServo rig(doughnutHand);
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    std::mt19937 random(5);
    rig.ticks(8000, [&] {
        for (int i = 0; i < 20; ++i) {
            HapticSettings settings;
            settings.contact = random() % 3 == 0 ? ContactMethod::Neighbourhood : ContactMethod::Sweep;
            settings.forceShading = static_cast<ShadingMode>(random() % 5);
            settings.texture = static_cast<TextureMode>(random() % 4);
            settings.friction = static_cast<FrictionMode>(random() % 4);
            settings.passivity = static_cast<PassivityMode>(random() % 3);
            settings.proxyRadius = random() % 2 == 0 ? 0.0 : 1e-3;
            settings.staticFriction = 0.1 * static_cast<double>(random() % 10);
            settings.stiffness = 100.0 * static_cast<double>(random() % 20);
            settings.shadingTiltLimit = 0.1 + 1e-3 * static_cast<double>(random() % 100);
            settings.iterationBudget = 1 + static_cast<int>(random() % 64);
            settings.forceEnabled = random() % 4 != 0;
            rig.servo.setSettings(settings);
            std::this_thread::sleep_for(std::chrono::microseconds(300));
        }
        // What the watch walks on comes in the middle of the run.
        if (rig.records.size() > 4000)
            rig.scenes[0].haptic->buildNeighbourhoods();
    });
    rig.finish();
    EXPECT_GT(rig.countOf(TickFlag::NeighbourhoodMissing), 0u);
    const ReplayReport report = replayOf(file_, rig.scenes);
    expectEqualReplay(report);
    EXPECT_EQ(report.ticks, rig.servo.counters().ticks);
    rig.expectWithinLimits();
}

TEST_F(ReplayTest, SamplesOfEveryKind) {
    std::mt19937 random(11);
    RecordedServo rig([&](double time) {
        DeviceSample sample = doughnutHand(time);
        switch (random() % 400) {
        case 0:
            sample.position.x = std::nan("");
            break;
        case 1:
            sample.position.y = INFINITY;
            break;
        case 2:
            sample.position *= 1e300;
            break;
        case 3:
            sample.position = glm::dvec3(5e-324);
            break;
        case 4:
            sample.valid = false;
            break;
        case 5:
            sample.age = std::nan("");
            break;
        case 6:
            sample.age = 10.0;
            break;
        case 7:
            sample.position = -sample.position;
            break;
        default:
            break;
        }
        return sample;
    });
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    rig.ticks(6000);
    rig.finish();
    EXPECT_GT(rig.countOf(TickFlag::InputInvalid), 30u);
    expectEqualReplay(replayOf(file_, rig.scenes));
    rig.expectWithinLimits();
}

TEST_F(ReplayTest, AServoThatIsStoppedAndStartedAgain) {
    RecordedServo rig(doughnutHand);
    rig.recorder.start(file_, "test");
    rig.ticks(200); // without a scene
    rig.offer(touchedScene("moving.glb"));
    rig.ticks(3000);
    rig.servo.stop();
    rig.ticks(3000);
    rig.servo.stop();
    rig.finish();
    const ReplayReport report = replayOf(file_, rig.scenes);
    expectEqualReplay(report);
    EXPECT_EQ(report.ticks, rig.servo.counters().ticks);
}

/// Its ticks have the numbers of the run before, from whose end states of bodies were left.
TEST_F(ReplayTest, ARecordingThatBeginsWithTheNextRunHasTheBodies) {
    for (const char* name : {"blocks.glb", "cloth.glb"}) {
        RecordedServo rig(doughnutHand);
        rig.offer(touchedScene(name));
        rig.ticks(12000);
        rig.servo.stop();
        rig.drain();
        rig.recorder.start(file_, "test");
        rig.ticks(6000);
        rig.finish();
        const ReplayReport report = replayOf(file_, rig.scenes);
        SCOPED_TRACE(name);
        expectEqualReplay(report);
        EXPECT_GE(report.ticks, 2000u);
        std::filesystem::remove(file_);
    }
}

TEST_F(ReplayTest, TicksThatWereNotReadInTimeAreSaidAndTheReplayGoesOnBehindThem) {
    RecordedServo rig(
        doughnutHand,
        {.rateHz = 4000.0, .ringCapacity = 256, .wantRealtime = false, .checkpointSeconds = 0.05});
    rig.recorder.start(file_, "test");
    rig.offer(touchedScene("doughnut.glb"));
    for (int i = 0; i < 5; ++i) {
        rig.ticks(1000);
        rig.ticksUnread(2000);
    }
    rig.ticks(1000);
    rig.finish();
    const uint64_t dropped = rig.servo.counters().droppedRecords;
    ASSERT_GT(dropped, 2000u);
    const ReplayReport report = replayOf(file_, rig.scenes);
    EXPECT_FALSE(report.first.has_value());
    EXPECT_GE(report.gaps, 5u);
    EXPECT_EQ(report.lost, dropped);
    EXPECT_EQ(report.ticks + report.lost, rig.servo.counters().ticks);
    EXPECT_LT(report.replayed, report.ticks);
    EXPECT_GT(report.replayed, report.ticks / 2);
}

/// A recording of every effect, to be tampered with: a step a tick, all settings in one chunk.
class TamperedTest : public ReplayTest {
  protected:
    TamperedTest() {
        RecordedServo rig(doughnutHand);
        HapticSettings settings;
        settings.staticFriction = 0.6;
        settings.dynamicFriction = 0.4;
        settings.proxyRadius = 1e-3;
        rig.servo.setSettings(settings);
        rig.recorder.start(file_, "test");
        rig.offer(touchedScene("doughnut.glb"));
        rig.steps(5000); // of a quarter of a millisecond: a second checkpoint
        rig.finish();
        scenes_ = rig.scenes;
        items_ = itemsOf(file_);
    }
    template <class Item>
    void each(const std::function<void(Item&)>& change) {
        for (RecordedItem& item : items_)
            if (auto* found = std::get_if<Item>(&item))
                change(*found);
    }
    void eachTick(const std::function<void(RecordedTick&)>& change) {
        each<RecordedTicks>(
            [&](RecordedTicks& block) { std::for_each(block.ticks.begin(), block.ticks.end(), change); });
    }
    ReplayReport replay() {
        writeItems(file_, items_);
        return replayOf(file_, scenes_);
    }
    std::string firstStage() {
        const ReplayReport report = replay();
        return report.first ? report.first->stage : "equal";
    }
    std::string stageWith(const std::string& name, const std::string& value) {
        each<RecordedSettings>(
            [&](RecordedSettings& s) { EXPECT_EQ(setSetting(s.settings, name, value), ""); });
        return firstStage();
    }

    std::vector<TouchedScene> scenes_;
    std::vector<RecordedItem> items_;
};

TEST_F(TamperedTest, UntouchedItIsEqual) {
    expectEqualReplay(replay());
}
TEST_F(TamperedTest, AnotherSampleDiffersInItsTickAndInTheFirstStage) {
    uint64_t changed = 0;
    eachTick([&](RecordedTick& tick) {
        if (changed == 0 && tick.tick >= 2210) {
            tick.sample.position.x = std::nextafter(tick.sample.position.x, 1.0);
            changed = tick.tick;
        }
    });
    const ReplayReport report = replay();
    ASSERT_TRUE(report.first.has_value());
    EXPECT_EQ(report.first->tick, changed);
    EXPECT_EQ(report.first->stage, "sample");
    EXPECT_LT(report.differing, report.replayed) << "it comes back at the next checkpoint";
    EXPECT_LT(glm::length(report.first->recordedForce - report.first->replayedForce), 1e-3);
}
TEST_F(TamperedTest, AnotherSampleThatIsInvalidAnyway) {
    eachTick([](RecordedTick& tick) { tick.sample.buttons ^= 3; });
    EXPECT_EQ(firstStage(), "equal") << "nothing is felt of buttons";
}
TEST_F(TamperedTest, AnotherProxyRadius) {
    const std::string stage = stageWith("proxyRadius", "0.0012");
    EXPECT_TRUE(stage == "contact" || stage == "proxy") << stage;
}
TEST_F(TamperedTest, NoForceShading) {
    EXPECT_EQ(stageWith("forceShading", "off"), "shading");
}
TEST_F(TamperedTest, NoTexture) {
    EXPECT_EQ(stageWith("texture", "off"), "texture");
}
TEST_F(TamperedTest, AnotherFriction) {
    EXPECT_EQ(stageWith("staticFriction", "0.2"), "friction");
}
TEST_F(TamperedTest, AnotherDamping) {
    EXPECT_EQ(stageWith("damping", "3"), "force");
}
TEST_F(TamperedTest, ForceOff) {
    EXPECT_EQ(stageWith("forceEnabled", "off"), "safety");
}
TEST_F(TamperedTest, TicksThatWereLate) {
    uint64_t first = 0;
    eachTick([&](RecordedTick& tick) {
        if (tick.tick >= 1000 && tick.tick < 1300) {
            first = first == 0 ? tick.tick : first;
            tick.late = true;
        }
    });
    const ReplayReport report = replay();
    ASSERT_TRUE(report.first.has_value());
    EXPECT_EQ(report.first->stage, "safety");
    EXPECT_GE(report.first->tick, first + kLateTicksToLatch - 1) << "so many in a row latch";
}
TEST_F(TamperedTest, AnotherState) {
    bool first = true; // the first begins the run
    each<TouchCheckpoint>([&](TouchCheckpoint& checkpoint) {
        if (!std::exchange(first, false))
            checkpoint.bytes[1] ^= std::byte{1}; // a bit of the hand's last place
    });
    EXPECT_EQ(firstStage(), "state");
}
TEST_F(TamperedTest, AnotherScene) {
    scenes_[0] = floorScene(0.0f);
    each<RecordedScene>(
        [&](RecordedScene& scene) { scene.identity.feltHash = scenes_[0].identity.feltHash; });
    EXPECT_NE(firstStage(), "equal");
}
TEST_F(TamperedTest, AMissingBlockIsAGap) {
    const size_t middle = items_.size() / 2;
    std::vector<RecordedItem> kept;
    uint64_t lost = 0;
    for (size_t i = 0; i < items_.size(); ++i) {
        const auto* block = std::get_if<RecordedTicks>(&items_[i]);
        if (lost == 0 && i > middle && block != nullptr) {
            lost = block->ticks.size();
            kept.emplace_back(RecordedLoss{lost});
        } else {
            kept.push_back(items_[i]);
        }
    }
    items_ = kept;
    const ReplayReport report = replay();
    EXPECT_FALSE(report.first.has_value()) << "what is replayed is equal";
    EXPECT_EQ(report.gaps, 1u);
    EXPECT_EQ(report.lost, lost);
    EXPECT_LT(report.replayed, report.ticks);
}
/// A scene that comes without a checkpoint: the state that the hand had in it is unknown until the next one.
TEST_F(TamperedTest, AnotherSceneWithoutAStateIsNotReplayed) {
    each<RecordedScene>([](RecordedScene& scene) { scene.number = 1; });
    RecordedScene second;
    each<RecordedScene>([&](RecordedScene& scene) { second = scene; });
    second.number = 2;
    std::vector<RecordedItem> kept;
    size_t checkpoints = 0, unknown = 0;
    for (const RecordedItem& item : items_) {
        if (std::holds_alternative<TouchCheckpoint>(item) && ++checkpoints == 2) {
            kept.emplace_back(second);
            continue; // the state with which the second scene begins
        }
        kept.push_back(item);
        if (auto* checkpoint = std::get_if<TouchCheckpoint>(&kept.back()); checkpoint && checkpoints > 2)
            checkpoint->scene = 2;
        if (auto* block = std::get_if<RecordedTicks>(&kept.back()); block && checkpoints >= 2) {
            for (RecordedTick& tick : block->ticks)
                tick.scene = 2;
            unknown += checkpoints == 2 ? block->ticks.size() : 0;
        }
    }
    ASSERT_GE(checkpoints, 2u);
    ASSERT_GT(unknown, 0u);
    items_ = kept;
    scenes_.push_back(scenes_[0]);
    const ReplayReport report = replay();
    EXPECT_FALSE(report.first.has_value()) << report.first->stage;
    EXPECT_EQ(report.ticks - report.replayed, unknown);
}
TEST_F(TamperedTest, WhatContradictsItselfIsAnError) {
    const std::vector<RecordedItem> good = items_;
    std::erase_if(items_,
                  [](const RecordedItem& item) { return std::holds_alternative<RecordedSettings>(item); });
    EXPECT_THROW((void)replay(), Error);
    items_ = good;
    std::erase_if(items_,
                  [](const RecordedItem& item) { return std::holds_alternative<RecordedScene>(item); });
    EXPECT_THROW((void)replay(), Error);
    items_ = good;
    std::erase_if(items_,
                  [](const RecordedItem& item) { return std::holds_alternative<TouchCheckpoint>(item); });
    EXPECT_THROW((void)replay(), Error) << "no state to begin with";
}
TEST_F(TamperedTest, AnyTickInputIsReplayedWithoutHarm) {
    std::mt19937 random(2);
    for (int turn = 0; turn < 40; ++turn) {
        const std::vector<RecordedItem> good = items_;
        eachTick([&](RecordedTick& tick) {
            if (random() % 50 != 0)
                return;
            const double wild[] = {0.0, -1.0, 1e-300, 1e300, -1e9};
            tick.dt = wild[random() % 5];
            tick.time = random() % 2 == 0 ? wild[random() % 5] : tick.time;
            tick.sample.position.z = std::bit_cast<double>(static_cast<uint64_t>(random()) << 32 | random());
        });
        EXPECT_NE(firstStage(), "equal");
        items_ = good;
    }
}

} // namespace
} // namespace touchstone::test
