#include "haptics/contact/sweep.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Most moves need one or two steps at each triangle. Stopping early is safe.
constexpr uint32_t kSteps = 40;
/// Below this approach speed (object units per move length) rounding decides; the surface is not approached.
constexpr double kParallel = 1e-13;
/// A gap that counts as touch, object units.
constexpr double kTouch = 1e-13;

/// Time at which p + t * move comes within `reach` of the half-plane that holds the triangle and ends where
/// the triangle is nearest to p. The triangle cannot be touched earlier, and is touched exactly then while
/// the nearest feature stays the same: a slab, then the half cylinder around the half-plane's edge. (A
/// tangent plane alone, Newton's method, halves the distance in each step where the proxy grazes an edge, as
/// it does wherever it crosses from facet to facet: fifteen to twenty evaluations in a tick instead of
/// seven.)
double timeToHalfPlane(const Triangle& triangle, const TriangleDistance& here, const glm::dvec3& p,
                       const glm::dvec3& move, double reach, double rate) {
    const double gap = here.distance - reach;
    const double newton = gap / -rate;
    const glm::dvec3 away = p - here.closest;
    const double height = glm::dot(triangle.normal, away), sink = glm::dot(triangle.normal, move);
    const glm::dvec3 out = away - height * triangle.normal;
    const double outside = glm::length(out);
    if (here.face || triangle.normal == glm::dvec3(0.0) || outside == 0.0)
        return newton;
    // Around the edge: |outside + t drift, height + t sink| = reach; the earlier root.
    const double drift = glm::dot(out, move) / outside;
    const double a = drift * drift + sink * sink;
    const double b = outside * drift + height * sink;
    const double c = gap * (here.distance + reach);
    const double discriminant = b * b - a * c;
    if (b < 0.0 && discriminant >= 0.0) {
        const double t = c / (-b + std::sqrt(discriminant));
        if (outside + t * drift >= 0.0)
            return t;
    }
    // Past the edge and over the plane.
    const double above = std::abs(height), closing = height >= 0.0 ? -sink : sink;
    if (drift >= 0.0 || closing <= 0.0)
        return INFINITY;
    return std::max(newton, (above - reach) / closing);
}

// A triangle is convex, so its distance along a straight move is a convex function of time, and steps that
// end where a convex set around it is touched never overstep the first touch. The triangle with the earliest
// next step is advanced first; when it touches, every other one touches later, however far its own steps have
// come.
template <bool OneSided>
[[gnu::always_inline]] inline double firstTouch(CandidateCache& cache, const glm::dvec3& p,
                                                const glm::dvec3& move, double reach, double limit) noexcept {
    const std::span<CandidateCache::Approach> all = cache.approaching(p, move, limit, reach);
    size_t left = all.size(), later = 0;
    const double parallel = kParallel * glm::length(move);
    while (left > 0) {
        // All before `later` come after the start of the move. One at the start is the earliest and needs no
        // search. A proxy that comes through one-sided triangles passes thousands of them there: a search for
        // each takes quadratic time.
        while (later < left && all[later].time > 0.0)
            ++later;
        size_t next = later;
        if (later >= left) {
            next = 0;
            for (size_t i = 1; i < left; ++i)
                if (all[i].time < all[next].time)
                    next = i;
        }
        CandidateCache::Approach& approach = all[next];
        const double time = approach.time;
        if (time >= limit)
            return limit;
        const TriangleDistance here = time > 0.0 ? cache.measureAhead(approach.index, p + time * move)
                                                 : cache.measure(approach.index, p);
        // One-sided triangles are tested where the move begins; any that is not reached at once is clear
        // there.
        if constexpr (OneSided) {
            if (approach.steps == 0 &&
                cache.passes(approach.index, p, time > 0.0 ? INFINITY : here.distance, reach)) {
                approach = all[--left];
                continue;
            }
        }
        const double rate = glm::dot(here.gradient, move);
        const double gap = here.distance - reach;
        if (rate >= -parallel) {
            approach = all[--left];
            continue;
        }
        if (gap <= kTouch || ++approach.steps > kSteps)
            return time;
        approach.time =
            time + timeToHalfPlane(cache.triangle(approach.index), here, p + time * move, move, reach, rate);
    }
    return limit;
}

/// Out of line: code that a scene may not need must not take registers from code that it needs.
[[gnu::noinline]] double firstTouchOneSided(CandidateCache& cache, const glm::dvec3& p,
                                            const glm::dvec3& move, double reach, double limit) noexcept {
    return firstTouch<true>(cache, p, move, reach, limit);
}

} // namespace

double timeOfImpact(CandidateCache& cache, const glm::dvec3& p, const glm::dvec3& move, double reach,
                    double limit) noexcept {
    const double free = cache.anyOneSided() ? firstTouchOneSided(cache, p, move, reach, limit)
                                            : firstTouch<false>(cache, p, move, reach, limit);
    return cache.shapes().empty() ? free : cache.shapes().sweep(p, move, reach, free);
}

} // namespace touchstone
