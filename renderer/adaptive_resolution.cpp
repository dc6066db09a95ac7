#include "renderer/adaptive_resolution.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {
constexpr int kFirstRiseWait = 30;    ///< frames at one size before a rise: one second at 30 Hz
constexpr int kLongestRiseWait = 960; ///< frames; half a minute
constexpr int kSettling = 4;          ///< frames after a change whose time still belongs to the old size
} // namespace

void AdaptiveResolution::frameDone(double busy) {
    if (!(busy >= 0.0))
        return;
    ++framesAtScale_;
    if (framesAtScale_ <= kSettling) {
        smoothed_ = busy;
        return;
    }
    smoothed_ += 0.2 * (busy - smoothed_);
    const double allowed = limits_.headroom * limits_.budget;
    if (smoothed_ > allowed && scale_ > limits_.smallestScale) {
        if (lastChangeWasRise_)
            framesToWait_ = std::min(2 * framesToWait_, kLongestRiseWait);
        // Fill cost goes with the area; never more than a third at once, for a hiccup is not a load.
        const double wanted = scale_ * std::sqrt(allowed / smoothed_);
        scale_ = std::max({wanted, 0.67 * scale_, limits_.smallestScale});
        framesAtScale_ = 0;
        lastChangeWasRise_ = false;
        return;
    }
    if (scale_ >= 1.0 || framesAtScale_ < framesToWait_)
        return;
    const double next = std::min(1.0, 1.15 * scale_);
    if (smoothed_ * (next * next) / (scale_ * scale_) > 0.9 * allowed)
        return;
    if (lastChangeWasRise_)
        framesToWait_ = kFirstRiseWait; // the last rise held
    scale_ = next;
    framesAtScale_ = 0;
    lastChangeWasRise_ = true;
}

glm::ivec2 AdaptiveResolution::sceneSize(const glm::ivec2& area) const {
    const glm::dvec2 wanted(std::max(area.x, 1), std::max(area.y, 1));
    const double fit = std::min(1.0, std::sqrt(limits_.largestPixels / (wanted.x * wanted.y)));
    const glm::dvec2 scaled = wanted * fit * scale_;
    const auto toEight = [](double v) { return std::max(16, 8 * static_cast<int>(std::lround(v / 8.0))); };
    return {toEight(scaled.x), toEight(scaled.y)};
}

} // namespace touchstone
