// The strokes of the simulated hand: choose the place, draw the curve, project it and move along it.

#include "devices/stroke/stroke_library.h"

#include "devices/stroke/press_place.h"
#include "devices/stroke/scene_motion.h"
#include "devices/stroke/stroke_check.h"
#include "devices/stroke/stroke_motion.h"
#include "devices/stroke/stroke_place.h"
#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace touchstone {

namespace {

using Curve = std::vector<glm::dvec2>; ///< m in the site's view

/// m over the surface, before and after; smaller where another part of the model is above.
constexpr std::array kHovers{0.008, 0.002, 0.0005};
constexpr double kLanding = 0.08;       ///< m/s at most, from there onto the surface and back, in the air
constexpr double kSpacing = 2.5e-4;     ///< m between the points that are laid
constexpr double kDeepestOfModel = 0.1; ///< of the model's diagonal: a small model is not pierced
constexpr double kReachOfModel = 0.25;  ///< of the diagonal: no curve reaches farther from its middle
constexpr double kSoftTime = 0.01;      ///< s over which a hand turns to another direction, at least
constexpr std::array kSizes{1.0, 0.7, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05}; ///< of its full size, tried in order
constexpr std::array kEdgeSizes{1.0, 0.5, 0.25, 0.15};
constexpr double kFewest = 16; ///< minimum number of points of a curve

/// `place(t)` for t from 0 to 1, about `length` m long.
template <class Place>
Curve drawn(double length, const Place& place) {
    const double count = std::max(kFewest, std::ceil(length / kSpacing));
    Curve curve;
    for (double i = 0.0; i <= count; i += 1.0)
        curve.push_back(place(i / count));
    return curve;
}

Curve straight(double reach) {
    return drawn(2.0 * reach, [&](double t) { return glm::dvec2(reach * (2.0 * t - 1.0), 0.0); });
}

Curve ring(double reach) {
    const double round = 2.0 * std::numbers::pi;
    Curve curve = drawn(round * reach, [&](double t) {
        return reach * glm::dvec2(std::sin(round * t), std::cos(round * t));
    });
    curve.back() = curve.front();
    return curve;
}

/// Outwards with a seventh of the reach between the turns.
Curve spiral(double reach) {
    constexpr double kTurns = 6.0, kStart = 1.0 / 7.0;
    const double angle = 2.0 * std::numbers::pi * kTurns;
    // The radius grows linearly with the angle, so the arc length grows with the radius squared.
    return drawn(0.5 * (1.0 + kStart) * reach * angle, [&](double t) {
        const double share = std::sqrt(kStart * kStart + t * (1.0 - kStart * kStart));
        const double at = angle * (share - kStart) / (1.0 - kStart);
        return reach * share * glm::dvec2(std::sin(at), std::cos(at));
    });
}

/// Nine lines back and forth, joined by half circles: a scan of a 3:2 field.
Curve raster(double reach) {
    constexpr int kLines = 9;
    const double high = reach * 2.0 / 3.0, step = 2.0 * high / (kLines - 1), bend = 0.5 * step;
    const double wide = reach - bend, line = 2.0 * wide, turn = std::numbers::pi * bend;
    const double length = kLines * line + (kLines - 1) * turn;
    return drawn(length, [&](double t) {
        const double way = t * length;
        const int row = std::min(kLines - 1, static_cast<int>(way / (line + turn)));
        const double rest = way - row * (line + turn), y = high - row * step,
                     side = row % 2 == 0 ? 1.0 : -1.0;
        if (rest <= line)
            return glm::dvec2(side * (rest - wide), y);
        const double angle = (rest - line) / bend;
        return glm::dvec2(side * (wide + bend * std::sin(angle)), y - bend * (1.0 - std::cos(angle)));
    });
}

/// Parameters of a stroke: speed and depth as requested, the depth as limited by the model, and the hover
/// height.
struct Told {
    double speed = 0.0, depth = 0.0;
    double hover = kHovers[0];
};
/// Descends at the landing speed in the air; a slower stroke slows down at the surface.
void land(StrokeMotion& motion, const Told& told) {
    if (told.speed < kLanding)
        motion.liftTo(told.depth, kLanding);
    motion.liftTo(0.0, std::min(told.speed, kLanding));
}
void leave(StrokeMotion& motion, const Told& told) {
    if (told.speed < kLanding)
        motion.liftTo(told.depth, told.speed);
    motion.liftTo(told.depth + told.hover, kLanding);
    motion.rest(0.2);
}

/// Onto the surface, then in and out, as in probing hardness.
void press(StrokeMotion& motion, const LaidCurve&, const Told& told) {
    motion.liftTo(told.depth, kLanding);
    for (int i = 0; i < 3; ++i) {
        motion.liftTo(0.0, told.speed);
        motion.rest(0.3);
        motion.liftTo(told.depth, told.speed);
        motion.rest(0.2);
    }
    leave(motion, told);
}

/// Five taps, each down and at once up again, twice a second.
void tap(StrokeMotion& motion, const LaidCurve&, const Told& told) {
    for (int i = 0; i < 5; ++i) {
        motion.liftTo(0.0, told.speed);
        motion.liftTo(told.depth + told.hover, told.speed);
        motion.rest(0.2);
    }
}

void hold(StrokeMotion& motion, const LaidCurve&, const Told& told) {
    constexpr double kTremor = 5e-5; // m; a finger that presses trembles by some hundredths of a millimetre
    motion.liftTo(0.0, told.speed);
    motion.tremble(4.0, kTremor);
    leave(motion, told);
}

/// Back and forth in reaches, as in feeling for a bump.
void rub(StrokeMotion& motion, const LaidCurve& curve, const Told& told) {
    land(motion, told);
    for (int i = 0; i < 3; ++i) {
        motion.reachTo(curve.length(), told.speed);
        motion.reachTo(0.0, told.speed);
    }
    leave(motion, told);
}

void round(StrokeMotion& motion, const LaidCurve& curve, const Told& told) {
    land(motion, told);
    motion.runTo(3.0 * curve.length(), told.speed);
    leave(motion, told);
}

/// Over the edge and back, three times: the curve is closed, and the far side is in its middle.
void cross(StrokeMotion& motion, const LaidCurve& curve, const Told& told) {
    land(motion, told);
    for (int i = 0; i < 6; ++i)
        motion.reachTo(0.5 * (i + 1) * curve.length(), told.speed);
    leave(motion, told);
}

/// To the end at constant speed and back.
void follow(StrokeMotion& motion, const LaidCurve& curve, const Told& told) {
    land(motion, told);
    motion.runTo(curve.length(), told.speed);
    motion.runTo(0.0, told.speed);
    leave(motion, told);
}

/// A stroke of the table.
struct StrokeKind {
    StrokeInfo info;
    double reach = 0.0;                    ///< m from the curve's middle, at full size
    Curve (*draw)(double reach) = nullptr; ///< null: it stays on one point
    void (*move)(StrokeMotion&, const LaidCurve&, const Told&) = nullptr; ///< null: the tour
};

// Speeds and forces of human exploration: 20 to 200 mm/s and 0.5 to 2 N (0.6 N per millimetre at 600 N/m).
constexpr std::array kKinds{
    StrokeKind{
        {"tour", "round the model on the side that faces you, hopping over gaps and steps", 0.1, 0.001}},
    StrokeKind{{"press", "into the surface and out again, to feel how stiff it is", 0.02, 0.003},
               0.0,
               nullptr,
               press},
    StrokeKind{{"tap", "five taps, down and at once up again", 0.15, 0.0015}, 0.0, nullptr, tap},
    StrokeKind{{"slide", "straight to and fro over 30 mm", 0.1, 0.001}, 0.015, straight, rub},
    StrokeKind{{"circle", "three times round a circle of 20 mm", 0.08, 0.001}, 0.01, ring, round},
    StrokeKind{{"zigzag", "scans a field of 30 x 20 mm line by line", 0.08, 0.001}, 0.015, raster, follow},
    StrokeKind{{"spiral", "out and back in a spiral of 24 mm", 0.06, 0.001}, 0.012, spiral, follow},
    StrokeKind{{"hold", "rests on one point for 4 s, trembling at 8 to 12 Hz as hands do", 0.05, 0.0015},
               0.0,
               nullptr,
               hold},
    StrokeKind{{"edge", "to and fro across the model's sharpest edge", 0.05, 0.001}, 0.012, nullptr, cross},
    StrokeKind{{"fast", "to and fro over 60 mm, as fast as one wipes", 0.5, 0.001}, 0.03, straight, rub},
};

/// On a part that deforms, where no hop of the tour holds.
constexpr std::string_view kInsteadOfTour = "zigzag";

const StrokeKind* findKind(std::string_view name) {
    const auto found =
        std::ranges::find_if(kKinds, [&](const StrokeKind& kind) { return kind.info.name == name; });
    return found != kKinds.end() ? &*found : nullptr;
}

/// The model that a stroke is laid on.
struct Ground {
    const TriangleSource& triangles;
    const Bounds bounds;
    std::span<const Bounds> keepOut; ///< boxes that the hand must not enter
    const CarryPath& carry;
};

/// The path along `curve` that keeps to its depth over `near`; nullopt if none does with any hover.
std::optional<StrokePath> held(const Ground& ground, const TriangleSource& near, const StrokeKind& kind,
                               const LaidCurve& curve, Told told) {
    for (const double hover : kHovers) {
        told.hover = hover;
        StrokeMotion motion(curve, told.depth + hover);
        kind.move(motion, curve, told);
        StrokePath path = motion.finish(curve.at(0.0, told.depth));
        const glm::dvec3 start = curve.at(0.0, told.depth + hover);
        if (strokeHolds(near, path, told.depth, ground.keepOut) &&
            !maybeInside(ground.triangles, start, glm::normalize(start - curve.at(0.0, 0.0)))) {
            if (!ground.carry)
                return path;
            if (auto carried = ground.carry(path, told.depth))
                return carried;
        }
    }
    return std::nullopt;
}

/// Over the sharpest edge with room on both sides.
std::optional<StrokePath> laidAcrossEdge(const Ground& ground, const StrokeKind& kind,
                                         const glm::dvec3& front, double reach, const Told& told) {
    for (const EdgeSite& edge : sharpestEdges(ground.triangles, ground.bounds, front)) {
        const std::vector<SurfaceTriangle> around =
            trianglesNear(ground.triangles, edge.point, 2.0 * (reach + told.depth));
        for (const double size : kEdgeSizes)
            if (const auto curve = LaidCurve::acrossEdge(trianglesOf(around), edge, size * reach, told.depth))
                if (auto path = held(ground, ground.triangles, kind, *curve, told))
                    return path;
    }
    return std::nullopt;
}

/// On one point: of the best site, else wherever a hand can press.
std::optional<StrokePath> laidOnPoint(const Ground& ground, const StrokeKind& kind,
                                      std::span<const StrokeSite> sites, const glm::dvec3& front,
                                      const Told& told) {
    std::vector<PressPlace> places;
    for (const StrokeSite& site : sites)
        places.push_back({site.view.centre, site.view.towards});
    for (const PressPlace& place : pressPlaces(ground.triangles, ground.bounds, front))
        places.push_back(place);
    std::optional<StrokePath> path;
    for (const bool anywhere : {false, true}) {
        (void)firstPress(ground.triangles, places, kHovers[0], told.depth,
                         [&](const PressPlace& place, const TriangleSource& near) {
                             if (!anywhere && !isSupported(near, place))
                                 return false;
                             Told shallower = told;
                             shallower.depth = place.depth;
                             const LaidCurve point(place.point, place.normal, place.depth);
                             path = held(ground, near, kind, point, shallower);
                             return path.has_value();
                         });
        if (path)
            break;
    }
    return path;
}

/// The stroke of `kind` at its place, at the largest size that fits.
std::optional<StrokePath> laid(const Ground& ground, const StrokeKind& kind, const StrokeRequest& request,
                               const Told& told) {
    const auto& [triangles, bounds, keepOut, carry] = ground;
    const double reach = std::min(kind.reach, kReachOfModel * bounds.diagonal());
    if (kind.move == cross)
        if (auto path = laidAcrossEdge(ground, kind, request.front, reach, told))
            return path;
    const std::vector<StrokeSite> sites = sitesOf(triangles, bounds, request);
    const double soft = std::max(told.depth, kSoftTime * told.speed);
    const auto draw = kind.draw != nullptr ? kind.draw : ring;
    std::vector<std::vector<SurfaceTriangle>> around(sites.size());
    for (const double size : reach > 0.0 ? std::span<const double>(kSizes) : std::span<const double>())
        for (size_t i = 0; i < sites.size(); ++i) {
            const StrokeSite& site = sites[i];
            if (around[i].empty())
                around[i] =
                    trianglesNear(triangles, site.view.centre, 2.0 * (reach + site.ceiling + told.depth));
            const auto curve = LaidCurve::over(trianglesOf(around[i]), site.view, draw(size * reach),
                                               told.depth, soft, site.ceiling + size * reach);
            if (!curve)
                continue;
            if (auto path = held(ground, trianglesOf(around[i]), kind, *curve, told))
                return path;
        }
    return laidOnPoint(ground, kind, sites, request.front, told);
}

double withinRange(double asked, double own, double least, double most, const char* what) {
    if (asked == 0.0)
        return own;
    if (!(asked >= least && asked <= most))
        throw Error("stroke", what, "is outside its range",
                    std::to_string(least) + " .. " + std::to_string(most));
    return asked;
}

StrokePath layKind(const TriangleSource& triangles, std::span<const Bounds> keepOut, const StrokeKind& kind,
                   const StrokeRequest& request, const Told& told, const CarryPath& carry = {}) {
    if (kind.move == nullptr)
        try {
            return strokeOver(triangles, {.speed = told.speed, .depth = told.depth, .front = request.front},
                              keepOut, carry);
        } catch (const Error&) {
            if (!carry)
                throw;
            return layKind(triangles, keepOut, *findKind(kInsteadOfTour), request, told, carry);
        }
    const Ground ground{triangles, boundsOf(triangles), keepOut, carry};
    const Told allowed{told.speed, std::min(told.depth, kDeepestOfModel * ground.bounds.diagonal())};
    if (allowed.depth >= kLeastDepth)
        if (auto path = laid(ground, kind, request, allowed))
            return *std::move(path);
    throw noPlaceToPress(triangles);
}

/// The requested kind with its speed and depth; throws Error for an unknown kind or a value out of range.
std::pair<const StrokeKind*, Told> understood(const StrokeRequest& request) {
    const StrokeKind* const kind = findKind(request.name);
    if (kind == nullptr)
        throw Error("stroke", request.name, strokeProblem(request.name), "");
    return {kind,
            {withinRange(request.speed, kind->info.speed, kSlowestStroke, kFastestStroke, "speed (m/s)"),
             withinRange(request.depth, kind->info.depth, kShallowestStroke, kDeepestStroke, "depth (m)")}};
}

} // namespace

