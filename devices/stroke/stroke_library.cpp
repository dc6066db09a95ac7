// Lays the strokes of the simulated hand: chooses the place, draws the curve, projects it and moves along it.

#include "devices/stroke/stroke_library.h"

#include "devices/stroke/press_place.h"
#include "devices/stroke/scene_motion.h"
#include "devices/stroke/stroke_check.h"
#include "devices/stroke/stroke_kinds.h"
#include "devices/stroke/stroke_place.h"
#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

constexpr double kDeepestOfModel = 0.1; ///< of the model's diagonal: a small model is not pierced
constexpr double kReachOfModel = 0.25;  ///< of the diagonal: no curve reaches farther from its middle
constexpr double kSoftTime = 0.01;      ///< s over which a hand turns to another direction, at least
constexpr std::array kSizes{1.0, 0.7, 0.5, 0.35, 0.25, 0.15, 0.1, 0.05}; ///< of its full size, tried in order
constexpr std::array kEdgeSizes{1.0, 0.5, 0.25, 0.15};
constexpr size_t kMostCarried = 24; ///< paths on a part that deforms

/// On a part that deforms, where no hop of the tour holds.
constexpr std::string_view kInsteadOfTour = "zigzag";

/// Carries paths with a part that deforms, each of which takes up to a second, and gives up after some.
class Carrier {
  public:
    /// Empty: paths stay as they are.
    explicit Carrier(CarryPath carry = {}) : carry_(std::move(carry)) {}
    [[nodiscard]] bool moves() const { return carry_ != nullptr; }
    [[nodiscard]] bool gaveUp() const { return moves() && left_ == 0; }
    [[nodiscard]] std::optional<StrokePath> carried(const StrokePath& path, double depth) {
        if (!moves())
            return path;
        if (left_ == 0)
            return std::nullopt;
        --left_;
        return carry_(path, depth);
    }

  private:
    CarryPath carry_;
    size_t left_ = kMostCarried;
};

/// The model that a stroke is laid on.
struct Ground {
    const TriangleSource& triangles;
    const Bounds bounds;
    std::span<const Bounds> keepOut; ///< boxes that the hand must not enter
    Carrier& carrier;
};

/// The path along `curve` that keeps to its depth over `near`; nullopt if none does with any hover.
std::optional<StrokePath> held(const Ground& ground, const TriangleSource& near, const StrokeKind& kind,
                               const LaidCurve& curve, StrokeTold told) {
    for (const double hover : kHovers) {
        told.hover = hover;
        StrokeMotion motion(curve, told.depth + hover);
        kind.move(motion, curve, told);
        StrokePath path = motion.finish(curve.at(0.0, told.depth));
        const glm::dvec3 start = curve.at(0.0, told.depth + hover);
        if (strokeHolds(near, path, told.depth, ground.keepOut) &&
            !maybeInside(ground.triangles, start, glm::normalize(start - curve.at(0.0, 0.0))))
            if (auto carried = ground.carrier.carried(path, told.depth))
                return carried;
    }
    return std::nullopt;
}

/// Over the sharpest edge with room on both sides.
std::optional<StrokePath> laidAcrossEdge(const Ground& ground, const StrokeKind& kind,
                                         const glm::dvec3& front, double reach, const StrokeTold& told) {
    for (const EdgeSite& edge : sharpestEdges(ground.triangles, ground.bounds, front)) {
        const std::vector<SurfaceTriangle> around =
            trianglesNear(ground.triangles, edge.point, 2.0 * (reach + told.depth));
        for (const double size : kEdgeSizes) {
            if (ground.carrier.gaveUp())
                return std::nullopt;
            if (const auto curve = LaidCurve::acrossEdge(trianglesOf(around), edge, size * reach, told.depth))
                if (auto path = held(ground, ground.triangles, kind, *curve, told))
                    return path;
        }
    }
    return std::nullopt;
}

