#include "haptics/finger/tactile_shading.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {

/// The place whose sector holds the finger's contact with the tangent line of the place `from`.
double TactileShading::contactPlace(double from, const FingerPose& pose) const noexcept {
    return polyline_.project(from, finger_.touch(pose, polyline_.tangent(from)).point);
}

/// Illinois' false position: where one end stays twice, its error counts half.
double TactileShading::solvedPlace(double from, const FingerPose& pose) const noexcept {
    constexpr double kClose = 1e-13; // of a patch
    double low = from, high = contactPlace(from, pose);
    double lowError = high - low, highError = contactPlace(high, pose) - high;
    for (int i = 0; i < kMostHalvings && std::abs(highError) > kClose && lowError * highError < 0.0; ++i) {
        const double middle = high - highError * (high - low) / (highError - lowError);
        const double error = contactPlace(middle, pose) - middle;
        if (error * highError < 0.0) {
            low = high;
            lowError = highError;
        } else {
            lowError *= 0.5;
        }
        high = middle;
        highError = error;
    }
    return high;
}

/// The first condition of [004 §4.2.1]: a contact on an edge that is no neighbour, as where the finger
/// bridges a valley, deeper by a margin than into the present patch's own edges. Depths into edges do not
/// depend on the place on the curve, so a hand that rests cannot go to and fro between two of them.
void TactileShading::switchToDeeper(const FingerPose& pose) noexcept {
    constexpr double kMargin = 1e-6; // m
    if (polyline_.patches().empty())
        return;
    const auto index = static_cast<long>(polyline_.patchOf(felt_.place));
    const double own = polyline_.depthOf(index, finger_, pose);
    const Polyline::Deepest other = polyline_.deepest(finger_, pose, std::max(own, 0.0) + kMargin, index);
    if (other.found)
        felt_.place = polyline_.middleOf(other.edge);
}

TactileShading::Felt TactileShading::step(const FingerPose& pose) noexcept {
    if (!std::isfinite(pose.pad.x) || !std::isfinite(pose.pad.y) || !std::isfinite(pose.pitch))
        return felt_;
    if (!known_) {
        felt_.place = polyline_.middleOf(
            polyline_.deepest(finger_, pose, -std::numeric_limits<double>::infinity()).edge);
        known_ = true;
    } else {
        switchToDeeper(pose);
    }
    const double next =
        step_ == TangentStep::Solved ? solvedPlace(felt_.place, pose) : contactPlace(felt_.place, pose);
    felt_.place = next;
    known_ = std::isfinite(next);
    felt_.line = polyline_.tangent(next);
    felt_.contact = finger_.touch(pose, felt_.line);
    return felt_;
}

} // namespace touchstone
