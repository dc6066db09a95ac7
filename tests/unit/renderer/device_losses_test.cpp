#include "renderer/device_losses.h"

#include <gtest/gtest.h>

namespace touchstone {
namespace {

TEST(DeviceLosses, TheThirdWithinTenSecondsIsOneTooMany) {
    DeviceLosses losses;
    EXPECT_TRUE(losses.mayReplace(0.5));
    EXPECT_TRUE(losses.mayReplace(0.6));
    EXPECT_FALSE(losses.mayReplace(10.4));
    EXPECT_EQ(losses.count(), 3u);
}

TEST(DeviceLosses, NowAndThenIsNoReasonToGiveUp) {
    DeviceLosses losses;
    for (int i = 0; i < 100; ++i)
        EXPECT_TRUE(losses.mayReplace(5.1 * i)) << i;
    EXPECT_TRUE(losses.mayReplace(600.0));
    EXPECT_TRUE(losses.mayReplace(609.9));
    EXPECT_FALSE(losses.mayReplace(610.0));
}

} // namespace
} // namespace touchstone
