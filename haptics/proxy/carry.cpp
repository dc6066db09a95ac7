#include "haptics/proxy/carry.h"

#include "haptics/contact/sweep.h"
#include "haptics/proxy/mesh_proxy.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// Share of `move` (frame of `object`, from `from`) that is free of that one object; at most `limit`. A
/// stretch with too many triangles is halved; after the last halving the object counts as touched, which is
/// safe.
double sweepObject(const HapticScene& scene, ObjectMotions motions, DeviceState& state, size_t object,
                   const glm::dvec3& from, const glm::dvec3& move, double reach, double limit) noexcept {
    constexpr int kPieces = 64;
    CandidateCache& cache = state.carryCandidates;
    const double length = glm::length(move);
    double done = 0.0, piece = limit;
    for (int i = 0; i < kPieces && done < limit; ++i) {
        const glm::dvec3 start = from + done * move;
        const double ball = 0.5 * piece * length + reach + kContactReach;
        if (!cache.gather({&scene.objects[object], 1}, motions.subspan(object, 1), 0,
                          start + 0.5 * piece * move, ball)) {
            piece *= 0.5;
            continue;
        }
        cache.moved();
        const double first = freeShare(cache, start, move, reach, piece);
        if (first < piece)
            return done + first;
        done += piece;
        piece = std::min(piece, limit - done);
    }
    return std::min(done, limit);
}

} // namespace

void carryProxy(const HapticScene& scene, ObjectMotions motions, double radius, DeviceState& state) noexcept {
    // With one object the anchor's own motion is the whole relative motion, and moveTowards sweeps it.
    if (scene.objects.size() < 2 || motions.data() == scene.restMotions.data())
        return;
    state.candidates.invalidate();
    const ObjectMotion anchor = motions[static_cast<size_t>(state.anchor)];
    const glm::dvec3 before = anchor.before.point(state.proxy),
                     now = anchor.workspaceFromObject.point(state.proxy);
    // The proxy is as large as its anchor makes it. Were it swept with the other object's larger skin, it
    // would stand within that from the start, and a rounding would let the surface it slides on strike it out
    // of the hold of the wall that pushes it.
    const double size =
        std::max(radius, 0.5 * kWeldTolerance * scene.objects[static_cast<size_t>(state.anchor)]->diagonal *
                             anchor.workspaceFromObject.scale);
    int struck = -1;
    double first = 1.0;
    glm::dvec3 place(0.0);
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        if (static_cast<int>(k) == state.anchor)
            continue;
        const HapticObject& object = *scene.objects[k];
        const glm::dvec3 from = motions[k].before.inversePoint(before);
        const glm::dvec3 to = motions[k].workspaceFromObject.inversePoint(now);
        const glm::dvec3 move = to - from;
        const double length = glm::length(move);
        const double scale = motions[k].workspaceFromObject.scale;
        const double reach = size / scale + kContactGap;
        if (length <= kRestLength)
            continue;
        const double nearest = std::min(glm::length(from), glm::length(to)) - length;
        if (nearest > object.boundingRadius + reach)
            continue;
        // The object alone, in its own frame, from the old place to the new one.
        const double share = sweepObject(scene, motions, state, k, from, move, reach, first);
        if (share < first) {
            first = share;
            struck = static_cast<int>(k);
            place = from + share * move;
        }
    }
    if (struck < 0)
        return;
    changeAnchor(state, motions, struck);
    state.proxy = place;
}

} // namespace touchstone
