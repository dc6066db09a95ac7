#include "haptics/contact/sweep.h"

namespace touchstone {

namespace {

/// Quadratic for a crossing, linear for a graze; hence the bound. Stopping early is safe.
constexpr uint32_t kNewtonSteps = 40;
/// Below this approach speed (object units per move length) rounding decides; the surface is not approached.
constexpr double kParallel = 1e-13;
/// A gap that counts as touch, object units.
constexpr double kTouch = 1e-13;

} // namespace

// A triangle is convex, so its distance along a straight move is a convex function of time, and Newton's
// method started before the first touch never oversteps it. The triangle whose next step is the earliest goes
// first; when that one touches, every other one touches later, wherever its own steps stand.
double freeShare(CandidateCache& cache, const glm::dvec3& p, const glm::dvec3& move, double reach,
                 double limit) noexcept {
    const std::span<CandidateCache::Approach> all = cache.approaching(p, move, limit, reach);
    size_t left = all.size();
    const double parallel = kParallel * glm::length(move);
    while (left > 0) {
        size_t next = 0;
        for (size_t i = 1; i < left; ++i)
            if (all[i].time < all[next].time)
                next = i;
        CandidateCache::Approach& approach = all[next];
        const double time = approach.time;
        if (time >= limit)
            return limit;
        const TriangleDistance here = time > 0.0 ? cache.measureAhead(approach.index, p + time * move)
                                                 : cache.measure(approach.index, p);
        const double rate = glm::dot(here.gradient, move);
        const double gap = here.distance - reach;
        if (rate >= -parallel) {
            approach = all[--left];
            continue;
        }
        if (gap <= kTouch || ++approach.steps > kNewtonSteps)
            return time;
        approach.time = time + gap / -rate;
    }
    return limit;
}

} // namespace touchstone