std::span<const StrokeInfo> strokeInfos() {
    static const auto infos = [] {
        std::array<StrokeInfo, kKinds.size()> all{};
        std::ranges::transform(kKinds, all.begin(), [](const StrokeKind& kind) { return kind.info; });
        return all;
    }();
    return infos;
}

const StrokeInfo* findStroke(std::string_view name) {
    const auto infos = strokeInfos();
    const auto found = std::ranges::find_if(infos, [&](const StrokeInfo& info) { return info.name == name; });
    return found != infos.end() ? &*found : nullptr;
}

std::string strokeProblem(std::string_view name) {
    if (findStroke(name) != nullptr)
        return "";
    std::string problem = "'" + std::string(name) + "' is no stroke; there are";
    for (const StrokeInfo& info : strokeInfos())
        problem += (info.name == strokeInfos().front().name ? " " : ", ") + std::string(info.name);
    return problem;
}

StrokePath layStroke(const Scene& scene, const Similarity& deviceFromScene, const StrokeRequest& request) {
    const auto [kind, told] = understood(request);
    const TriangleSource triangles = trianglesOf(scene, deviceFromScene);
    const std::vector<MovingPart> parts = movingParts(scene, deviceFromScene, request);
    if (parts.empty())
        return layKind(triangles, {}, *kind, request, told);
    for (const bool mayJump : {false, true})
        for (const MovingPart& part : parts) {
            if (mayJump && part.deforming == nullptr)
                continue;
            try {
                CarryPath carry;
                if (part.deforming != nullptr)
                    carry = [&](const StrokePath& path, double depth) {
                        return part.deforming->carried(path, depth, part.keepOut, mayJump);
                    };
                const StrokePath path =
                    layKind(trianglesOf(triangles, part), part.keepOut, *kind, request, told, carry);
                return part.deforming != nullptr ? path : path.carriedBy(part.motion);
            } catch (const Error&) {
                continue; // the others sweep over all of it, or it moves too far
            }
        }
    throw noPlaceToPress(triangles);
}

StrokePath layStroke(std::span<const glm::dvec3> corners, const StrokeRequest& request) {
    const auto [kind, told] = understood(request);
    return layKind(trianglesOf(corners), {}, *kind, request, told);
}

} // namespace touchstone
