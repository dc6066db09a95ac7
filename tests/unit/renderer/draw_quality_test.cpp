#include "renderer/draw_quality.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace touchstone {
namespace {

constexpr double kBudget = 1.0 / 30.0;

/// How often the quality changes in so many frames that take `cost` s at a quality.
int changesWhileDrawing(DrawQuality& quality, int frames,
                        const std::function<double(const DrawQuality&)>& cost) {
    int changes = 0;
    for (int i = 0; i < frames; ++i) {
        const double before = quality.quality();
        quality.frameDone(cost(quality));
        changes += quality.quality() != before;
    }
    return changes;
}

/// A fixed part, and a part that goes with the pixels.
auto fill(double fixed, double atFullScale) {
    return [=](const DrawQuality& at) { return fixed + atFullScale * at.scale() * at.scale(); };
}

/// Pixels, and triangles that are halved whenever the allowed error doubles from 0.1 on, as levels of detail
/// are.
auto detailed(double pixels, double triangles) {
    return [=](const DrawQuality& at) {
        const double halvings = std::max(0.0, std::floor(std::log2(std::max(at.allowedError(), 1e-9) / 0.1)));
        return 0.004 + pixels * at.scale() * at.scale() + triangles * std::exp2(-halvings);
    };
}

TEST(DrawQuality, StaysSharpWhileThereIsTime) {
    DrawQuality quality({.finestError = 0.25});
    EXPECT_EQ(changesWhileDrawing(quality, 300, fill(0.001, 0.010)), 0);
    EXPECT_EQ(quality.sceneSize({1280, 720}), glm::ivec2(1280, 720));
    EXPECT_EQ(quality.allowedError(), 0.25);
}

TEST(DrawQuality, ShrinksUntilTheBudgetHolds) {
    DrawQuality quality({});
    changesWhileDrawing(quality, 200, fill(0.005, 0.060));
    const double busy = fill(0.005, 0.060)(quality);
    EXPECT_LT(busy, kBudget);
    EXPECT_GT(busy, 0.5 * kBudget) << "no more than needed";
}

TEST(DrawQuality, NeverBeyondItsLimits) {
    DrawQuality quality({.finestError = 0.25, .coarsestError = 1.5});
    changesWhileDrawing(quality, 500, fill(1.0, 1.0));
    EXPECT_EQ(quality.scale(), DrawQuality::Limits{}.smallestScale);
    EXPECT_EQ(quality.allowedError(), 1.5);
}

TEST(DrawQuality, SimplerMeshesLeaveMoreToTheResolution) {
    const auto cost = detailed(0.020, 0.040);
    DrawQuality both({.smallestScale = 0.55, .finestError = 0.1, .coarsestError = 1.6});
    DrawQuality sizeOnly({.smallestScale = 0.55, .finestError = 0.1, .coarsestError = 0.1});
    changesWhileDrawing(both, 600, cost);
    changesWhileDrawing(sizeOnly, 600, cost);
    EXPECT_LT(cost(both), kBudget);
    EXPECT_GT(cost(sizeOnly), kBudget) << "the smallest image does not hold it";
    EXPECT_GT(both.scale(), sizeOnly.scale() + 0.1);
}

TEST(DrawQuality, HoldsTheBudgetWhereOnlyTrianglesCost) {
    DrawQuality quality({.smallestScale = 0.55, .finestError = 0.1, .coarsestError = 1.6});
    const auto cost = detailed(0.002, 0.100);
    changesWhileDrawing(quality, 600, cost);
    EXPECT_LT(cost(quality), kBudget);
}

TEST(DrawQuality, RisesAgainWhenTheLoadHasGone) {
    DrawQuality quality({});
    changesWhileDrawing(quality, 200, fill(0.005, 0.060));
    ASSERT_LT(quality.scale(), 0.9);
    changesWhileDrawing(quality, 2000, fill(0.001, 0.005));
    EXPECT_EQ(quality.quality(), 1.0);
}

TEST(DrawQuality, DoesNotSwing) {
    const std::function<double(const DrawQuality&)> costs[]{fill(0.005, 0.040), fill(0.020, 0.020),
                                                            detailed(0.020, 0.040), detailed(0.002, 0.100)};
    for (const auto& cost : costs) {
        DrawQuality quality({.smallestScale = 0.55, .finestError = 0.1, .coarsestError = 1.6});
        changesWhileDrawing(quality, 300, cost);
        EXPECT_LE(changesWhileDrawing(quality, 3000, cost), 16);
        EXPECT_LE(changesWhileDrawing(quality, 10'000, cost), 24) << "less and less often";
    }
}

TEST(DrawQuality, ARiseThatFailsIsTakenBack) {
    DrawQuality quality({.smallestScale = 0.5});
    changesWhileDrawing(quality, 400, fill(0.0, 0.060));
    const double held = quality.quality();
    // A cliff just above: the quality that held is what it comes back to.
    const auto cliff = [&](const DrawQuality& at) { return at.quality() > held ? 0.050 : 0.010; };
    for (int i = 0; i < 2000; ++i) {
        quality.frameDone(cliff(quality));
        ASSERT_GE(quality.quality(), held);
    }
}

/// The last of `frames`, in fractions of them, that were drawn at the highest quality.
double shareAtHighest(DrawQuality& quality, int frames,
                      const std::function<double(const DrawQuality&)>& cost) {
    int highest = 0;
    for (int i = 0; i < frames; ++i) {
        quality.frameDone(cost(quality));
        highest += quality.quality() == 1.0;
    }
    return static_cast<double>(highest) / frames;
}

DrawQuality::Limits ofKeptPictures() {
    return {.smallestScale = 0.55, .finestError = 0.5};
}

TEST(DrawQuality, AFallThatBuysNothingIsTakenBack) {
    // Panels alone take longer than a frame may: 36 ms at the whole resolution, 33.4 ms at a third of it.
    DrawQuality quality(ofKeptPictures());
    const auto cost = fill(0.032, 0.004);
    changesWhileDrawing(quality, 120, cost);
    EXPECT_EQ(quality.quality(), 1.0) << "within four seconds";
    EXPECT_GT(shareAtHighest(quality, 20'000, cost), 0.9);
    EXPECT_LE(changesWhileDrawing(quality, 20'000, cost), 30);
}

/// 1 s at the whole resolution, 0.31 s at the smallest: a trial takes three frames, not sixteen.
TEST(DrawQuality, ATrialDoesNotHangTheWindowOfASlowMachine) {
    DrawQuality quality(ofKeptPictures());
    const auto cost = fill(0.01, 1.0);
    changesWhileDrawing(quality, 60, cost);
    double seconds = 0.0, atHighest = 0.0, stretch = 0.0, longest = 0.0;
    while (seconds < 120.0) {
        const double busy = cost(quality);
        const bool highest = quality.quality() == 1.0;
        seconds += busy;
        atHighest += highest ? busy : 0.0;
        stretch = highest ? stretch + busy : 0.0;
        longest = std::max(longest, stretch);
        quality.frameDone(busy);
    }
    EXPECT_LT(longest, 3.5) << "s";
    EXPECT_LT(atHighest, 20.0) << "s of two minutes";
}

TEST(DrawQuality, AFallThatHelpsIsKeptThoughFramesStayLate) {
    // 92 ms at the whole resolution, 54 ms at the smallest.
    DrawQuality quality(ofKeptPictures());
    const auto cost = fill(0.037, 0.055);
    changesWhileDrawing(quality, 60, cost);
    EXPECT_LT(shareAtHighest(quality, 20'000, cost), 0.02) << "trials alone";
}

TEST(DrawQuality, WhatAShortLoadTookComesBackThoughMostOfTheTimeIsFixed) {
    // A shader that compiles, then 24 ms of panels and 2 ms of pixels: the whole resolution holds the budget.
    DrawQuality quality(ofKeptPictures());
    changesWhileDrawing(quality, 20, [](const DrawQuality&) { return 0.2; });
    ASSERT_EQ(quality.quality(), 0.0);
    changesWhileDrawing(quality, 1500, fill(0.024, 0.002));
    EXPECT_EQ(quality.quality(), 1.0);
}

TEST(DrawQuality, AToleratedResolutionFallsAtOnceWhenTheLoadGrows) {
    DrawQuality quality(ofKeptPictures());
    changesWhileDrawing(quality, 200, fill(0.032, 0.004));
    ASSERT_EQ(quality.quality(), 1.0);
    changesWhileDrawing(quality, 40, fill(0.010, 0.060)); // another model
    EXPECT_LT(quality.quality(), 0.5);
    changesWhileDrawing(quality, 200, fill(0.010, 0.060));
    EXPECT_LT(fill(0.010, 0.060)(quality), kBudget);
}

TEST(DrawQuality, PanelsInEveryThirdFrameAreNoReasonToSwing) {
    DrawQuality quality({.finestError = 0.25});
    int frame = 0;
    EXPECT_EQ(
        changesWhileDrawing(quality, 900, [&](const DrawQuality&) { return ++frame % 3 ? 0.022 : 0.032; }),
        0);
}

TEST(DrawQuality, OneHiccupDoesNotBlurThePicture) {
    DrawQuality quality({});
    changesWhileDrawing(quality, 100, fill(0.001, 0.010));
    quality.frameDone(0.05);
    EXPECT_EQ(quality.quality(), 1.0);
}

TEST(DrawQuality, LargestPixelsHoldAndAspectIsKept) {
    DrawQuality quality({.largestPixels = 800 * 450});
    const glm::ivec2 size = quality.sceneSize({1920, 1080});
    EXPECT_EQ(size, glm::ivec2(800, 448));
    EXPECT_EQ(quality.sceneSize({0, 0}), glm::ivec2(16, 16));
}

TEST(DrawQuality, IgnoresWhatIsNotATime) {
    DrawQuality quality({});
    for (int i = 0; i < 100; ++i)
        quality.frameDone(std::nan(""));
    EXPECT_EQ(quality.quality(), 1.0);
}

} // namespace
} // namespace touchstone
