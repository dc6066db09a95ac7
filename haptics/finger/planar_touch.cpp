#include "haptics/finger/planar_touch.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

glm::dvec2 SmoothArc::point(double at) const noexcept {
    return centre() + radius * glm::dvec2(std::sin(at), std::cos(at));
}

Polyline polygonOf(const SmoothArc& arc, size_t segments) {
    if (segments == 0)
        throw Error("polygon", "", "it has no segment", "give at least one");
    std::vector<glm::dvec2> points(segments + 1);
    for (size_t i = 0; i <= segments; ++i)
        points[i] = arc.point(arc.angle * (static_cast<double>(i) / static_cast<double>(segments) - 0.5));
    return Polyline(points, false);
}

void PlanarSurface::findNormals() {
    const size_t edges = line_->edgeCount();
    normals_.resize(line_->points().size());
    for (size_t i = 0; i < normals_.size(); ++i) {
        const bool first = i == 0, last = i >= edges;
        const glm::dvec2 before = line_->edge(first ? (line_->closed() ? edges - 1 : 0) : i - 1).normal;
        normals_[i] = glm::normalize(before + line_->edge(last ? edges - 1 : i).normal);
    }
}

PlanarTouch::PlanarTouch(const PlanarSurface& surface, const PlanarRendering& rendering,
                         const ArcFinger& finger) noexcept
    : surface_(surface), rendering_(rendering), finger_(finger) {
    if (surface_.polyline() != nullptr &&
        (rendering_.force == PlanarForce::Bezier || rendering_.location == PlanarLocation::Bezier))
        shading_.emplace(*surface_.polyline(), finger_, rendering_.step);
}

void PlanarTouch::forget() noexcept {
    if (shading_)
        shading_->forget();
}

/// The feature of the polyline nearest to the finger's centre, of the edges whose free side the centre is on.
/// `apart`: only features whose normal differs from that contact's, a second wall.
PlanarTouch::Contact PlanarTouch::nearest(const glm::dvec2& centre, const Contact* apart) const noexcept {
    constexpr double kSameNormal = 1e-9;
    const Polyline& line = *surface_.polyline();
    const auto points = line.points();
    Contact best;
    double shortest = finger_.radius;
    for (size_t i = 0; i < line.edgeCount(); ++i) {
        const glm::dvec2 from = points[i], run = points[(i + 1) % points.size()] - from, to = centre - from;
        if (glm::dot(to, line.edge(i).normal) <= 0.0)
            continue;
        const double along = std::clamp(glm::dot(to, run) / glm::dot(run, run), 0.0, 1.0);
        const glm::dvec2 away = to - along * run;
        const double distance = glm::length(away);
        if (distance >= shortest || distance <= 0.0)
            continue;
        const glm::dvec2 normal = away / distance;
        if (apart != nullptr && 1.0 - glm::dot(normal, apart->normal) < kSameNormal)
            continue;
        shortest = distance;
        best = {true, i, along, from + along * run, normal, finger_.radius - distance};
    }
    return best;
}

PlanarTouch::Felt PlanarTouch::onArc(const SmoothArc& arc, const FingerPose& pose) const noexcept {
    Felt felt;
    const glm::dvec2 to = finger_.centre(pose) - arc.centre();
    const double distance = glm::length(to);
    if (!(distance > 0.0) || std::abs(std::atan2(to.x, to.y)) > 0.5 * arc.angle)
        return felt;
    felt.normal = to / distance;
    felt.point = arc.centre() + arc.radius * felt.normal;
    felt.depth = arc.radius + finger_.radius - distance;
    felt.touching = felt.depth > 0.0;
    felt.location = finger_.locationTowards(pose, -felt.normal);
    if (felt.touching)
        felt.force = rendering_.stiffness * felt.depth * felt.normal;
    return felt;
}

/// Facets: the proxy is the finger whose circle is nearest to the hand's and free of all edges. It stands on
/// the deepest feature, or where the way out of that meets a second wall in the corner of both.
PlanarTouch::Felt PlanarTouch::onPolyline(const FingerPose& pose) noexcept {
    Felt felt;
    const Polyline& line = *surface_.polyline();
    const glm::dvec2 centre = finger_.centre(pose);
    TactileShading::Felt smooth;
    if (shading_)
        smooth = shading_->step(pose);
    const Contact first = nearest(centre, nullptr);
    felt.point = first.point;
    felt.location = first.found ? finger_.locationTowards(pose, -first.normal) : 0.0;
    if (rendering_.location == PlanarLocation::Bezier)
        felt.location = smooth.contact.location;
    glm::dvec2 out = first.depth * first.normal;
    if (first.found) {
        const Contact second = nearest(centre + out, &first);
        const double cross = second.found ? crossed(first.normal, second.normal) : 0.0;
        if (second.found && second.depth > 1e-12 && std::abs(cross) > 1e-9) {
            // n1.x = d1, n2.x = d2, seen from the hand's place.
            const double depth2 = second.depth + glm::dot(out, second.normal);
            out = (first.depth * glm::dvec2(second.normal.y, -second.normal.x) -
                   depth2 * glm::dvec2(first.normal.y, -first.normal.x)) /
                  cross;
        }
    }
    felt.depth = glm::length(out);
    felt.normal = felt.depth > 0.0 ? out / felt.depth : glm::dvec2(0.0, 1.0);
    if (rendering_.force == PlanarForce::Shaded && first.found) {
        const size_t next = (first.edge + 1) % line.points().size();
        felt.normal = glm::normalize((1.0 - first.along) * surface_.normalAt(first.edge) +
                                     first.along * surface_.normalAt(next));
    } else if (rendering_.force == PlanarForce::Bezier) {
        felt.depth = smooth.contact.depth;
        felt.normal = smooth.line.normal;
        felt.point = smooth.contact.point;
    }
    felt.touching = felt.depth > 0.0 && (first.found || rendering_.force == PlanarForce::Bezier);
    felt.force = felt.touching ? rendering_.stiffness * felt.depth * felt.normal : glm::dvec2(0.0);
    return felt;
}

PlanarTouch::Felt PlanarTouch::step(const FingerPose& pose) noexcept {
    if (!std::isfinite(pose.pad.x) || !std::isfinite(pose.pad.y) || !std::isfinite(pose.pitch))
        return {};
    Felt felt = surface_.arc() != nullptr ? onArc(*surface_.arc(), pose) : onPolyline(pose);
    if (rendering_.location == PlanarLocation::Held)
        felt.location = 0.0;
    return felt;
}

} // namespace touchstone
