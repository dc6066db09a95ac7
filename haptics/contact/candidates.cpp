#include "haptics/contact/candidates.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace touchstone {

CandidateCache::CandidateCache()
    : items_(kCapacity), bounds_(kCapacity / kBlock), approaches_(kCapacity), found_(kCapacity),
      turns_(kCapacity), pool_(kCapacity + kMaxKept), free_(pool_.size() + 1), freeCount_(pool_.size()) {
    for (size_t i = 0; i < pool_.size(); ++i)
        free_[i] = static_cast<uint32_t>(pool_.size() - 1 - i);
}

void CandidateCache::prepare(Candidate& item) noexcept {
    item.prepared = free_[--freeCount_];
    Prepared& made = pool_[item.prepared];
    made.triangle = triangleAt(*item.source, item.place, item.index);
    if (item.turn != Candidate::kInPlace) [[unlikely]] {
        const Similarity& turn = turns_[item.turn];
        made.triangle =
            Triangle(turn.point(made.triangle.a), turn.point(made.triangle.b), turn.point(made.triangle.c));
    }
    made.at = glm::dvec3(NAN);
}

// Which triangles a ball has prepared, and which of those the next one finds again, follows no pattern that a
// processor could predict: what counts is written in any case, beyond the end where it does not count.

/// Sets aside what this ball has prepared; the pool has room for that and for a full ball.
void CandidateCache::keepPrepared() noexcept {
    keptCount_ = 0;
    for (size_t i = 0; i < count_; ++i) {
        const Candidate& item = items_[i];
        const bool known = item.prepared != Candidate::kUnprepared;
        if (keptCount_ == kMaxKept) [[unlikely]] {
            release(item.prepared);
            continue;
        }
        const size_t slot = known ? keptSlot(item.object, item.index) : keptAt_.size() - 1;
        keptAt_[slot] = static_cast<uint16_t>(keptCount_);
        kept_[keptCount_] = {item.object, item.index, item.prepared};
        keptCount_ += known ? 1 : 0;
    }
}

void CandidateCache::releaseKept() noexcept {
    for (size_t k = 0; k < keptCount_; ++k) {
        free_[freeCount_] = kept_[k].prepared;
        freeCount_ += kept_[k].prepared != Candidate::kUnprepared ? 1 : 0;
    }
    keptCount_ = 0;
}

/// What the ball before has prepared of a triangle; kUnprepared: nothing.
uint32_t CandidateCache::takeKept(int object, uint32_t index) noexcept {
    const size_t k = keptAt_[keptSlot(object, index)];
    Kept& kept = kept_[k];
    const uint32_t known = kept.prepared;
    const bool same = (k < keptCount_) & (kept.index == index) & (kept.object == object);
    kept.prepared = same ? Candidate::kUnprepared : known;
    return same ? known : Candidate::kUnprepared;
}

bool CandidateCache::gatherObject(const HapticObject& object, int index,
                                  const Similarity* objectFromReference, const glm::dvec3& centre,
                                  double radius) noexcept {
    const bool foreign = objectFromReference != nullptr;
    const double scale = foreign ? objectFromReference->scale : 1.0;
    const glm::dvec3 local = foreign ? objectFromReference->point(centre) : centre;
    const double localRadius = scale * radius;
    // The search works in float on vertices of magnitude one: widen the ball by more than their rounding.
    const double rounding = 4e-7 * (1.0 + glm::length(local));
    const std::span<TriangleTree::Near> found(found_.data(), kCapacity - count_);
    const glm::vec3 about(local);
    const auto within = static_cast<float>(localRadius + rounding);
    const bool looksAhead = !foreign && object.instant == nullptr && ahead_.radius > 0.0f;
    if (looksAhead)
        aheadOf_ = &object.tree;
    const size_t near = looksAhead ? object.tree.collect(about, within, found, ahead_)
                                   : treeOf(object).collect(about, within, found);
    if (near == found.size())
        return false;
    // The float gradient of a box is good to 1e-6 of the ball.
    const double doubt = rounding + static_cast<double>(TriangleTree::kDoubt) + 2e-6 * localRadius;
    oneSided_ |= object.oneSided;
    const size_t before = count_;
    for (const TriangleTree::Near& n : found.first(near)) {
        Candidate& item = items_[count_];
        item.source = &object;
        item.object = index;
        item.index = n.triangle;
        item.place = n.place;
        item.measured = 0;
        item.turn = foreign ? static_cast<uint32_t>(turnCount_) : Candidate::kInPlace;
        item.prepared = keptCount_ > 0 ? takeKept(index, n.triangle) : Candidate::kUnprepared;
        retaken_[retakenCount_] = static_cast<uint16_t>(count_);
        retakenCount_ += item.prepared != Candidate::kUnprepared ? 1 : 0;
        const auto distance = static_cast<double>(n.distance);
        setBound(count_, local, distance - doubt, glm::dvec3(n.away) * (1.0 / std::max(distance, 1e-30)));
        ++count_;
    }
    if (foreign && near > 0) {
        turns_[turnCount_] = objectFromReference->inverse();
        turnBounds(before, turns_[turnCount_++]);
    }
    return true;
}

