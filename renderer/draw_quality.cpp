#include "renderer/draw_quality.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {
constexpr int kLongestWait = 960;       ///< frames; half a minute
constexpr int kLongestTolerance = 7680; ///< frames; four minutes
constexpr int kSettling = 4;            ///< frames after a change whose times still reflect the old quality
constexpr int kJudged = kSettling + 12; ///< frames after which the smoothed time is that of the new quality
constexpr double kRise = 0.15;          ///< increment of the quality
constexpr double kMinFall = 0.05;
constexpr int kDoubtful = 4;           ///< times the wait, before a rise that is predicted to fail
constexpr double kWorthFalling = 0.2;  ///< fraction of the time that the lowest quality must save
constexpr double kPlainlySlower = 2.0; ///< times the lowest quality's time
constexpr int kPlain = 2;              ///< such frames in a row
constexpr double kMuchWorse = 1.25;    ///< times the tolerated time: the load has changed
} // namespace

void DrawQuality::setQuality(double quality) {
    quality_ = quality;
    framesAtQuality_ = 0;
}

void DrawQuality::frameDone(double busy) {
    if (!(busy >= 0.0))
        return;
    ++framesAtQuality_;
    // A trial that hangs the window for seconds is over as soon as it is plain.
    framesTooSlow_ = tryingHighest_ && framesAtQuality_ > 1 && busy > kPlainlySlower * timeAtLowest_
                         ? framesTooSlow_ + 1
                         : 0;
    if (framesTooSlow_ >= kPlain) {
        smoothed_ = busy;
        judgeHighest();
        return;
    }
    if (framesAtQuality_ <= kSettling) {
        smoothed_ = busy;
        return;
    }
    smoothed_ += 0.2 * (busy - smoothed_);
    const double allowed = limits_.headroom * limits_.budget;
    if (tryingHighest_) {
        if (framesAtQuality_ >= kJudged)
            judgeHighest();
    } else if (smoothed_ > allowed) {
        if (quality_ == 0.0 && framesAtQuality_ >= framesToTrial_)
            tryHighest();
        else if (quality_ > 0.0 && !toleratesLateFrames())
            fall(smoothed_ / allowed);
    } else if (quality_ < 1.0 && framesAtQuality_ >= framesToWait_) {
        rise(allowed);
    }
}

void DrawQuality::fall(double excess) {
    if (lastChangeWasRise_) {
        framesToWait_ = std::min(2 * framesToWait_, kLongestWait);
        setQuality(beforeRise_);
    } else {
        // Assumes that all cost is proportional to the area, which overcorrects, since simpler meshes help,
        // too, and part of the cost is fixed. Limited to a third of the size at once, since a single late
        // frame is not a trend.
        const double wanted = scale() * std::max(std::sqrt(1.0 / excess), 0.67);
        const double range = 1.0 - limits_.smallestScale;
        const double least = quality_ - kMinFall;
        setQuality(
            std::max(0.0, range > 0.0 ? std::min((wanted - limits_.smallestScale) / range, least) : least));
    }
    lastChangeWasRise_ = false;
}

void DrawQuality::rise(double allowed) {
    // Proportional to the area is the most that it can grow. With a fixed part it grows by less: 24 ms of
    // panels and 2 ms of pixels would never leave the lowest quality after a short load. So a rise that is
    // predicted to fail is tried all the same, but seldom.
    const double next = std::min(1.0, quality_ + kRise);
    const double growth = scaleAt(next) / scale();
    if (smoothed_ * growth * growth > 0.9 * allowed && framesAtQuality_ < kDoubtful * framesToWait_)
        return;
    if (lastChangeWasRise_)
        framesToWait_ = kFirstWait; // the last rise was successful
    framesToTrial_ = kFirstWait;
    beforeRise_ = quality_;
    setQuality(next);
    lastChangeWasRise_ = true;
}

/// Late frames at the lowest quality: what was given up may have bought nothing. The time before the falls
/// cannot tell, since a load that has passed meanwhile looks like a gain, so the highest quality is measured
/// now.
void DrawQuality::tryHighest() {
    tryingHighest_ = true;
    timeAtLowest_ = smoothed_;
    setQuality(1.0);
    lastChangeWasRise_ = false;
}

void DrawQuality::judgeHighest() {
    tryingHighest_ = false;
    if (timeAtLowest_ < (1.0 - kWorthFalling) * smoothed_) {
        framesToTrial_ = std::min(2 * framesToTrial_, kLongestWait);
        tolerated_ = 0.0;
        framesTolerated_ = kFirstTolerance;
        setQuality(0.0);
        return;
    }
    framesTolerated_ = tolerated_ > 0.0 ? std::min(2 * framesTolerated_, kLongestTolerance) : kFirstTolerance;
    tolerated_ = smoothed_;
    framesToTrial_ = kFirstWait;
}

bool DrawQuality::toleratesLateFrames() const {
    return quality_ == 1.0 && !lastChangeWasRise_ && framesAtQuality_ < framesTolerated_ &&
           smoothed_ <= kMuchWorse * tolerated_;
}

glm::ivec2 DrawQuality::sceneSize(const glm::ivec2& area) const {
    const glm::dvec2 wanted(std::max(area.x, 1), std::max(area.y, 1));
    const double fit = std::min(1.0, std::sqrt(limits_.largestPixels / (wanted.x * wanted.y)));
    const glm::dvec2 scaled = wanted * fit * scale();
    const auto toEight = [](double v) { return std::max(16, 8 * static_cast<int>(std::lround(v / 8.0))); };
    return {toEight(scaled.x), toEight(scaled.y)};
}

double DrawQuality::allowedError() const {
    const double lack = 1.0 - quality_;
    return limits_.finestError + (limits_.coarsestError - limits_.finestError) * lack * lack;
}

} // namespace touchstone
