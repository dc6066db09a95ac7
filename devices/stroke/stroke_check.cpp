#include "devices/stroke/stroke_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace touchstone {

namespace {

constexpr double kGapOfDepth = 1e-4;
constexpr double kMargin = 0.98;   ///< of the limit: margin for samples and gaps
constexpr double kFine = 0.1;      ///< of the depth: a step in contact
constexpr double kFinest = 0.025;  ///< of the depth: a step near the limit
constexpr double kNearLimit = 0.8; ///< of the limit
constexpr double kAir = 5e-4;      ///< m: a step in the air
constexpr double kLongest = 5e-3;  ///< s: a step of an almost stationary hand

/// Crossings of the half lines from a point with one object.
struct Crossings {
    std::array<uint32_t, 3> count{};
};

/// Where the line from `point` meets the triangle, in lengths of `direction`; NaN: nowhere.
double wayTo(const SurfaceTriangle& t, const glm::dvec3& point, const glm::dvec3& direction) {
    const glm::dvec3 ab = t.b - t.a, ac = t.c - t.a, across = glm::cross(direction, ac);
    const double volume = glm::dot(ab, across);
    if (volume == 0.0)
        return NAN;
    const glm::dvec3 from = point - t.a;
    const double u = glm::dot(from, across) / volume;
    const glm::dvec3 turned = glm::cross(from, ab);
    const double v = glm::dot(direction, turned) / volume;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 ? glm::dot(ac, turned) / volume : NAN;
}

} // namespace

NearTriangles trianglesAlong(const TriangleSource& triangles, const StrokePath& path, double depth) {
    // The proxy is within the limit of the hand, and the hand within a step of a sample.
    const double reach = (kDepthFactor + 0.5) * depth + 2.0 * kAir;
    std::vector<glm::dvec3> points;
    double time = 0.0;
    while (time < path.period()) {
        points.push_back(path.position(time));
        const double speed = glm::length(path.velocity(time));
        time += std::clamp(kAir / std::max(speed, 1e-9), 1e-5, kLongest);
    }
    return NearTriangles(triangles, points, reach);
}

StrokeWalk::StrokeWalk(const NearTriangles& triangles, const StrokePath& path, double depth,
                       std::span<const Bounds> keepOut)
    : path_(path), keepOut_(keepOut), depth_(depth),
      proxy_(triangles, path.position(0.0), kGapOfDepth * depth), step_(kAir) {}

void StrokeWalk::resume(double time, const glm::dvec3& place) {
    time_ = time;
    step_ = kFine * depth_;
    proxy_.put(place);
    proxy_.follow(path_.position(time));
    below_ = glm::distance(proxy_.place(), path_.position(time));
}

void StrokeWalk::step() {
    const double speed = std::max(glm::length(path_.velocity(time_)), 1e-9);
    const bool nearLimit = below_ > kNearLimit * kDepthFactor * depth_;
    const double fine = (nearLimit ? kFinest : kFine) * depth_;
    if (proxy_.touches())
        step_ = fine;
    for (const SurfaceProxy before = proxy_;; proxy_ = before) {
        const double time = time_ + std::min(step_ / speed, kLongest);
        const glm::dvec3 hip = path_.position(time);
        proxy_.follow(hip);
        if (proxy_.touches() && step_ > fine) {
            step_ = std::max(step_ / 8.0, fine); // shorter steps on the way onto the surface
            continue;
        }
        time_ = time;
        below_ = glm::distance(proxy_.place(), hip);
        deepest_ = std::max(deepest_, below_);
        break;
    }
    if (!proxy_.touches())
        step_ = std::min(2.0 * step_, std::max(kAir, fine));
}

std::optional<double> StrokeWalk::nextFault() {
    while (time_ < path_.period()) {
        step();
        if (below_ > kMargin * kDepthFactor * depth_ ||
            isInAny(keepOut_, path_.position(time_), kDepthFactor * depth_))
            return time_;
    }
    return std::nullopt;
}

bool isInAny(std::span<const Bounds> boxes, const glm::dvec3& p, double margin) {
    return std::ranges::any_of(boxes, [&](const Bounds& box) {
        return glm::all(glm::greaterThanEqual(p, box.low - margin)) &&
               glm::all(glm::lessThanEqual(p, box.high + margin));
    });
}

bool strokeHolds(const TriangleSource& triangles, const StrokePath& path, double depth,
                 std::span<const Bounds> keepOut) {
    const NearTriangles near = trianglesAlong(triangles, path, depth);
    StrokeWalk walk(near, path, depth, keepOut);
    return !walk.nextFault() && walk.pressed();
}

bool isFree(const NearTriangles& triangles, const glm::dvec3& from, const glm::dvec3& to) {
    bool free = true;
    triangles.along(from, to, [&](const SurfaceTriangle& t) {
        const double way = wayTo(t, from, to - from);
        free = free && !(way > 0.0 && way < 1.0);
    });
    return free;
}

bool maybeInside(const TriangleSource& triangles, const glm::dvec3& point, const glm::dvec3& out) {
    // Oblique directions, so that no ray runs along the axis-aligned faces and edges that models often have.
    const std::array<glm::dvec3, 3> ways{out + glm::dvec3(1.1e-3, 2.3e-3, -1.7e-3),
                                         glm::dvec3(0.5414, 0.8311, 0.1271),
                                         glm::dvec3(-0.7132, 0.2243, -0.6641)};
    std::vector<Crossings> objects;
    std::array<bool, 3> free{true, true, true};
    triangles([&](const SurfaceTriangle& t) {
        for (size_t i = 0; i < ways.size(); ++i)
            if (wayTo(t, point, ways[i]) > 0.0) {
                if (objects.size() <= t.object)
                    objects.resize(t.object + 1);
                ++objects[t.object].count[i];
                free[i] = false;
            }
    });
    if (std::ranges::any_of(free, [](bool is) { return is; }))
        return false;
    return std::ranges::any_of(objects, [](const Crossings& crossings) {
        return std::ranges::count_if(crossings.count, [](uint32_t n) { return n % 2 == 1; }) >= 2;
    });
}

} // namespace touchstone