/// Transforms the bounds from `first` on from their own object's frame into the reference object frame; a
/// triangle is turned when it is prepared.
void CandidateCache::turnBounds(size_t first, const Similarity& referenceFromObject) noexcept {
    for (size_t i = first; i < count_; ++i) {
        // distance >= offset + g . p, with p in the reference object frame.
        Block& block = bounds_[i / kBlock];
        const size_t k = i % kBlock;
        const glm::dvec3 gradient =
            referenceFromObject.direction(glm::dvec3(block.x[k], block.y[k], block.z[k]));
        const double scaled = referenceFromObject.scale * block.offset[k];
        block.x[k] = gradient.x;
        block.y[k] = gradient.y;
        block.z[k] = gradient.z;
        block.offset[k] = scaled - glm::dot(gradient, referenceFromObject.translation);
    }
}

/// Bounds of evaluations in place of those of boxes, which are farther from the surface.
void CandidateCache::takeKeptBounds() noexcept {
    const double far = 4.0 * radius_ * radius_;
    for (const size_t i : std::span(retaken_).first(retakenCount_)) {
        Prepared& known = pool_[items_[i].prepared];
        const glm::dvec3 way = known.at - centre_;
        if (glm::dot(way, way) <= far)
            setBound(i, known.at, known.last.distance, known.last.gradient);
        else
            known.at = glm::dvec3(NAN); // its bound is the box's
    }
}

bool CandidateCache::gather(std::span<const std::shared_ptr<const HapticObject>> objects, ObjectMotions poses,
                            std::span<const glm::dvec4> spheres, int reference, const glm::dvec3& centre,
                            double radius, Frame frame) noexcept {
    return gatherAll(
        objects, poses, [&](size_t k) { return spheres[k]; }, reference, centre, radius, frame);
}

bool CandidateCache::gather(std::span<const std::shared_ptr<const HapticObject>> objects, ObjectMotions poses,
                            std::span<const double> radii, int reference, const glm::dvec3& centre,
                            double radius, Frame frame) noexcept {
    const auto sphereOf = [&](size_t k) {
        const Similarity& pose = poses[k].workspaceFromObject;
        return glm::dvec4(pose.translation, pose.scale * radii[k]);
    };
    return gatherAll(objects, poses, sphereOf, reference, centre, radius, frame);
}

