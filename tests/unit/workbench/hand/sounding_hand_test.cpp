#include "haptics/safety/force_limiter.h"
#include "tests/support/recorded_servo.h"
#include "workbench/sound/sounding_hand.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace touchstone::test {
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

} // namespace
} // namespace touchstone::test
