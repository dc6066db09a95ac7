// What the proxy solver knows of its surroundings: the triangles and shapes within a ball, gathered again
// where a move leaves it.

#include "haptics/proxy/proxy_solver.h"
#include "haptics/settings/tick_flags.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Smaller balls are not worth gathering; the largest reaches beyond any object.
constexpr double kSmallestMargin = 1e-7;
constexpr double kLargestMargin = 4.0;
/// The margin shrinks above and grows below these candidate counts.
constexpr size_t kManyCandidates = 20;
constexpr size_t kFewCandidates = 4;
/// Distance of a new ball's centre ahead of the hand, in margins: it holds for 1.7 of them straight ahead,
/// 0.7 sideways, 0.3 back.
constexpr double kAhead = 0.7;
/// The smallest margin, in ways of the hand in this tick: straight ahead the ball holds for one of them.
/// (Balls for two hold twice as many triangles, of which each move tests all: 15 % more time at 1 m/s over
/// a million triangles.)
constexpr double kLasting = 0.6;
/// Gathers of a tick after which a ball that does not hold for the move lies ahead of the move: a proxy that
/// catches up sideways would use up its budget on balls ahead of the hand. (The first two balls of a tick
/// mostly serve the next one, too: with these ahead of the move ticks at 1 m/s take a fifth more time.)
constexpr int kCatchingUp = 3;
/// The same in reaches of the proxy: the ball's area is that of reach and margin together, and a smaller
/// margin only makes gathers more frequent.
constexpr double kShell = 0.3;
/// But a thinner shell where it holds more candidates than about this. A resting proxy is empty, so that
/// their number mostly grows as the margin does: over a dense mesh a shell of 0.3 reaches holds thousands,
/// and the moves of one tick may gather it twenty times. (ToyCar in the workspace, radius 6 mm: p99 of a
/// tick 2.8 ms without this bound, 0.60, 0.65 and 0.67 ms with 64, 128 and 256.)
constexpr double kShellCandidates = 128.0;
/// The smallest margin, too, as a share of the move divided by the budget of moves: a hand at rest on a
/// vertex, whose facets are in every ball, has shrunk the margin to nothing, and an obstacle that goes away
/// frees the proxy without a way of the hand.
constexpr double kCatchUp = 0.25;
/// A margin grows by no more than keeps twice the candidates within the capacity, by area; but by a half at
/// least, since a vertex of thousands of facets has them in the smaller ball, too.
constexpr double kFastestGrowth = 4.0, kSlowestGrowth = 1.5;
/// Where the ball after a new one is expected, in its margins from its centre, and how much larger: the way
/// is not quite straight.
constexpr double kNextBall = 2.5, kNextSize = 1.1;

} // namespace

/// Centre of a ball of this margin for a move along `direction`, of which it should hold for `wanted`.
glm::dvec3 ProxySolver::ballAhead(const glm::dvec3& direction, double wanted, double margin) noexcept {
    const glm::dvec3 ahead = kAhead * margin * heading_;
    const bool catchesUp =
        ++gathers_ > kCatchingUp && CandidateCache::wayInBall(-ahead, direction, margin) < wanted;
    return state_.proxy + (catchesUp ? kAhead * margin * direction : ahead);
}

bool ProxySolver::gather(CandidateCache& cache, const glm::dvec3& centre, double radius) noexcept {
    const auto within = [&](auto bounds) {
        return cache.gather(scene_.objects, motions_, bounds, state_.reference, centre, radius,
                            &cache == &state_.candidates ? CandidateCache::Frame::Same
                                                         : CandidateCache::Frame::Another);
    };
    return motions_.data() == scene_.restMotions.data()
               ? within(std::span<const glm::dvec4>(scene_.restSpheres))
               : within(std::span<const double>(scene_.boundingRadii));
}

/// Gathers all triangles that a proxy moving by `length` along `direction` could touch, or within the HIP's
/// travel in this tick if that is less: a long move that a near surface ends must not gather what lies behind
/// it. Returns the covered distance; negative if not even the place itself can be covered.
double ProxySolver::cover(const glm::dvec3& direction, double length) noexcept {
    if (length > 0.0)
        asked_ = length;
    const double reach = radius_ + kContactReach;
    const double wanted = std::min(length, std::max(travel_, 0.1 * state_.gatherMargin));
    const auto way = [this] { return std::max(kLasting * travel_, kCatchUp * asked_ / budget_); };
    // A ball gathered in free motion may hold thousands of triangles, of little use after contact.
    const double ball = state_.candidates.radius();
    const bool crowded = state_.candidates.count() > 4 * kManyCandidates && ball > 4.0 * (reach + way());
    if (crowded) {
        state_.gatherMargin = 0.25 * ball;
    } else {
        const double known = state_.candidates.freeAlong(state_.proxy, direction, reach);
        if (known >= wanted)
            return known;
    }
    constexpr int kAttempts = 16;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
        const double margin = state_.gatherMargin;
        // Ahead, where the ball stays valid for longer.
        const glm::dvec3 centre = ballAhead(direction, wanted, margin);
        state_.candidates.expect(centre + kNextBall * margin * heading_, kNextSize * (reach + margin));
        const bool fits = gather(state_.candidates, centre, reach + margin);
        const size_t count = state_.candidates.count();
        double next = margin;
        if (!fits)
            next = 0.25 * margin;
        else if (count > kManyCandidates)
            next = 0.5 * margin;
        else if (count == 0)
            next = 4.0 * margin;
        else if (count < kFewCandidates)
            next = 1.5 * margin;
        // However dense the mesh, a smaller ball costs more than it saves. A hand at rest has shrunk it to
        // nothing: it must grow again, or the proxy would creep.
        const auto candidates = static_cast<double>(std::max(count, size_t{1}));
        const double growth = std::clamp(std::sqrt(0.5 * CandidateCache::kCapacity / candidates),
                                         kSlowestGrowth, kFastestGrowth);
        const double shell = std::min(kShell * reach, kShellCandidates / candidates * margin);
        const double lasting = fits ? std::min(std::max(way(), shell), growth * margin) : 0.0;
        const double least = std::min(std::max(kSmallestMargin, lasting), kLargestMargin);
        state_.gatherMargin = std::clamp(next, least, kLargestMargin);
        if (fits)
            return state_.candidates.freeAlong(state_.proxy, direction, reach);
    }
    rest_.flags = rest_.flags | TickFlag::CandidatesFull;
    return -1.0;
}

} // namespace touchstone
