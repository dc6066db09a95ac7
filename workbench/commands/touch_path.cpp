#include "workbench/commands/touch_path.h"

#include "haptics/servo/servo_loop.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace touchstone {

namespace {

/// Largest step from row to row, m, and largest change of velocity at a row, m/s.
struct RowJumps {
    double place = 0.0, velocity = 0.0;
};
RowJumps jumpsOf(const HipPath& path) {
    RowJumps jumps;
    glm::dvec3 before(0.0);
    for (size_t i = 1; i < path.times.size(); ++i) {
        const glm::dvec3 way = path.positions[i] - path.positions[i - 1];
        const glm::dvec3 velocity = way / (path.times[i] - path.times[i - 1]);
        jumps.place = std::max(jumps.place, glm::length(way));
        jumps.velocity = std::max(jumps.velocity, glm::distance(velocity, before));
        before = velocity;
    }
    return jumps;
}

} // namespace

HipPath pathOf(const StrokePath& stroke, const TouchOptions& options) {
    const double rate = options.rateHz > 0.0 ? options.rateHz : 1000.0;
    const double seconds = options.seconds > 0.0 ? options.seconds : stroke.period();
    HipPath path;
    const auto count = static_cast<size_t>(std::floor(seconds * rate * (1.0 + 1e-12))) + 1;
    for (size_t i = 0; i < count; ++i) {
        path.times.push_back(static_cast<double>(i) / rate);
        const double time = path.times.back();
        path.positions.push_back(stroke.positionIn(time, animationTime(options.settings, time)));
    }
    return path;
}

double rateOf(const HipPath& path) {
    std::vector<double> intervals;
    for (size_t i = 1; i < path.times.size(); ++i)
        intervals.push_back(path.times[i] - path.times[i - 1]);
    if (intervals.empty())
        return 0.0;
    const auto middle = intervals.begin() + static_cast<ptrdiff_t>(intervals.size() / 2);
    std::ranges::nth_element(intervals, middle);
    return 1.0 / *middle;
}

void warnOfSlowPath(const HipPath& path, const TouchOptions& options) {
    const double rate = rateOf(path);
    if (!(rate > 0.0) || rate >= kMinServoRate * (1.0 - 1e-9))
        return;
    const RowJumps jumps = jumpsOf(path);
    std::fprintf(stderr, "touchstone: warning: %s: has %.3g rows a second: ", options.path.c_str(), rate);
    if (options.rateHz > 0.0)
        std::fprintf(
            stderr,
            "between two rows the hand goes straight at one speed, and at each row its velocity jumps, by up "
            "to %.3g m/s\n",
            jumps.velocity);
    else
        std::fprintf(stderr,
                     "a tick lasts from row to row, %.3g ms, and the hand jumps, by up to %.3g mm at once\n",
                     1e3 / rate, 1e3 * jumps.place);
    std::fprintf(stderr, "  remedy: record the path at 1000 Hz, and at %.0f Hz at least%s\n", kMinServoRate,
                 options.rateHz > 0.0 ? "" : "; --rate 1000 puts ticks on straight lines between its rows");
}

std::vector<PlannedTick> plannedTicks(const HipPath& path, double rateHz) {
    std::vector<PlannedTick> ticks;
    if (rateHz <= 0.0) {
        ticks.resize(path.times.size());
        for (size_t i = 0; i < ticks.size(); ++i) {
            ticks[i].time = path.times[i];
            ticks[i].hip = path.positions[i];
            if (i > 0)
                ticks[i].dt = path.times[i] - path.times[i - 1];
        }
        ticks[0].dt = ticks.size() > 1 ? ticks[1].dt : 1e-3;
        return ticks;
    }
    ReplayDevice replay(path);
    const auto count = static_cast<size_t>(std::floor(replay.duration() * rateHz * (1.0 + 1e-12))) + 1;
    ticks.resize(count);
    for (size_t i = 0; i < count; ++i) {
        const double since = static_cast<double>(i) / rateHz;
        ticks[i].time = path.times.front() + since;
        ticks[i].dt = 1.0 / rateHz;
        ticks[i].hip = replay.sample(since).position;
    }
    return ticks;
}

} // namespace touchstone
