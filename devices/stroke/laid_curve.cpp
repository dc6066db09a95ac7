#include "devices/stroke/laid_curve.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr double kStep = 0.2; ///< of the spacing: tolerance of neighbours' heights to their planes
constexpr double kLegSpacing = 2.5e-4, kFewestOfLeg = 16.0; ///< m between points beside an edge; points

/// The mean of the values within `reach` m along the curve, applied twice: a tent filter, whose slope does
/// not jump.
std::vector<glm::dvec3> tentMeans(std::vector<glm::dvec3> values, std::span<const double> ways,
                                  double reach) {
    std::vector<glm::dvec3> sums(values.size() + 1);
    for (int turn = 0; turn < 2; ++turn) {
        sums[0] = glm::dvec3(0.0);
        for (size_t i = 0; i < values.size(); ++i)
            sums[i + 1] = sums[i] + values[i];
        size_t low = 0, high = 0;
        for (size_t i = 0; i < values.size(); ++i) {
            while (ways[low] < ways[i] - reach)
                ++low;
            while (high < ways.size() && ways[high] <= ways[i] + reach)
                ++high;
            values[i] = (sums[high] - sums[low]) / static_cast<double>(high - low);
        }
    }
    return values;
}

/// The same for a closed curve: three rounds, of which the middle one has neighbours.
std::vector<glm::dvec3> tentMeansRound(const std::vector<glm::dvec3>& values, std::span<const double> ways,
                                       double reach) {
    std::vector<glm::dvec3> rounds;
    std::vector<double> roundWays;
    for (int round = 0; round < 3; ++round)
        for (size_t i = round == 0 ? 0 : 1; i < values.size(); ++i) { // the last repeats the first
            rounds.push_back(values[i]);
            roundWays.push_back(ways[i] + round * ways.back());
        }
    const std::vector<glm::dvec3> all = tentMeans(std::move(rounds), roundWays, reach);
    const auto middle = all.begin() + static_cast<std::ptrdiff_t>(values.size()) - 1;
    return {middle, middle + static_cast<std::ptrdiff_t>(values.size())};
}

std::vector<glm::dvec3> smoothedNormals(const std::vector<glm::dvec3>& normals, std::span<const double> ways,
                                        double reach, bool closed) {
    std::vector<glm::dvec3> means =
        closed ? tentMeansRound(normals, ways, reach) : tentMeans(normals, ways, reach);
    for (size_t i = 0; i < means.size(); ++i) {
        const double length = glm::length(means[i]);
        // Normals cancel at a fold: there the surface's own normal is used.
        means[i] = length > 0.0 ? means[i] / length : normals[i];
    }
    return means;
}

std::vector<double> lengthsAlong(std::span<const glm::dvec3> points) {
    std::vector<double> lengths(points.size(), 0.0);
    for (size_t i = 1; i < points.size(); ++i)
        lengths[i] = lengths[i - 1] + glm::distance(points[i - 1], points[i]);
    return lengths;
}

} // namespace

LaidCurve::LaidCurve(const glm::dvec3& point, const glm::dvec3& normal, double depth)
    : pressed_{point - depth * normal}, normals_{normal}, lengths_{0.0} {}

std::optional<LaidCurve> LaidCurve::over(const TriangleSource& triangles, const ProbeView& view,
                                         std::span<const glm::dvec2> points, double depth, double soft,
                                         double ceiling) {
    const std::vector<std::optional<SurfaceHit>> hits = probe(triangles, view, points, ceiling);
    double spacing = 0.0;
    for (size_t i = 1; i < points.size(); ++i)
        spacing = std::max(spacing, glm::distance(points[i - 1], points[i]));
    for (size_t i = 0; i < hits.size(); ++i)
        if (!hits[i] || (i > 0 && breaksOff(view, *hits[i - 1], *hits[i], kStep * spacing)))
            return std::nullopt;
    // Checked after the gaps, since it costs more.
    const std::vector<double> walls = wallsBeside(triangles, view, points, hits, depth + spacing);
    if (std::ranges::any_of(walls, [](double height) { return std::isfinite(height); }))
        return std::nullopt;

    std::vector<glm::dvec3> surface;
    LaidCurve curve;
    for (const auto& hit : hits) {
        surface.push_back(hit->point);
        curve.normals_.push_back(hit->normal);
    }
    curve.closed_ = points.front() == points.back();
    curve.normals_ = smoothedNormals(curve.normals_, lengthsAlong(surface), soft + spacing, curve.closed_);
    for (size_t i = 0; i < surface.size(); ++i)
        curve.pressed_.push_back(surface[i] - depth * curve.normals_[i]);
    curve.lengths_ = lengthsAlong(curve.pressed_);
    return curve;
}

