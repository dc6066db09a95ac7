#include "devices/stroke/press_place.h"

#include "devices/surface/surface_probe.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace touchstone {

namespace {

constexpr size_t kLargest = 12;
constexpr double kFacing = 0.5; ///< of the half diagonal: weight of facing the direction

/// A triangle by its centroid; the normal is that of its winding.
struct Candidate {
    double score = -std::numeric_limits<double>::infinity();
    glm::dvec3 middle{0.0}, normal{0.0};
    int front = 0;
};

std::array<glm::dvec3, 14> directionsFrom(const glm::dvec3& front) {
    std::array<glm::dvec3, 14> all{front,      {0, 1, 0},  {0, 0, 1}, {1, 0, 0},
                                   {-1, 0, 0}, {0, 0, -1}, {0, -1, 0}};
    const double c = 1.0 / std::sqrt(3.0);
    for (size_t i = 0; i < 7; ++i) // seven of the eight corners: the last is the front
        all[7 + i] = {i & 1 ? c : -c, i & 2 ? c : -c, i & 4 ? c : -c};
    return all;
}

/// Adds its tangible sides, the one that faces `towards` first.
void addSides(std::vector<PressPlace>& places, const Candidate& candidate, const glm::dvec3& towards) {
    const double facing = glm::dot(candidate.normal, towards) < 0.0 ? -1.0 : 1.0;
    for (const double side : {facing, -facing})
        if (candidate.front == 0 || candidate.front * side > 0.0)
            places.push_back({candidate.middle, side * candidate.normal});
}

} // namespace

std::vector<PressPlace> pressPlaces(const TriangleSource& triangles, const Bounds& bounds,
                                    const glm::dvec3& front) {
    const std::array<glm::dvec3, 14> directions = directionsFrom(front);
    const double half = 0.5 * bounds.diagonal();
    std::array<Candidate, 14> outermost;
    std::vector<Candidate> largest; // min-heap
    const auto larger = [](const Candidate& a, const Candidate& b) { return a.score > b.score; };
    triangles([&](const SurfaceTriangle& t) {
        const glm::dvec3 cross = glm::cross(t.b - t.a, t.c - t.a);
        const double area = glm::length(cross);
        if (!(area > 0.0))
            return;
        Candidate candidate{area, (t.a + t.b + t.c) / 3.0, cross / area, t.front};
        if (largest.size() < kLargest || area > largest.front().score) {
            if (largest.size() == kLargest) {
                std::ranges::pop_heap(largest, larger);
                largest.pop_back();
            }
            largest.push_back(candidate);
            std::ranges::push_heap(largest, larger);
        }
        for (size_t i = 0; i < directions.size(); ++i) {
            const double facing = glm::dot(candidate.normal, directions[i]);
            const double felt = candidate.front == 0 ? std::abs(facing) : candidate.front * facing;
            candidate.score =
                glm::dot(candidate.middle - bounds.centre(), directions[i]) + kFacing * half * felt;
            if (candidate.score > outermost[i].score)
                outermost[i] = candidate;
        }
    });
    std::vector<PressPlace> places;
    if (largest.empty())
        return places;
    for (size_t i = 0; i < directions.size(); ++i)
        addSides(places, outermost[i], directions[i]);
    std::ranges::sort(largest, larger);
    for (const Candidate& candidate : largest)
        addSides(places, candidate, front);
    return places;
}

std::optional<PressPlace>
firstPress(const TriangleSource& triangles, std::span<const PressPlace> places, double hover, double depth,
           const std::function<bool(const PressPlace&, const TriangleSource& near)>& holds) {
    constexpr std::array kHovers{1.0, 0.3, 0.08};
    constexpr std::array kDepths{1.0, 0.5, 0.2, 0.05};
    std::vector<std::vector<SurfaceTriangle>> near(places.size());
    for (const double shallower : kDepths)
        for (size_t i = 0; i < places.size(); ++i) {
            PressPlace place = places[i];
            place.depth = shallower * depth;
            if (near[i].empty())
                near[i] = trianglesNear(triangles, place.point, hover + 4.0 * depth);
            for (const double lower : kHovers) {
                place.hover = std::max(lower * hover, 2.0 * place.depth);
                if (holds(place, trianglesOf(near[i])))
                    return place;
            }
        }
    return std::nullopt;
}

bool isSupported(const TriangleSource& near, const PressPlace& place) {
    constexpr double kBeside = 0.02; // of the depth
    Bounds point;
    point.include(place.point);
    const ProbeView view = viewOf(point, place.normal);
    const double beside = kBeside * place.depth;
    const std::array<glm::dvec2, 4> around{glm::dvec2(beside, 0.0), glm::dvec2(-beside, 0.0),
                                           glm::dvec2(0.0, beside), glm::dvec2(0.0, -beside)};
    return std::ranges::all_of(probe(near, view, around, place.depth), [&](const auto& hit) {
        return hit && view.viewed(hit->point).z > -place.depth;
    });
}

Error noPlaceToPress(const TriangleSource& triangles) {
    bool any = false;
    triangles(
        [&](const SurfaceTriangle& t) { any = any || glm::length(glm::cross(t.b - t.a, t.c - t.a)) > 0.0; });
    if (!any)
        return Error("simulated hand", "", "the model has no surface that could be touched",
                     "open a model with triangles that are not all of zero area");
    return Error("simulated hand", "",
                 "no place was found at which it can press the model without going deeper",
                 "touch it along a path of your own (touch --path), or press less deep (--stroke-depth)");
}

} // namespace touchstone
