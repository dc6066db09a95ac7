#include "devices/stroke/stroke_path.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace touchstone {

namespace {

bool finite(const glm::dvec3& p) {
    return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

/// Position of `time` between knots: the knot's index and the fraction past it, 0..1.
struct Place {
    size_t knot;
    double fraction;
};

Place placeOf(double time, size_t knots, double interval) noexcept {
    const double count = static_cast<double>(knots);
    const double turns = time / (interval * count);
    double at = (turns - std::floor(turns)) * count;
    if (!(at >= 0.0 && at < count))
        at = 0.0; // non-finite time, or rounding reached the end
    const double knot = std::floor(at);
    return {static_cast<size_t>(knot), at - knot};
}

} // namespace

StrokePath StrokePath::around(std::span<const glm::dvec3> waypoints, double speed) {
    const auto refuse = [](const char* problem) {
        throw Error("stroke path", "", problem, "give finite waypoints and a speed above 0");
    };
    if (waypoints.empty())
        refuse("there is no waypoint");
    if (!(speed > 0.0) || !std::isfinite(speed))
        refuse("the speed is not a positive number");
    for (const glm::dvec3& p : waypoints)
        if (!finite(p))
            refuse("a waypoint is not a finite point");

    double length = 0.0;
    const size_t count = waypoints.size();
    for (size_t i = 0; i < count; ++i)
        length += glm::distance(waypoints[i], waypoints[(i + 1) % count]);
    // Control points at equal steps along the polygon: their chords are at most a step long, and so is the
    // spline's travel per interval.
    const double steps = std::max(4.0, std::ceil(length / (speed * kKnotInterval)));
    if (!(steps * kKnotInterval <= kLongest)) {
        char problem[160];
        std::snprintf(problem, sizeof problem,
                      "the way round is %.3g m long and takes over %.0f hours at %g m/s", length,
                      kLongest / 3600.0, speed);
        throw Error("stroke path", "", problem,
                    "fit the model to the workspace (--fit workspace), or choose a higher speed");
    }
    const double step = length / steps;
    std::vector<glm::dvec3> control;
    control.reserve(static_cast<size_t>(steps));
    size_t edge = 0;
    double edgeStart = 0.0, edgeLength = glm::distance(waypoints[0], waypoints[1 % count]);
    for (double k = 0.0; k < steps; k += 1.0) {
        const double at = k * step;
        while (at > edgeStart + edgeLength && edge + 1 < count) {
            edgeStart += edgeLength;
            ++edge;
            edgeLength = glm::distance(waypoints[edge], waypoints[(edge + 1) % count]);
        }
        const double fraction = edgeLength > 0.0 ? std::clamp((at - edgeStart) / edgeLength, 0.0, 1.0) : 0.0;
        control.push_back(glm::mix(waypoints[edge], waypoints[(edge + 1) % count], fraction));
    }
    return StrokePath(std::move(control), kKnotInterval, waypoints[0]);
}

StrokePath StrokePath::through(std::vector<glm::dvec3> control, double interval, const glm::dvec3& place) {
    if (control.empty() || !std::ranges::all_of(control, finite))
        throw Error("stroke path", "", "a control point is missing or not finite", "give finite points");
    if (!(interval > 0.0) || !std::isfinite(interval))
        throw Error("stroke path", "", "the interval is not a positive number", "give one above 0 s");
    return StrokePath(std::move(control), interval, place);
}

StrokePath StrokePath::moved(const std::function<glm::dvec3(double, const glm::dvec3&)>& place) const {
    StrokePath path = *this;
    // A uniform cubic spline is nearest to its second control point where it starts.
    for (size_t k = 0; k < control_.size(); ++k)
        path.control_[k] =
            place((static_cast<double>(k) - 1.0) / static_cast<double>(control_.size()), control_[k]);
    return path;
}

glm::dvec3 StrokePath::position(double time) const noexcept {
    const auto [knot, t] = placeOf(time, control_.size(), interval_);
    const double s = 1.0 - t;
    return (s * s * s * control(knot, 0) + (3.0 * t * t * (t - 2.0) + 4.0) * control(knot, 1) +
            (3.0 * s * s * (s - 2.0) + 4.0) * control(knot, 2) + t * t * t * control(knot, 3)) /
           6.0;
}

glm::dvec3 StrokePath::velocity(double time) const noexcept {
    const auto [knot, t] = placeOf(time, control_.size(), interval_);
    const double s = 1.0 - t;
    const double before = 0.5 * s * s, after = 0.5 * t * t;
    return (before * (control(knot, 1) - control(knot, 0)) +
            (1.0 - before - after) * (control(knot, 2) - control(knot, 1)) +
            after * (control(knot, 3) - control(knot, 2))) /
           interval_;
}

} // namespace touchstone
