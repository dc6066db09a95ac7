#include "renderer/adaptive_resolution.h"

#include <gtest/gtest.h>

#include <cmath>

namespace touchstone {
namespace {

/// Frames whose cost is a fixed part and a part that goes with the pixels.
int changesWhileDrawing(AdaptiveResolution& resolution, int frames, double fixed, double atFullScale) {
    int changes = 0;
    for (int i = 0; i < frames; ++i) {
        const double before = resolution.scale();
        resolution.frameDone(fixed + atFullScale * before * before);
        changes += resolution.scale() != before;
    }
    return changes;
}

TEST(AdaptiveResolution, StaysSharpWhileThereIsTime) {
    AdaptiveResolution resolution({});
    EXPECT_EQ(changesWhileDrawing(resolution, 300, 0.001, 0.010), 0);
    EXPECT_EQ(resolution.sceneSize({1280, 720}), glm::ivec2(1280, 720));
}

TEST(AdaptiveResolution, ShrinksUntilTheBudgetHolds) {
    AdaptiveResolution resolution({});
    changesWhileDrawing(resolution, 200, 0.005, 0.060);
    const double busy = 0.005 + 0.060 * resolution.scale() * resolution.scale();
    EXPECT_LT(busy, 1.0 / 30.0);
    EXPECT_GT(busy, 0.5 / 30.0) << "no more than needed";
}

TEST(AdaptiveResolution, NeverBelowTheSmallestScale) {
    AdaptiveResolution resolution({});
    changesWhileDrawing(resolution, 500, 1.0, 1.0);
    EXPECT_EQ(resolution.scale(), AdaptiveResolution::Limits{}.smallestScale);
}

TEST(AdaptiveResolution, RisesAgainWhenTheLoadHasGone) {
    AdaptiveResolution resolution({});
    changesWhileDrawing(resolution, 200, 0.005, 0.060);
    ASSERT_LT(resolution.scale(), 0.9);
    changesWhileDrawing(resolution, 2000, 0.001, 0.005);
    EXPECT_EQ(resolution.scale(), 1.0);
}

TEST(AdaptiveResolution, DoesNotSwing) {
    AdaptiveResolution resolution({});
    changesWhileDrawing(resolution, 200, 0.005, 0.040);
    EXPECT_LE(changesWhileDrawing(resolution, 3000, 0.005, 0.040), 12);
}

TEST(AdaptiveResolution, OneHiccupDoesNotBlurThePicture) {
    AdaptiveResolution resolution({});
    changesWhileDrawing(resolution, 100, 0.001, 0.010);
    resolution.frameDone(0.05);
    EXPECT_EQ(resolution.scale(), 1.0);
}

TEST(AdaptiveResolution, LargestPixelsHoldAndAspectIsKept) {
    AdaptiveResolution resolution({.largestPixels = 800 * 450});
    const glm::ivec2 size = resolution.sceneSize({1920, 1080});
    EXPECT_EQ(size, glm::ivec2(800, 448));
    EXPECT_EQ(resolution.sceneSize({0, 0}), glm::ivec2(16, 16));
}

TEST(AdaptiveResolution, IgnoresWhatIsNotATime) {
    AdaptiveResolution resolution({});
    for (int i = 0; i < 100; ++i)
        resolution.frameDone(std::nan(""));
    EXPECT_EQ(resolution.scale(), 1.0);
}

} // namespace
} // namespace touchstone
