#include "study/truth/brute_force.h"

#include <cmath>

namespace touchstone::truth {

namespace {

LVec3 nearestOnSegment(const LVec3& p, const LVec3& a, const LVec3& b) {
    const LVec3 ab = b - a;
    const long double squared = glm::dot(ab, ab);
    if (!(squared > 0.0L))
        return a;
    const long double t = glm::dot(p - a, ab) / squared;
    return a + std::min(1.0L, std::max(0.0L, t)) * ab;
}

/// Whether the box around the triangle is farther away than `reach`, by more than distanceFrom may round: its
/// normal of a sliver is good to a part of the triangle's size only.
bool isBeyond(const Corners& corners, const LVec3& p, long double reach) {
    const LVec3 low = glm::min(glm::min(corners.a, corners.b), corners.c),
                high = glm::max(glm::max(corners.a, corners.b), corners.c);
    const LVec3 away = glm::max(glm::max(low - p, p - high), LVec3(0.0L));
    const long double sure = reach + 1e-6L * (reach + glm::length(high - low));
    return glm::dot(away, away) > sure * sure;
}

Corners cornersOf(const HapticObject& object, size_t t) {
    return {LVec3(object.vertices[object.indices[3 * t]]), LVec3(object.vertices[object.indices[3 * t + 1]]),
            LVec3(object.vertices[object.indices[3 * t + 2]])};
}

} // namespace

BruteContact distanceFrom(const Corners& corners, const LVec3& p) {
    const LVec3 &a = corners.a, &b = corners.b, &c = corners.c;
    const LVec3 area = glm::cross(b - a, c - a);
    const long double squared = glm::dot(area, area);
    BruteContact contact;
    if (squared > 0.0L) {
        const LVec3 n = area / std::sqrt(squared);
        const bool inside = glm::dot(glm::cross(b - a, p - a), n) > 0.0L &&
                            glm::dot(glm::cross(c - b, p - b), n) > 0.0L &&
                            glm::dot(glm::cross(a - c, p - c), n) > 0.0L;
        if (inside) {
            const long double height = glm::dot(p - a, n);
            contact.distance = std::abs(height);
            contact.normal = height >= 0.0L ? n : -n;
            return contact;
        }
    }
    long double best = INFINITY;
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}, {c, a}}) {
        const LVec3 away = p - nearestOnSegment(p, from, to);
        const long double s = glm::dot(away, away);
        if (s < best) {
            best = s;
            contact.normal = away;
        }
    }
    contact.distance = std::sqrt(best);
    if (contact.distance > 0.0L)
        contact.normal /= contact.distance;
    return contact;
}

BruteContact bruteNearest(const HapticObject& object, const LVec3& p) {
    BruteContact nearest;
    nearest.distance = INFINITY;
    for (size_t t = 0; t < object.triangleCount(); ++t) {
        const Corners corners = cornersOf(object, t);
        if (isBeyond(corners, p, nearest.distance))
            continue;
        BruteContact contact = distanceFrom(corners, p);
        contact.triangle = t;
        if (contact.distance < nearest.distance)
            nearest = contact;
    }
    return nearest;
}

std::vector<BruteContact> bruteWithin(const HapticObject& object, const LVec3& p, long double reach) {
    std::vector<BruteContact> contacts;
    for (size_t t = 0; t < object.triangleCount(); ++t) {
        const Corners corners = cornersOf(object, t);
        if (isBeyond(corners, p, reach))
            continue;
        BruteContact contact = distanceFrom(corners, p);
        contact.triangle = t;
        if (contact.distance <= reach)
            contacts.push_back(contact);
    }
    return contacts;
}

} // namespace touchstone::truth