std::optional<LaidCurve> LaidCurve::acrossEdge(const TriangleSource& triangles, const EdgeSite& site,
                                               double reach, double depth) {
    // Past the edge, and the same distance behind the landing on the other side: clear of a steep edge.
    const double past = std::min(2.0 * depth, 0.3 * reach);
    const auto legPoints = static_cast<size_t>(std::max(kFewestOfLeg, std::ceil(reach / kLegSpacing)));
    std::vector<glm::dvec2> line;
    for (size_t i = 1; i <= legPoints; ++i) // not on the edge itself, which belongs to both sides
        line.emplace_back(reach * static_cast<double>(i) / static_cast<double>(legPoints), 0.0);
    std::array<std::optional<LaidCurve>, 2> legs;
    for (size_t side = 0; side < 2; ++side) {
        ProbeView view;
        view.centre = site.point;
        view.towards = site.normal[side];
        view.right = site.inward[side];
        view.up = glm::cross(view.towards, view.right);
        legs[side] = over(triangles, view, line, depth, depth, reach);
        if (!legs[side])
            return std::nullopt;
    }
    // Out along one leg, past the edge, and in along the other from the landing; then the same from there.
    LaidCurve loop;
    const auto landing = static_cast<size_t>(std::ceil(past / reach * static_cast<double>(legPoints)));
    for (size_t side = 0; side < 2; ++side) {
        const LaidCurve &from = *legs[side], &to = *legs[1 - side];
        for (size_t i = legPoints; i-- > 0;) {
            loop.pressed_.push_back(from.pressed_[i]);
            loop.normals_.push_back(from.normals_[i]);
        }
        loop.pressed_.push_back(site.point - depth * site.normal[side] - past * site.inward[side]);
        loop.normals_.push_back(site.normal[side]);
        for (size_t i = landing; i + 1 < legPoints; ++i) { // the farthest point is the first of the way back
            loop.pressed_.push_back(to.pressed_[i]);
            loop.normals_.push_back(to.normals_[i]);
        }
    }
    loop.pressed_.push_back(loop.pressed_.front());
    loop.normals_.push_back(loop.normals_.front());
    loop.closed_ = true;
    const std::vector<double> ways = lengthsAlong(loop.pressed_);
    loop.normals_ = smoothedNormals(loop.normals_, ways, depth, true);
    loop.pressed_ = tentMeansRound(loop.pressed_, ways, 0.5 * past);
    loop.lengths_ = lengthsAlong(loop.pressed_);
    return loop;
}

glm::dvec3 LaidCurve::at(double way, double lift) const {
    if (closed_ && way >= length())
        way = std::fmod(way, length());
    const auto after = std::ranges::upper_bound(lengths_, way);
    if (after == lengths_.begin())
        return pressed_.front() + lift * normals_.front();
    if (after == lengths_.end())
        return pressed_.back() + lift * normals_.back();
    const auto i = static_cast<size_t>(after - lengths_.begin());
    const double t = (way - lengths_[i - 1]) / (lengths_[i] - lengths_[i - 1]);
    return glm::mix(pressed_[i - 1], pressed_[i], t) + lift * glm::mix(normals_[i - 1], normals_[i], t);
}

} // namespace touchstone
