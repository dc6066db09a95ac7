// A million samples of every kind through the whole step, on scenes with every effect.

#include "engine/core/float_mode.h"
#include "tests/property/device_storm.h"

#include <gtest/gtest.h>

#include <thread>

namespace touchstone::test {
namespace {

constexpr uint64_t kTicks = 200000; // for each of five scenes

class DeviceStorm : public testing::TestWithParam<const char*> {};

TEST_P(DeviceStorm, NothingThatADeviceSaysGetsPastTheLimits) {
    StormFigures figures;
    std::thread servo([&] { // denormals are flushed, as on the servo
        enterFloatMode();
        figures = storm(GetParam(), 1, kTicks / 2);
    });
    servo.join();
    const StormFigures more = storm(GetParam(), 2, kTicks / 2); // and they are not
    for (const StormFigures& one : {figures, more}) {
        EXPECT_EQ(one.ticks, kTicks / 2);
        EXPECT_EQ(one.faults, 0u) << "no sample may make a force that is no number";
        // Or the storm was too mild, or too wild to touch anything.
        EXPECT_GT(one.contacts, one.ticks / 50);
        EXPECT_GT(one.forces, one.ticks / 50);
        EXPECT_GT(one.invalid, one.ticks / 100);
        EXPECT_GT(one.limited, one.ticks / 1000);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, DeviceStorm,
                         testing::Values("doughnut.glb", "swatches.glb", "moving.glb", "torus_64800.glb",
                                         "box.glb"));

} // namespace
} // namespace touchstone::test