/// On one point: of the best site, else wherever a hand can press.
std::optional<StrokePath> laidOnPoint(const Ground& ground, const StrokeKind& kind,
                                      std::span<const StrokeSite> sites, const glm::dvec3& front,
                                      const StrokeTold& told) {
    if (ground.carrier.gaveUp())
        return std::nullopt;
    std::vector<PressPlace> places;
    for (const StrokeSite& site : sites)
        places.push_back({site.view.centre, site.view.towards});
    for (const PressPlace& place : pressPlaces(ground.triangles, ground.bounds, front))
        places.push_back(place);
    std::optional<StrokePath> path;
    for (const bool anywhere : {false, true}) {
        PressPlace last;
        (void)firstPress(ground.triangles, places, kHovers[0], told.depth,
                         [&](const PressPlace& place, const TriangleSource& near) {
                             const bool again = place.point == last.point && place.normal == last.normal &&
                                                place.depth == last.depth;
                             last = place;
                             if (again) // with less hover, as `held` has tried
                                 return false;
                             if (!anywhere && !isSupported(near, place))
                                 return false;
                             StrokeTold shallower = told;
                             shallower.depth = place.depth;
                             const LaidCurve point(place.point, place.normal, place.depth);
                             path = held(ground, near, kind, point, shallower);
                             return path.has_value() || ground.carrier.gaveUp();
                         });
        if (path || ground.carrier.gaveUp())
            break;
    }
    return path;
}

/// The stroke of `kind` at its place, at the largest size that fits.
std::optional<StrokePath> laid(const Ground& ground, const StrokeKind& kind, const StrokeRequest& request,
                               const StrokeTold& told) {
    const auto& [triangles, bounds, keepOut, carrier] = ground;
    const double reach = std::min(kind.reach, kReachOfModel * bounds.diagonal());
    if (kind.acrossEdge)
        if (auto path = laidAcrossEdge(ground, kind, request.front, reach, told))
            return path;
    const std::vector<StrokeSite> sites = sitesOf(triangles, bounds, request);
    const double soft = std::max(told.depth, kSoftTime * told.speed);
    std::vector<std::vector<SurfaceTriangle>> around(sites.size());
    for (const double size : reach > 0.0 ? std::span<const double>(kSizes) : std::span<const double>()) {
        for (size_t i = 0; i < sites.size() && !carrier.gaveUp(); ++i) {
            const StrokeSite& site = sites[i];
            if (around[i].empty())
                around[i] =
                    trianglesNear(triangles, site.view.centre, 2.0 * (reach + site.ceiling + told.depth));
            const auto curve = LaidCurve::over(trianglesOf(around[i]), site.view, kind.draw(size * reach),
                                               told.depth, soft, site.ceiling + size * reach);
            if (!curve)
                continue;
            if (auto path = held(ground, trianglesOf(around[i]), kind, *curve, told))
                return path;
        }
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
                   const StrokeRequest& request, const StrokeTold& told, Carrier& carrier) {
    if (kind.move == nullptr)
        try {
            CarryPath carry;
            if (carrier.moves())
                carry = [&](const StrokePath& path, double depth) { return carrier.carried(path, depth); };
            return strokeOver(triangles, {.speed = told.speed, .depth = told.depth, .front = request.front},
                              keepOut, carry);
        } catch (const Error&) {
            if (!carrier.moves())
                throw;
            return layKind(triangles, keepOut, *findKind(kInsteadOfTour), request, told, carrier);
        }
    const Ground ground{triangles, boundsOf(triangles), keepOut, carrier};
    const StrokeTold allowed{told.speed, std::min(told.depth, kDeepestOfModel * ground.bounds.diagonal())};
    if (allowed.depth >= kLeastDepth)
        if (auto path = laid(ground, kind, request, allowed))
            return *std::move(path);
    throw noPlaceToPress(triangles);
}

/// The requested kind with its speed and depth; throws Error for an unknown kind or a value out of range.
std::pair<const StrokeKind*, StrokeTold> understood(const StrokeRequest& request) {
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
        std::vector<StrokeInfo> all;
        for (const StrokeKind& kind : strokeKinds())
            all.push_back(kind.info);
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
    Carrier stays;
    if (parts.empty())
        return layKind(triangles, {}, *kind, request, told, stays);
    for (const bool mayJump : {false, true})
        for (const MovingPart& part : parts) {
            if (mayJump && part.deforming == nullptr)
                continue;
            try {
                if (part.deforming == nullptr)
                    return layKind(trianglesOf(triangles, part), part.keepOut, *kind, request, told, stays)
                        .carriedBy(part.motion);
                Carrier carrier([&](const StrokePath& path, double depth) {
                    return part.deforming->carried(path, depth, part.keepOut, mayJump);
                });
                return layKind(trianglesOf(triangles, part), part.keepOut, *kind, request, told, carrier);
            } catch (const Error&) {
                continue; // the others sweep over all of it, or it moves too far
            }
        }
    throw noPlaceToPress(triangles);
}

StrokePath layStroke(std::span<const glm::dvec3> corners, const StrokeRequest& request) {
    const auto [kind, told] = understood(request);
    Carrier stays;
    return layKind(trianglesOf(corners), {}, *kind, request, told, stays);
}

} // namespace touchstone
