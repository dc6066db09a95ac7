#include "haptics/comparison/ray_path.h"

#include "haptics/shape/mesh/ray.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {

namespace {

/// Distance by which a ray begins before the move does, so that a start that float rounding put behind a
/// surface is before it again; and distance behind an ignored surface at which the next ray begins. Object
/// units.
constexpr double kRayMargin = 4e-7;
/// Extension of a ray beyond the end of a move, in clearances: a surface that the move approaches without
/// meeting it is inclined to it by less than 1 in this.
constexpr double kBeyond = 20.0;

/// Error bound of a height, in object units: above minus this a start counts as before the plane.
template <class Real>
Real slack(const glm::vec<3, Real>& p) {
    return 4 * std::numeric_limits<Real>::epsilon() * (1 + glm::length(p));
}

template <class Real>
glm::vec<3, Real> corner(const HapticObject& object, uint32_t triangle, size_t k) {
    return glm::vec<3, Real>(object.vertices[object.indices[3 * static_cast<size_t>(triangle) + k]]);
}

} // namespace

template <class Real>
RayFacet<Real>::RayFacet(const HapticObject& object, uint32_t triangle) noexcept
    : a(corner<Real>(object, triangle, 0)), b(corner<Real>(object, triangle, 1)),
      c(corner<Real>(object, triangle, 2)), normal(Real(0)) {
    const Vec area = glm::cross(b - a, c - a);
    const Real squared = glm::dot(area, area);
    if (squared > std::numeric_limits<Real>::min())
        normal = area / std::sqrt(squared);
}

template <class Real>
std::optional<RayMeeting<Real>> meetAlong(const HapticObject& object, const glm::vec<3, Real>& from,
                                          const glm::vec<3, Real>& direction, Real far) noexcept {
    constexpr int kAttempts = 4;
    const Real margin = Real(kRayMargin);
    // A ray from afar would add its start's rounding: it begins at the object.
    const Real reach = Real(1.001 * object.boundingRadius + 1e-3);
    const Real along = glm::dot(from, direction);
    const glm::vec<3, Real> nearest = from - along * direction;
    Real start = -margin;
    if (glm::dot(from, from) > reach * reach) {
        const Real half = reach * reach - glm::dot(nearest, nearest);
        if (along >= 0 || half < 0)
            return std::nullopt;
        start = std::max(start, -along - std::sqrt(half));
    }
    const glm::vec3 origin(from + start * direction), towards(direction);
    float near = 0.0f;
    for (int attempt = 0; attempt < kAttempts && Real(near) < far - start; ++attempt) {
        const std::optional<RayHit> hit =
            castRay(object, origin, towards, near, static_cast<float>(far - start));
        if (!hit)
            return std::nullopt;
        const RayFacet<Real> facet(object, hit->triangle);
        const Real slope = glm::dot(direction, facet.normal);
        const Real back = slope < 0 ? Real(1) : Real(-1);
        const Real height = back * glm::dot(from - facet.a, facet.normal);
        const bool felt = !object.oneSided || back > 0;
        if (felt && slope != 0 && height >= -slack(from))
            return RayMeeting<Real>{.distance = Real(hit->distance) + start,
                                    .height = height,
                                    .rate = back * slope,
                                    .back = back,
                                    .normal = back * facet.normal,
                                    .triangle = hit->triangle};
        near = hit->distance + static_cast<float>(kRayMargin);
    }
    return std::nullopt;
}

template <class Real>
Similarity RayPath<Real>::objectFromReference(int object) const noexcept {
    return motions_[static_cast<size_t>(object)].workspaceFromObject.inverseTimes(
        motions_[static_cast<size_t>(reference_)].workspaceFromObject);
}

/// Collects the objects other than the reference object whose spheres meet a ball around the path.
template <class Real>
void RayPath<Real>::gather(const glm::dvec3& from, const glm::dvec3& to) noexcept {
    const Similarity& reference = motions_[static_cast<size_t>(reference_)].workspaceFromObject;
    const glm::dvec3 begin = reference.point(from), end = reference.point(to);
    if (radius_ >= 0.0 && glm::length(begin - middle_) <= radius_ && glm::length(end - middle_) <= radius_)
        return;
    const double extent = reference.scale * scene_.objects[static_cast<size_t>(reference_)]->boundingRadius;
    middle_ = 0.5 * (begin + end);
    radius_ = glm::length(end - begin) + 1e-3 * extent;
    count_ = 0;
    full_ = false;
    for (size_t k = 0; k < scene_.objects.size(); ++k) {
        const Similarity& pose = motions_[k].workspaceFromObject;
        const double reach = radius_ + 1.01 * pose.scale * scene_.boundingRadii[k];
        const glm::dvec3 off = pose.translation - middle_;
        if (static_cast<int>(k) == reference_ || glm::dot(off, off) > reach * reach)
            continue;
        if (count_ == kMaxNear) {
            full_ = true;
            radius_ = -1.0;
            return;
        }
        near_[count_++] = static_cast<int>(k);
    }
}

