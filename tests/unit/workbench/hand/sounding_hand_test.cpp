#include "haptics/safety/force_limiter.h"
#include "tests/support/recorded_servo.h"
#include "workbench/sound/sounding_hand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace touchstone::test::sounding_hand_test {
namespace {

TEST(SoundingHand, HearsPlaceAndForceInTheWorkspace) {
    ForceLimiterState state;
    state.ramp = 1.0;
    uint32_t flags = 0;
    SafetyInputs inputs;
    inputs.inputValid = true;
    const DeviceCommand command = ForceLimiter::limit({1.0, 0.0, 0.0}, {}, inputs, {}, state, flags);
    ASSERT_EQ(command.force(), glm::dvec3(1.0, 0.0, 0.0));
    DeviceSample sample = at({0.01, 0.02, 0.03});
    sample.mapping.workspaceFromDevice = {
        2.0, glm::angleAxis(0.5 * std::numbers::pi, glm::dvec3(0.0, 0.0, 1.0)), glm::dvec3(0.1, 0.0, 0.0)};
    const SoundTick tick = soundTick(1e-3, sample, command);
    EXPECT_LT(glm::distance(tick.force, glm::dvec3(0.0, 1.0, 0.0)), 1e-12) << "turned and not scaled";
    EXPECT_LT(glm::distance(tick.position, glm::dvec3(0.06, 0.02, 0.06)), 1e-12);
    EXPECT_TRUE(tick.handKnown);
}

TEST(SoundingHand, APlaceThatIsNoneIsNotHeardForEver) {
    DeviceSample sample = at({0.01, 0.02, NAN});
    EXPECT_FALSE(soundTick(1e-3, sample, {}).handKnown);
    ForceChange change;
    for (int i = 0; i < 100; ++i) {
        sample.position = {0.0, 0.0, i == 50 ? NAN : 1e-4 * i};
        SoundTick tick = soundTick(1e-3, sample, {});
        tick.force = {0.0, 1.0 + 0.1 * (i % 2), 0.0};
        const ForceRates rates = change.add(tick);
        ASSERT_TRUE(std::isfinite(rates.press) && std::isfinite(rates.drag)) << i;
    }
}

TEST(SoundingHand, HearsBodiesThatMeet) {
    // 25 mN s within a tick of 1 ms: 25 N, whose rise and fall are heard; what rests is silent.
    ForceChange change;
    const auto press = [&](double impact) {
        return static_cast<double>(change.add(soundTick(1e-3, DeviceSample{}, {}, impact)).press);
    };
    EXPECT_EQ(press(0.0), 0.0);
    EXPECT_NEAR(press(0.025), (25.0 - 1e3 * ForceChange::kResting) * 1e3, 1.0);
    EXPECT_NEAR(press(0.0), -(25.0 - 1e3 * ForceChange::kResting) * 1e3, 1.0);
    EXPECT_EQ(press(0.9 * ForceChange::kResting), 0.0);
}

TEST(SoundingHand, PassesOnWhatTheServoSaysOfBodies) {
    class Still final : public Device {
      public:
        [[nodiscard]] std::string name() const override { return "still"; }
        [[nodiscard]] DeviceLimits limits() const override { return {}; }
        [[nodiscard]] DeviceSample sample(double) noexcept override { return {}; }
        void apply(const DeviceCommand&) noexcept override {}
    } device;
    SoundFeed feed;
    SoundingHand hand(device, feed);
    std::atomic<double> impact{0.01};
    hand.hear(impact);
    feed.listen(true);
    for (const double time : {0.001, 0.002}) {
        (void)hand.sample(time);
        hand.apply({});
    }
    SoundTick tick;
    ASSERT_TRUE(feed.pop(tick));
    EXPECT_EQ(tick.impact, 0.01);
}

} // namespace
} // namespace touchstone::test::sounding_hand_test
