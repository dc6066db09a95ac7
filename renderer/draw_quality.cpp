#include "renderer/draw_quality.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {
constexpr int kFirstRiseWait = 30;    ///< frames at constant quality before a rise: one second at 30 Hz
constexpr int kLongestRiseWait = 960; ///< frames; half a minute
constexpr int kSettling = 4;          ///< frames after a change whose times still reflect the old quality
constexpr double kRise = 0.15;        ///< increment of the quality
constexpr double kMinFall = 0.05;
} // namespace

void DrawQuality::frameDone(double busy) {
    if (!(busy >= 0.0))
        return;
    ++framesAtQuality_;
    if (framesAtQuality_ <= kSettling) {
        smoothed_ = busy;
        return;
    }
    smoothed_ += 0.2 * (busy - smoothed_);
    const double allowed = limits_.headroom * limits_.budget;
    if (smoothed_ > allowed && quality_ > 0.0)
        fall(smoothed_ / allowed);
    else if (quality_ < 1.0 && framesAtQuality_ >= framesToWait_)
        rise(allowed);
}

void DrawQuality::fall(double excess) {
    if (lastChangeWasRise_) {
        framesToWait_ = std::min(2 * framesToWait_, kLongestRiseWait);
        quality_ = beforeRise_;
    } else {
        // Assumes that all cost is proportional to the area, which overcorrects, since simpler meshes help,
        // too. Limited to a third of the size at once, since a single late frame is not a trend.
        const double wanted = scale() * std::max(std::sqrt(1.0 / excess), 0.67);
        const double range = 1.0 - limits_.smallestScale;
        const double least = quality_ - kMinFall;
        quality_ =
            std::max(0.0, range > 0.0 ? std::min((wanted - limits_.smallestScale) / range, least) : least);
    }
    framesAtQuality_ = 0;
    lastChangeWasRise_ = false;
}

void DrawQuality::rise(double allowed) {
    const double next = std::min(1.0, quality_ + kRise);
    const double growth = scaleAt(next) / scale();
    if (smoothed_ * growth * growth > 0.9 * allowed)
        return;
    if (lastChangeWasRise_)
        framesToWait_ = kFirstRiseWait; // the last rise was successful
    beforeRise_ = quality_;
    quality_ = next;
    framesAtQuality_ = 0;
    lastChangeWasRise_ = true;
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
