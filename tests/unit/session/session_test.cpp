// A session passes every tick to every subscriber, with the settings that it had.

#include "devices/simulated/simulated_hand.h"
#include "devices/stroke/stroke_library.h"
#include "engine/core/float_mode.h"
#include "session/device_port.h"
#include "session/session.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace touchstone::test {
namespace {

/// A device above a floor that taps it.
class TappingDevice final : public Device {
  public:
    explicit TappingDevice(double x) : x_(x) {}
    [[nodiscard]] std::string name() const override { return "tapping"; }
    [[nodiscard]] DeviceLimits limits() const override { return {.maxForce = 0.5}; }
    [[nodiscard]] DeviceSample sample(double time) noexcept override {
        return at({x_, 0.002 + 0.004 * std::cos(60.0 * time), 0.0});
    }
    void apply(const DeviceCommand& command) noexcept override { sent = command.force(); }

    glm::dvec3 sent{0.0};

  private:
    double x_;
};

struct Listener final : TickSubscriber {
    void sceneOffered(const OfferedScene& scene) override { scenes.push_back(scene); }
    void take(const TickRecord& record, const HapticSettings& settings) override {
        EXPECT_TRUE(std::ranges::any_of(scenes, [&](const OfferedScene& scene) {
            return scene.number == record.scene;
        })) << "each scene comes before its ticks";
        records.push_back(record);
        stiffness.push_back(settings.stiffness);
    }
    void flush(double now) override { flushes.push_back(now); }

    std::vector<OfferedScene> scenes;
    std::vector<TickRecord> records;
    std::vector<double> stiffness, flushes;
};

class SessionTest : public testing::Test {
  protected:
    void ticks(uint64_t count, double now) {
        const uint64_t goal = session_.servo().counters().ticks + count;
        while (session_.servo().counters().ticks < goal)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        session_.pump(now);
    }
    /// Made on this thread, without a clock: where a tick is late the force takes longer to its limit.
    void steps(uint64_t count, double now) {
        enterFloatMode();
        for (uint64_t i = 0; i < count; ++i)
            (void)session_.servo().step(session_.servo().counters().ticks);
        session_.pump(now);
    }

    TappingDevice first_{0.0}, second_{0.02};
    Session session_{{portOf(first_), portOf(second_)}, RecordedServo::kQuick};
    Listener one_, two_;
};

TEST_F(SessionTest, EverySubscriberTakesEveryTickOfEveryHandInOrder) {
    session_.subscribe(one_);
    session_.subscribe(two_);
    const TouchedScene floor = floorScene(0.0f);
    EXPECT_FALSE(session_.touching());
    const uint32_t number = session_.touch(floor.haptic, floor.source, floor.identity);
    HapticSettings settings;
    settings.stiffness = 321.0;
    session_.set(settings);
    steps(400, 1.5);
    EXPECT_TRUE(session_.touching());
    settings.stiffness = 432.0;
    session_.set(settings);
    session_.set(settings);
    steps(400, 2.5);
    session_.pump(3.5);
    ASSERT_EQ(one_.records.size(), 2 * session_.servo().counters().ticks);
    ASSERT_EQ(two_.records.size(), one_.records.size());
    EXPECT_EQ(one_.stiffness, two_.stiffness);
    EXPECT_EQ(one_.flushes, (std::vector<double>{1.5, 2.5, 3.5}));
    size_t contacts = 0;
    double strongest = 0.0;
    for (size_t i = 0; i < one_.records.size(); ++i) {
        const TickRecord& record = one_.records[i];
        ASSERT_EQ(record.step, i / 2);
        ASSERT_EQ(record.hand, 1 - i % 2) << "that of hand 0 is the last";
        ASSERT_EQ(record.scene, number);
        ASSERT_EQ(record.sample.limits.maxForce, 0.5) << "the device's, through its port";
        strongest = std::max(strongest, glm::length(record.output.command.force()));
        contacts += record.output.contacts > 0 ? 1 : 0;
    }
    EXPECT_GT(contacts, 100u);
    EXPECT_NEAR(strongest, 0.5, 1e-9);
    EXPECT_EQ(one_.stiffness.front(), 321.0);
    EXPECT_EQ(one_.stiffness.back(), 432.0);
    EXPECT_EQ(session_.tick().step, session_.servo().counters().ticks - 1) << "the newest one";
    EXPECT_EQ(session_.tick().hand, 0u);
}

TEST_F(SessionTest, OffersEachSceneBeforeItsTicksAndAgainWithANewFile) {
    session_.subscribe(one_);
    const TouchedScene floor = floorScene(0.0f), lower = floorScene(-0.01f);
    const uint32_t before = session_.touch(floor.haptic, floor.source, floor.identity);
    SceneIdentity saved = floor.identity;
    saved.path = "saved.glb";
    session_.identify(saved);
    ASSERT_EQ(one_.scenes.size(), 2u);
    EXPECT_EQ(one_.scenes[0].number, before);
    EXPECT_EQ(one_.scenes[1].number, before);
    EXPECT_EQ(one_.scenes[1].identity.path, "saved.glb");
    EXPECT_EQ(session_.scene().haptic, floor.haptic);
    session_.start();
    ticks(100, 0.0);
    const uint32_t after = session_.touch(lower.haptic, lower.source, lower.identity);
    EXPECT_NE(after, before);
    EXPECT_FALSE(session_.touching());
    ticks(100, 0.0);
    EXPECT_TRUE(session_.touching());
    session_.stop();
    session_.pump(0.0);
    EXPECT_EQ(session_.scene().number, after);
    EXPECT_EQ(one_.records.size(), 2 * session_.servo().counters().ticks) << "of both hands, while it ran";
    EXPECT_EQ(one_.records.front().scene, before);
    EXPECT_EQ(one_.records.back().scene, after);
    EXPECT_EQ(first_.sent, glm::dvec3(0.0)) << "at the end";
    EXPECT_EQ(second_.sent, glm::dvec3(0.0));
}

/// A path on what moves was carried by the time of the tick: at half the speed the hand dived by 21 mm.
TEST(SessionStroke, RidesOnAnAnimationAtAnySpeed) {
    for (const char* file : {"moving.glb", "breathing.glb"})
        for (const double speed : {1.0, 0.5, 0.0, -2.0}) {
            SCOPED_TRACE(std::string(file) + " at " + std::to_string(speed));
            const TouchedScene scene = touchedScene(file);
            const auto path = std::make_shared<const StrokePath>(
                layStroke(*scene.source, scene.haptic->workspaceFromScene, {.name = "circle"}));
            SimulatedHand hand(path);
            Session session({portOf(hand)}, {.wantRealtime = false});
            HapticSettings settings;
            settings.texture = TextureMode::Off;
            settings.friction = FrictionMode::Off;
            settings.forceShading = ShadingMode::Off;
            settings.animationSpeed = speed;
            settings.animationOffset = 0.3;
            (void)session.touch(scene.haptic, scene.source, scene.identity, settings);
            double deepest = 0.0;
            size_t contacts = 0;
            for (uint64_t tick = 0; 1e-3 * static_cast<double>(tick) < path->period(); ++tick) {
                const HapticOutput output = session.servo().step(tick).output;
                deepest = std::max(deepest, output.penetration);
                contacts += output.contacts > 0 ? 1 : 0;
            }
            EXPECT_GT(contacts, 1000u);
            EXPECT_LE(deepest, 1.5e-3);
        }
}

} // namespace
} // namespace touchstone::test
