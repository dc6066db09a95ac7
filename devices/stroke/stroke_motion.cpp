#include "devices/stroke/stroke_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone {

namespace {

constexpr double kPeakOverMean = 15.0 / 8.0; ///< of the minimum-jerk profile
constexpr double kComing = 0.1;              ///< s in which a run reaches its speed

double minimumJerk(double t) {
    return t * t * t * (10.0 + t * (6.0 * t - 15.0));
}

/// Distance covered by a run of unit speed, `seconds` long, that accelerates and decelerates by smoothstep in
/// `coming` s: the integral of the speed.
double runWay(double time, double seconds, double coming) {
    const auto come = [&](double t) {
        const double u = std::clamp(t / coming, 0.0, 1.0);
        return coming * u * u * u * (1.0 - 0.5 * u);
    };
    if (time < coming)
        return come(time);
    const double going = seconds - coming;
    if (time < going)
        return 0.5 * coming + (time - coming);
    return (seconds - coming) - come(seconds - time);
}

} // namespace

StrokeMotion::StrokeMotion(const LaidCurve& curve, double hover) : curve_(curve), lift_(hover) {
    add(way_, lift_);
}

template <class Place>
void StrokeMotion::over(double seconds, const Place& place) {
    const auto steps = static_cast<int>(std::max(1.0, std::ceil(seconds / kInterval)));
    for (int i = 1; i <= steps; ++i)
        place(static_cast<double>(i) / steps);
}

void StrokeMotion::liftTo(double lift, double speed) {
    over(kPeakOverMean * std::abs(lift - lift_) / speed,
         [&](double t) { add(way_, lift_ + (lift - lift_) * minimumJerk(t)); });
    lift_ = lift;
}

void StrokeMotion::reachTo(double way, double speed) {
    over(kPeakOverMean * std::abs(way - way_) / speed,
         [&](double t) { add(way_ + (way - way_) * minimumJerk(t), lift_); });
    way_ = way;
}

void StrokeMotion::runTo(double way, double speed) {
    const double seconds = std::abs(way - way_) / speed + kComing;
    if (seconds < 2.0 * kComing)
        return reachTo(way, speed);
    const double all = seconds - kComing;
    over(seconds,
         [&](double t) { add(way_ + (way - way_) * runWay(t * seconds, seconds, kComing) / all, lift_); });
    way_ = way;
}

void StrokeMotion::rest(double seconds) {
    over(seconds, [&](double) { add(way_, lift_); });
}

void StrokeMotion::tremble(double seconds, double amplitude) {
    const glm::dvec3 place = curve_.at(way_, lift_);
    // Three frequencies that do not beat within the hold, each in its own direction.
    over(seconds, [&](double t) {
        constexpr double kSwell = 0.2; // fraction of the time
        const double swell = minimumJerk(std::clamp(std::min(t, 1.0 - t) / kSwell, 0.0, 1.0));
        const auto wave = [&](double hertz, double phase) {
            return std::sin(2.0 * std::numbers::pi * hertz * t * seconds + phase);
        };
        control_.push_back(place +
                           swell * amplitude * glm::dvec3(wave(8.3, 0.0), wave(9.7, 1.9), wave(11.6, 4.1)));
    });
}

StrokePath StrokeMotion::finish(const glm::dvec3& place) const {
    return StrokePath::through(control_, kInterval, place);
}

} // namespace touchstone
