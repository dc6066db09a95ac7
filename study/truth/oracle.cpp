#include "study/truth/oracle.h"

#include <algorithm>
#include <cmath>

namespace touchstone::truth {

namespace {

/// Two orders of magnitude finer than the solver under test in every respect.
constexpr long double kGap = 1e-14L;
constexpr long double kTouch = 3e-14L;
constexpr long double kStill = 1e-14L;
/// Rounding may reduce the gap by this much in one move.
constexpr long double kErosion = 1e-16L;

/// Nearest point to `target` in the cone of directions that no plane forbids (n . x >= 0), by enumeration of
/// all sets of up to three planes.
LVec3 nearestAllowed(const LVec3& target, const std::vector<LVec3>& n) {
    const auto allowed = [&](const LVec3& x) {
        for (const LVec3& normal : n)
            if (glm::dot(normal, x) < -1e-17L * (1.0L + glm::length(target)))
                return false;
        return true;
    };
    if (allowed(target))
        return target;
    LVec3 best(0.0L);
    long double least = glm::dot(target, target); // staying is always allowed
    const auto consider = [&](const LVec3& x) {
        const long double away = glm::dot(x - target, x - target);
        if (away < least && allowed(x)) {
            least = away;
            best = x;
        }
    };
    for (size_t i = 0; i < n.size(); ++i)
        consider(target - glm::dot(target, n[i]) * n[i]);
    for (size_t i = 0; i < n.size(); ++i)
        for (size_t k = i + 1; k < n.size(); ++k) {
            const LVec3 line = glm::cross(n[i], n[k]);
            const long double squared = glm::dot(line, line);
            if (squared > 1e-30L)
                consider(glm::dot(target, line) / squared * line);
        }
    return best; // with three independent planes only the corner is left, that is, staying
}

/// Time of impact of the sphere with one triangle along from + t * move, by bisection on the convex distance:
/// find the minimum distance, and if it is below `reach`, the crossing before it. A surface in contact
/// already stops the move only where that reduces the gap; the move does not enter it except for rounding.
long double touchTime(const Corners& triangle, const BruteContact& start, const LVec3& from,
                      const LVec3& move, long double radius, long double limit) {
    const auto distance = [&](long double t) { return distanceFrom(triangle, from + t * move).distance; };
    const long double reach = std::max(radius, std::min(radius + kGap, start.distance - kErosion));
    // The distance is convex: it never falls faster than at the start.
    const long double fall = glm::dot(start.normal, move);
    if (fall >= 0.0L || start.distance + limit * fall > reach)
        return limit;
    long double low = 0.0L, high = limit;
    for (int i = 0; i < 200 && high - low > 1e-19L; ++i) { // ternary search of the minimum
        const long double a = low + (high - low) / 3.0L, b = high - (high - low) / 3.0L;
        const long double atA = distance(a), atB = distance(b);
        (atA < atB ? high : low) = atA < atB ? b : a;
        if (std::min(atA, atB) < reach) { // any point beyond the crossing will do
            low = high = atA < atB ? a : b;
            break;
        }
    }
    const long double bottom = 0.5L * (low + high);
    if (distance(bottom) >= reach)
        return limit;
    low = 0.0L, high = bottom;
    for (int i = 0; i < 100; ++i) {
        const long double middle = 0.5L * (low + high);
        (distance(middle) >= reach ? low : high) = middle;
    }
    return low;
}

/// A triangle and a lower bound of its distance, so that far triangles are skipped in most moves.
struct Near {
    Corners corners;
    int oneSided = -1; ///< its object, if one-sided
    long double atLeast = 0.0L;
    bool there = true; ///< for the current move

    BruteContact look(const LVec3& p) {
        const BruteContact contact = distanceFrom(corners, p);
        atLeast = contact.distance;
        return contact;
    }
};

/// A one-sided surface is solid for a sphere in front of it and clear of it, unless the sphere comes through
/// another triangle of the same object while it is lower than its radius over this one's plane.
void tellWhatIsThere(std::vector<Near>& near, const LVec3& p, long double radius) {
    constexpr long double kNotClear = 1e-8L;
    std::vector<int> comingThrough;
    for (Near& t : near) {
        t.there = true;
        if (t.oneSided < 0)
            continue;
        const LVec3 normal = glm::cross(t.corners.b - t.corners.a, t.corners.c - t.corners.a);
        const long double height = glm::dot(p - t.corners.a, normal) / glm::length(normal);
        const bool clear = t.look(p).distance >= radius - kNotClear;
        if (!clear)
            comingThrough.push_back(t.oneSided);
        t.there = height > 0.0L && clear;
    }
    for (Near& t : near) {
        if (t.oneSided < 0 || !t.there ||
            std::find(comingThrough.begin(), comingThrough.end(), t.oneSided) == comingThrough.end())
            continue;
        const LVec3 normal = glm::cross(t.corners.b - t.corners.a, t.corners.c - t.corners.a);
        t.there = glm::dot(p - t.corners.a, normal) / glm::length(normal) >= radius - kNotClear;
    }
}

} // namespace

OracleRest oracleRest(const Soup& soup, const LVec3& from, const LVec3& goal, long double radius,
                      int maxMoves) {
    OracleRest rest;
    rest.proxy = from;
    // Only triangles that the move can meet: the proxy never leaves the ball around the goal through itself.
    const long double reach = glm::length(goal - from) + radius + kTouch;
    std::vector<Near> near;
    for (const size_t t : soup.near(goal, reach))
        near.push_back({soup.corners(t), soup.oneSided(t), 0.0L});
    const bool oneSided =
        std::any_of(near.begin(), near.end(), [](const Near& t) { return t.oneSided >= 0; });
    for (; rest.moves < maxMoves; ++rest.moves) {
        rest.touching.clear();
        if (oneSided)
            tellWhatIsThere(near, rest.proxy, radius);
        for (Near& t : near)
            if (t.there && t.atLeast <= radius + kTouch) {
                const BruteContact contact = t.look(rest.proxy);
                if (contact.distance <= radius + kTouch)
                    rest.touching.push_back(contact.normal);
            }
        const LVec3 move = nearestAllowed(goal - rest.proxy, rest.touching);
        const long double length = glm::length(move);
        if (length <= kStill) {
            rest.settled = true;
            return rest;
        }
        long double share = 1.0L;
        for (Near& t : near)
            if (t.there && t.atLeast <= radius + kGap + share * length)
                share = touchTime(t.corners, t.look(rest.proxy), rest.proxy, move, radius, share);
        if (share <= 0.0L)
            return rest;
        rest.proxy += share * move;
        for (Near& t : near)
            t.atLeast -= share * length + kErosion;
    }
    return rest;
}

long double restResidual(const std::vector<LVec3>& touching, const LVec3& proxy, const LVec3& goal) {
    return glm::length(nearestAllowed(goal - proxy, touching));
}

} // namespace touchstone::truth