/// `from`, `direction` and `length` in the reference object's frame; `first`: distance of the previous hit.
template <class Real>
void RayPath<Real>::strikeOne(int object, const Vec& from, const Vec& direction, Real length, Real& first,
                              std::optional<RayStrike<Real>>& hit) const noexcept {
    const HapticObject& shape = *scene_.objects[static_cast<size_t>(object)];
    Vec start = from, towards = direction;
    Real unit = 1; // reference object units per unit of the object
    Similarity here;
    const bool foreign = object != reference_;
    if (foreign) {
        here = objectFromReference(object);
        start = Vec(here.point(glm::dvec3(from)));
        towards = Vec(here.direction(glm::dvec3(direction)));
        unit = Real(1.0 / here.scale);
    }
    const Real clearance = kRayClearance<Real> * unit;
    const Real far = std::min(length + Real(kBeyond) * clearance, first);
    const auto met = meetAlong<Real>(shape, start, towards, far / unit);
    if (!met)
        return;
    const Real height = unit * met->height;
    if (height + length * met->rate >= clearance)
        return; // the move ends before it
    // A place far out has coarse rounding: the move stops short by that, and continues from there.
    const Real coarse =
        8 * std::numeric_limits<Real>::epsilon() * std::max(unit * glm::length(start) - 2 * unit, Real(0));
    const Real free = met->rate < 0 ? (height - clearance) / -met->rate - coarse : Real(0);
    first = unit * met->distance;
    hit = RayStrike<Real>{.normal = foreign ? Vec(glm::conjugate(here.rotation) * glm::dvec3(met->normal))
                                            : met->normal,
                          .share = std::clamp(free / length, Real(0), Real(1)),
                          .back = met->back,
                          .clearance = clearance,
                          .object = object,
                          .triangle = met->triangle};
}

template <class Real>
std::optional<RayStrike<Real>> RayPath<Real>::strike(const Vec& from, const Vec& move) noexcept {
    std::optional<RayStrike<Real>> hit;
    const Real length = glm::length(move);
    const Vec direction = move / length;
    Real first = std::numeric_limits<Real>::infinity();
    strikeOne(reference_, from, direction, length, first, hit);
    if (scene_.objects.size() == 1)
        return hit;
    gather(glm::dvec3(from), glm::dvec3(from + move));
    for (size_t i = 0; i < count_; ++i)
        strikeOne(near_[i], from, direction, length, first, hit);
    return hit;
}

template <class Real>
Real RayPath<Real>::height(const RayStrike<Real>& at, const Vec& p) const noexcept {
    const HapticObject& shape = *scene_.objects[static_cast<size_t>(at.object)];
    if (at.object == reference_)
        return glm::dot(p - corner<Real>(shape, at.triangle, 0), at.normal);
    const Similarity here = objectFromReference(at.object);
    const RayFacet<Real> facet(shape, at.triangle);
    return Real(1.0 / here.scale) * at.back *
           glm::dot(Vec(here.point(glm::dvec3(p))) - facet.a, facet.normal);
}

template <class Real>
bool RayPath<Real>::stands(const RayStrike<Real>& at, const Vec& p) const noexcept {
    const RayFacet<Real> facet(*scene_.objects[static_cast<size_t>(at.object)], at.triangle);
    const Vec q = at.object == reference_ ? p : Vec(objectFromReference(at.object).point(glm::dvec3(p)));
    // Within the rounding of the place beyond the triangle's edge the proxy still stands on it: else the
    // plane would be dropped and found again in every move.
    constexpr Real kLoose = Real(0.05) * kRayClearance<Real>;
    const auto inside = [&](const Vec& start, const Vec& end) {
        const Vec edge = end - start;
        const Real side = glm::dot(glm::cross(edge, q - start), facet.normal);
        return side >= 0 || side * side <= kLoose * kLoose * glm::dot(edge, edge);
    };
    return std::abs(glm::dot(q - facet.a, facet.normal)) <= Real(1.5) * kRayClearance<Real> &&
           inside(facet.a, facet.b) && inside(facet.b, facet.c) && inside(facet.c, facet.a);
}

template struct RayFacet<double>;
template struct RayFacet<float>;
template std::optional<RayMeeting<double>> meetAlong(const HapticObject&, const glm::dvec3&,
                                                     const glm::dvec3&, double) noexcept;
template std::optional<RayMeeting<float>> meetAlong(const HapticObject&, const glm::vec3&, const glm::vec3&,
                                                    float) noexcept;
template class RayPath<double>;
template class RayPath<float>;

} // namespace touchstone
