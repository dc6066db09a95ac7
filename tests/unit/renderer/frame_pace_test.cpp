#include "renderer/frame_pace.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace touchstone {
namespace {

constexpr double kPeriod = 1.0 / 30.0;

/// A program that draws for `busy` s and then waits until the next frame is due, and wakes `late`.
class Loop {
  public:
    double frame(double busy, double late = 0.0) {
        pace.begin(now);
        const double begun = now;
        now = std::max(now + busy, pace.due() + late);
        return begun;
    }
    FramePace pace{kPeriod};
    double now = 100.0;
};

TEST(FramePace, DelaysAreNotLostForGood) {
    Loop loop;
    for (int i = 0; i < 300; ++i)
        loop.frame(0.010, i % 3 == 0 ? 0.004 : 0.0005);
    EXPECT_NEAR(loop.now - 100.0, 300 * kPeriod, 0.005);
    EXPECT_NEAR(loop.pace.rate(), 30.0, 0.2);
}

TEST(FramePace, ShortFramesMakeUpForLongOnes) {
    Loop loop;
    for (int i = 0; i < 150; ++i) {
        loop.frame(0.045);
        loop.frame(0.020);
    }
    EXPECT_NEAR(loop.now - 100.0, 300 * kPeriod, kPeriod);
}

TEST(FramePace, FramesThatAreTooLongFollowEachOtherAtOnce) {
    Loop loop;
    for (int i = 0; i < 300; ++i)
        loop.frame(0.040);
    EXPECT_NEAR(loop.now - 100.0, 300 * 0.040, 1.5 * kPeriod);
    EXPECT_NEAR(loop.pace.rate(), 25.0, 0.5);
}

TEST(FramePace, NoBurstFollowsAHalt) {
    Loop loop;
    for (int i = 0; i < 10; ++i)
        loop.frame(0.005);
    loop.frame(2.0);
    const double after = loop.frame(0.005);
    std::vector<double> begun;
    for (int i = 0; i < 4; ++i)
        begun.push_back(loop.frame(0.005));
    EXPECT_LE(begun.front() - after, kPeriod + 1e-9);
    for (size_t i = 1; i < begun.size(); ++i)
        EXPECT_NEAR(begun[i] - begun[i - 1], kPeriod, 1e-9);
}

TEST(FramePace, TheNextFrameIsNeverMoreThanAPeriodAway) {
    Loop loop;
    for (int i = 0; i < 1000; ++i) {
        const double begun = loop.frame(0.0007 * (i * 37 % 97), 0.0001 * (i % 11));
        EXPECT_LE(loop.pace.due() - begun, kPeriod + 1e-9);
    }
}

TEST(FramePace, TheRateIsOfTimeNotOfFrames) {
    Loop loop;
    for (int i = 0; i < 100; ++i) {
        loop.frame(0.005);
        loop.frame(0.150);
    }
    EXPECT_NEAR(loop.pace.rate(), 200.0 / (loop.now - 100.0), 1.0);
}

} // namespace
} // namespace touchstone
