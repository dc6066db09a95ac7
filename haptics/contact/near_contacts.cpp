#include "haptics/contact/near_contacts.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

struct Found {
    std::span<Contact> contacts;
    bool& full;
    uint32_t count = 0;

    /// Coplanar neighbours share one plane if they agree to the last bits, and only then: a neighbour seen
    /// from beside its edge may lean by 1e-8, and a leaning plane must be kept as a plane of its own or it
    /// blocks unseen.
    [[gnu::always_inline]] void add(const glm::dvec3& normal, const glm::dvec3& point, double gap, int object,
                                    FeatureId feature, uint32_t candidate) noexcept {
        bool known = false;
        for (uint32_t k = 0; k < count && !known; ++k) {
            const Contact& other = contacts[k];
            const glm::dvec3 lean = other.normal - normal;
            known = glm::dot(lean, lean) < 1e-30 && std::abs(other.gap - gap) < 0.25 * kContactGap;
        }
        if (known)
            return;
        if (count == contacts.size()) {
            full = true;
            return;
        }
        contacts[count++] = {normal, point, gap, object, feature, candidate};
    }
};

template <bool OneSided, class Visitor>
[[gnu::always_inline]] inline void visitTriangles(CandidateCache& cache, const glm::dvec3& p, double radius,
                                                  double within, Visitor& found) noexcept {
    const double reach = radius + within;
    cache.eachNear(p, reach, [&](size_t i) {
        const TriangleDistance d = cache.measure(i, p);
        if (d.distance > reach)
            return;
        if constexpr (OneSided)
            if (cache.passes(i, p, d.distance, radius))
                return;
        found.add(d.gradient, d.closest, d.distance - radius, cache.item(i).object, cache.item(i).index,
                  static_cast<uint32_t>(i));
    });
}

/// Out of line: code that a scene may not need must not take registers from code that it needs.
[[gnu::noinline]] void addOneSidedTriangles(CandidateCache& cache, const glm::dvec3& p, double radius,
                                            double within, Found& found) noexcept {
    visitTriangles<true>(cache, p, radius, within, found);
}

template <class Visitor>
bool visitShapes(const NearShapes& shapes, const glm::dvec3& p, double radius, double within,
                 Visitor& found) noexcept {
    return shapes.eachNear(p, radius + within, [&](int object, const FeatureDistance& d) {
        found.add(d.gradient, d.closest, d.distance - radius, object, d.feature, Contact::kNoCandidate);
    });
}

[[gnu::noinline]] void addShapes(const NearShapes& shapes, const glm::dvec3& p, double radius, double within,
                                 Found& found) noexcept {
    found.full |= !visitShapes(shapes, p, radius, within, found);
}

struct Broken {
    glm::dvec3 to;
    double most; ///< by which the plane of `contact` is broken, or what counts as none
    std::optional<Contact> contact{};

    void add(const glm::dvec3& normal, const glm::dvec3& point, double gap, int object, FeatureId feature,
             uint32_t candidate) noexcept {
        const double by = planeOffset(gap) - glm::dot(normal, to);
        if (by > most) {
            most = by;
            contact = Contact{normal, point, gap, object, feature, candidate};
        }
    }
};

/// A goal nearer to the triangle than this has no direction from it, object units.
constexpr double kNoDirection = 1e-9;
/// Cosine of the largest roll: the path over the corner is then no longer than 1.16 times the arc.
constexpr double kFarthestRoll = 0.5;
constexpr double kNearestRoll = 1.0 - 1e-9;

} // namespace

uint32_t findContacts(CandidateCache& cache, const glm::dvec3& p, double radius, double within,
                      std::span<Contact> contacts, bool& full) noexcept {
    Found found{contacts, full};
    if (cache.anyOneSided())
        addOneSidedTriangles(cache, p, radius, within, found);
    else
        visitTriangles<false>(cache, p, radius, within, found);
    if (!cache.shapes().empty())
        addShapes(cache.shapes(), p, radius, within, found);
    return found.count;
}

std::optional<Contact> mostBroken(CandidateCache& cache, const glm::dvec3& p, double radius, double within,
                                  const glm::dvec3& to, double tolerance, bool& all) noexcept {
    Broken broken{to, tolerance};
    if (cache.anyOneSided())
        visitTriangles<true>(cache, p, radius, within, broken);
    else
        visitTriangles<false>(cache, p, radius, within, broken);
    all &= visitShapes(cache.shapes(), p, radius, within, broken);
    return broken.contact;
}

double nearestDistance(CandidateCache& cache, const glm::dvec3& p, double reach, double radius) noexcept {
    double nearest = cache.shapes().empty() ? INFINITY : cache.shapes().nearest(p, reach);
    cache.eachNear(p, reach, [&](size_t i) {
        const double distance = distanceTo(cache.triangle(i), p).distance;
        if (distance <= reach && !cache.passes(i, p, distance, radius))
            nearest = std::min(nearest, distance);
    });
    return nearest;
}

double distanceOf(CandidateCache& cache, const Contact& contact, const glm::dvec3& p) noexcept {
    return contact.candidate < cache.count() ? distanceTo(cache.triangle(contact.candidate), p).distance
                                             : INFINITY;
}

bool moveOnFacet(CandidateCache& cache, const glm::dvec3& place, double radius, Contact& contact) noexcept {
    if (contact.candidate >= cache.count())
        return false;
    const TriangleDistance there = distanceTo(cache.triangle(contact.candidate), place);
    if (!there.face || there.distance > radius + kContactReach)
        return false;
    contact.point = there.closest;
    contact.gap = there.distance - radius;
    return true;
}

std::optional<RollOver> rollOver(CandidateCache& cache, const Contact& contact, const glm::dvec3& start,
                                 const glm::dvec3& goal, double reach) noexcept {
    size_t held = 0;
    while (held < cache.count() &&
           (cache.item(held).index != contact.feature || cache.item(held).object != contact.object))
        ++held;
    if (held == cache.count())
        return {};
    const TriangleDistance out = distanceTo(cache.triangle(held), goal);
    const double cosine = glm::dot(out.gradient, contact.normal);
    if (out.distance >= reach || out.distance < kNoDirection || cosine < kFarthestRoll ||
        cosine > kNearestRoll)
        return {};
    const glm::dvec3 end = out.closest + reach * out.gradient;
    if (glm::length(end - goal) >= glm::length(start - goal))
        return {};
    // Along the tangent plane at the start, up to the one at the end.
    const glm::dvec3 along = out.gradient - cosine * contact.normal;
    return RollOver{start + glm::dot(end - start, out.gradient) / glm::dot(along, out.gradient) * along, end};
}

} // namespace touchstone