/// `sphereOf(k)` reads nothing of the object itself: of a thousand objects, most are far from the hand and
/// far apart in memory.
template <class SphereOf>
bool CandidateCache::gatherAll(std::span<const std::shared_ptr<const HapticObject>> objects,
                               ObjectMotions poses, const SphereOf& sphereOf, int reference,
                               const glm::dvec3& centre, double radius, Frame frame) noexcept {
    if (valid_ && frame == Frame::Same) {
        keepPrepared();
        clear();
    } else {
        invalidate();
    }
    ahead_.count = 0;
    retakenCount_ = 0;
    oneSided_ = false;
    centre_ = centre;
    radius_ = radius;
    const Similarity& workspaceFromReference = poses[static_cast<size_t>(reference)].workspaceFromObject;
    const glm::dvec3 place = workspaceFromReference.point(centre);
    // A fraction more than double rounds at the far end of a scene.
    const double room = workspaceFromReference.scale * radius + 1e-14 * glm::length(place);
    for (size_t k = 0; k < objects.size(); ++k) {
        const glm::dvec4 sphere = sphereOf(k);
        const glm::dvec3 apart = place - glm::dvec3(sphere);
        const double touching = sphere.w + room;
        if (glm::dot(apart, apart) > touching * touching)
            continue;
        const int index = static_cast<int>(k);
        const auto end = ignored_.begin() + static_cast<std::ptrdiff_t>(ignoredCount_);
        if (std::find(ignored_.begin(), end, index) != end)
            continue;
        bool fits = true;
        const auto gatherFrom = [&](const Similarity* objectFromReference) {
            if (objects[k]->shape != nullptr)
                return shapes_.add(*objects[k]->shape, index, objectFromReference, centre, radius);
            return gatherObject(*objects[k], index, objectFromReference, centre, radius);
        };
        if (index == reference) {
            fits = gatherFrom(nullptr);
        } else {
            const Similarity objectFromReference =
                poses[k].workspaceFromObject.inverseTimes(workspaceFromReference);
            fits = gatherFrom(&objectFromReference);
        }
        if (!fits) {
            releaseKept();
            invalidate();
            return false;
        }
    }
    releaseKept();
    takeKeptBounds();
    for (size_t i = count_; i % kBlock != 0; ++i)
        setBound(i, glm::dvec3(0.0), INFINITY, glm::dvec3(0.0));
    valid_ = true;
    return true;
}

bool CandidateCache::passesOneSided(size_t i, const glm::dvec3& p, double distance, double reach) noexcept {
    const Triangle& t = triangle(i);
    const double height = glm::dot(t.normal, p - t.a), clear = std::min(reach, standing_) - kNotClear;
    if (!(height > 0.0) || distance < clear)
        return true;
    // A proxy straight above a triangle stands on it, whatever else it is coming through.
    return height < clear && comesThrough(items_[i].object, p, clear);
}

/// True if p is nearer than `clear` to a triangle of the object. Thousands of triangles may ask this at one
/// place, and get one answer.
bool CandidateCache::comesThrough(int object, const glm::dvec3& p, double clear) noexcept {
    if (coming_.object == object && coming_.place == p && coming_.clear == clear)
        return coming_.through;
    bool through = false;
    eachNear(p, clear, [&](size_t k) {
        through = through || (items_[k].object == object && distanceTo(triangle(k), p).distance < clear);
    });
    coming_ = {.object = object, .through = through, .clear = clear, .place = p};
    return through;
}

double CandidateCache::clearanceAt(const glm::dvec3& p, double reach) noexcept {
    double least = reach;
    eachNear(p, reach, [&](size_t i) {
        const double distance = distanceTo(triangle(i), p).distance;
        if (items_[i].source->oneSided && distance < least && !passesOneSided(i, p, distance, reach))
            least = distance;
    });
    return least;
}

std::span<CandidateCache::Approach> CandidateCache::approaching(const glm::dvec3& p, const glm::dvec3& move,
                                                                double limit, double reach) noexcept {
    const double doubt = uncertainty();
    size_t found = 0;
    for (size_t first = 0; first < count_; first += kBlock) {
        const Block& block = bounds_[first / kBlock];
        alignas(32) std::array<double, kBlock> gap, rate;
        uint32_t reached = 0;
        for (size_t half = 0; half < kBlock; half += 4) {
            const Double4 gaps = block.least(half, p) - reach, rates = block.along(half, move),
                          ways = limit * rates, zero{};
            reached |= bitsOf(~(gaps + (ways < zero ? ways : zero) > doubt)) << half;
            std::memcpy(&gap[half], &gaps, sizeof gaps);
            std::memcpy(&rate[half], &rates, sizeof rates);
        }
        for (; reached != 0; reached &= reached - 1) {
            const auto k = static_cast<size_t>(std::countr_zero(reached));
            // A bound that was evaluated at p is exact there.
            const auto i = static_cast<uint32_t>(first + k);
            const bool here = items_[i].measured == place_;
            if (here && rate[k] >= 0.0)
                continue;
            const double free = here ? gap[k] : gap[k] - doubt;
            approaches_[found++] = {.time = free > 0.0 ? free / -rate[k] : 0.0, .index = i, .steps = 0};
        }
    }
    return {approaches_.data(), found};
}

} // namespace touchstone
