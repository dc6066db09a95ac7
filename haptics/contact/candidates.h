#pragma once
// The triangles and shapes near the proxy: gathered once, used by every move until the proxy leaves the ball.

#include "engine/math/object_motion.h"
#include "engine/math/similarity.h"
#include "haptics/shape/mesh/haptic_object.h"
#include "haptics/shape/mesh/triangle.h"
#include "haptics/shape/near_shapes.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

namespace touchstone {

/// One triangle near the proxy.
struct Candidate {
    static constexpr uint32_t kUnprepared = UINT32_MAX;
    static constexpr uint32_t kInPlace = UINT32_MAX;
    const HapticObject* source = nullptr;
    int object = -1;                 ///< HapticScene::objects
    uint32_t index = 0;              ///< triangle of that object
    uint32_t place = 0;              ///< of its corners, TriangleTree::Near::place
    uint32_t prepared = kUnprepared; ///< in CandidateCache::pool_
    uint32_t measured = 0;           ///< CandidateCache::place_ when its distance was last evaluated
    uint32_t turn = kInPlace;        ///< in CandidateCache::turns_; of the reference object: kInPlace
};

/// `items` holds every triangle that meets the ball (centre, radius), `shapes` every other shape; only these
/// can stop a proxy that stays in the ball. Preallocated; gather neither allocates nor throws.
///
/// The distance from a triangle is a convex function of the place, so each evaluation (d and gradient g at q)
/// bounds it from below everywhere: distance(p) >= d + g . (p - q). These half-spaces, stored side by side,
/// suffice for most triangles, wherever the proxy moves; only where one reaches up to the surface is the
/// distance evaluated again. The triangle's box supplies the first half-space.
///
/// The proxy touches few of a ball's triangles, and touches most of those again after the next gather: their
/// corners and their last evaluation are kept in a pool, so that a gather reads no vertex of a triangle that
/// it has kept and none is evaluated twice at one place.
class CandidateCache {
    /// A triangle in the frame of the reference object, object units, and its last evaluation.
    struct Prepared {
        Triangle triangle;
        TriangleDistance last;
        glm::dvec3 at{NAN}; ///< where; NaN: none
    };
    /// Half-spaces of eight triangles, for the vector unit; unused ones are far away.
    static constexpr size_t kBlock = 8;
    using Double4 [[gnu::vector_size(32)]] = double;
    struct alignas(64) Block {
        std::array<double, kBlock> x, y, z, offset;

        /// Of four half-spaces from `half` on, along a vector and at a place.
        [[nodiscard, gnu::always_inline]] Double4 along(size_t half, const glm::dvec3& v) const noexcept {
            return load(x, half) * v.x + load(y, half) * v.y + load(z, half) * v.z;
        }
        [[nodiscard, gnu::always_inline]] Double4 least(size_t half, const glm::dvec3& p) const noexcept {
            return along(half, p) + load(offset, half);
        }

      private:
        [[gnu::always_inline]] static Double4 load(const std::array<double, kBlock>& from,
                                                   size_t half) noexcept {
            Double4 result;
            std::memcpy(&result, &from[half], sizeof result);
            return result;
        }
    };
    /// Bit k: true in place k.
    template <class Comparison>
    [[gnu::always_inline]] static uint32_t bitsOf(Comparison comparison) noexcept {
        return static_cast<uint32_t>(__builtin_ia32_movmskpd256(reinterpret_cast<Double4>(comparison)));
    }

  public:
    /// Capacity for the densest neighbourhood in which the proxy still moves; beyond it the ball shrinks.
    static constexpr size_t kCapacity = 4096;

    /// Another: objects, poses or reference are not those of the gather before. Same: they are, so that what
    /// was computed of a triangle still holds.
    enum class Frame : uint8_t { Another, Same };

    CandidateCache();

    /// Gathers everything that meets the ball, in the frame of `reference`. False when there may be more than
    /// kCapacity triangles: the cache is then empty and invalid. `spheres`: bounding spheres of the objects
    /// at these poses (centre, radius; workspace).
    bool gather(std::span<const std::shared_ptr<const HapticObject>> objects, ObjectMotions poses,
                std::span<const glm::dvec4> spheres, int reference, const glm::dvec3& centre, double radius,
                Frame frame = Frame::Another) noexcept;
    /// The same where only the radii are known (object units).
    bool gather(std::span<const std::shared_ptr<const HapticObject>> objects, ObjectMotions poses,
                std::span<const double> radii, int reference, const glm::dvec3& centre, double radius,
                Frame frame = Frame::Another) noexcept;

    /// Where the ball after the one that is gathered next is expected, in that one's frame; radius 0:
    /// nowhere. The gather asks for the memory that the expected ball will read of the reference object, and
    /// fetchOn, once a tick, goes on: it comes while the ticks between compute.
    void expect(const glm::dvec3& centre, double radius) noexcept {
        ahead_.centre = glm::vec3(centre);
        ahead_.radius = static_cast<float>(radius);
    }
    void fetchOn() noexcept {
        if (ahead_.count > 0)
            aheadOf_->fetchOn(ahead_);
    }

    /// Objects that a gather leaves out from now on: at most kMaxIgnored.
    static constexpr size_t kMaxIgnored = 8;
    void ignore(std::span<const int> objects) noexcept {
        ignoredCount_ = std::min(objects.size(), kMaxIgnored);
        std::copy_n(objects.begin(), ignoredCount_, ignored_.begin());
    }

    void invalidate() noexcept {
        for (size_t i = 0; i < count_; ++i)
            release(items_[i].prepared);
        ahead_.count = 0;
        clear();
    }

    /// Distance that the proxy may move from `p` along the unit vector `direction` with every triangle within
    /// `reach` of it still in the cache; negative when p itself is not covered. Zero direction: zero or
    /// negative.
    [[nodiscard]] double freeAlong(const glm::dvec3& p, const glm::dvec3& direction,
                                   double reach) const noexcept {
        const double room = radius_ - reach;
        return valid_ && room >= 0.0 ? wayInBall(p - centre_, direction, room) : -1.0;
    }
    /// The same in a ball of radius `room`, from a place that is `offset` from its centre.
    [[nodiscard]] static double wayInBall(const glm::dvec3& offset, const glm::dvec3& direction,
                                          double room) noexcept {
        const double inside = room * room - glm::dot(offset, offset);
        if (inside < 0.0)
            return -1.0;
        if (direction == glm::dvec3(0.0))
            return 0.0;
        const double along = glm::dot(offset, direction);
        return std::sqrt(along * along + inside) - along;
    }

    [[nodiscard]] size_t count() const noexcept { return count_; }
    [[nodiscard]] double radius() const noexcept { return radius_; }
    [[nodiscard]] const NearShapes& shapes() const noexcept { return shapes_; }
    [[nodiscard]] const Candidate& item(size_t i) const noexcept { return items_[i]; }
    /// The triangle, ready for distance queries. The proxy comes near few of a ball's triangles, so each is
    /// prepared at its first use.
    [[nodiscard]] const Triangle& triangle(size_t i) noexcept { return prepared(items_[i]).triangle; }
    /// The distance of triangle i from the proxy's place p, evaluated; sharpens its bound.
    TriangleDistance measure(size_t i, const glm::dvec3& p) noexcept {
        const TriangleDistance d = measureAhead(i, p);
        items_[i].measured = place_;
        return d;
    }
    /// The same for a place ahead of the proxy.
    TriangleDistance measureAhead(size_t i, const glm::dvec3& p) noexcept {
        Prepared& known = prepared(items_[i]);
        if (known.at != p) {
            known.last = distanceTo(known.triangle, p);
            known.at = p;
            setBound(i, p, known.last.distance, known.last.gradient);
        }
        items_[i].measured = 0; // not at the proxy's place
        return known.last;
    }
    /// Far more than a resting proxy sinks into its surface, far less than the smallest radius: object units.
    static constexpr double kNotClear = 1e-8;

    /// True if a triangle of the ball belongs to a one-sided object.
    [[nodiscard]] bool anyOneSided() const noexcept { return oneSided_; }
    /// True where a proxy of this reach ignores triangle i, at `distance` from the place p where a move
    /// begins. The triangle is one-sided, and p is behind its plane; or p is not clear of it, coming through
    /// from behind or turned around on the way; or p is beside it while it comes through another triangle of
    /// the same object. A proxy that came through a triangle feels it once it is clear of it, so that there
    /// is no place between the sides.
    [[nodiscard]] bool passes(size_t i, const glm::dvec3& p, double distance, double reach) noexcept {
        return items_[i].source->oneSided && passesOneSided(i, p, distance, reach);
    }
    /// The proxy was clear at its place by no more than `distance`, whatever its reach is now: it is coming
    /// through anything nearer. Valid until the next call.
    void standsClearBy(double distance) noexcept { standing_ = distance; }
    [[nodiscard]] double standing() const noexcept { return standing_; }
    /// The minimum distance at p of the one-sided triangles that a proxy of this reach does not ignore, at
    /// most `reach`. The ball covers p.
    [[nodiscard]] double clearanceAt(const glm::dvec3& p, double reach) noexcept;
    /// The proxy has moved.
    void moved() noexcept { place_ += place_ + 1 == 0 ? 2 : 1; } // 0 is never a place

    /// Calls visit(i) for every triangle that may be within `reach` of p.
    template <class Visit>
    void eachNear(const glm::dvec3& p, double reach, const Visit& visit) noexcept {
        const double near = reach + uncertainty();
        for (size_t first = 0; first < count_; first += kBlock) {
            const Block& block = bounds_[first / kBlock];
            uint32_t reached = 0;
            for (size_t half = 0; half < kBlock; half += 4)
                reached |= bitsOf(block.least(half, p) <= near) << half;
            for (; reached != 0; reached &= reached - 1)
                visit(first + static_cast<size_t>(std::countr_zero(reached)));
        }
    }

    /// A triangle that a move may hit, not before `time`.
    struct Approach {
        double time; ///< in moves
        uint32_t index;
        uint32_t steps;
    };
    /// All triangles that a proxy moving from p may come within `reach` of before p + limit * move. Valid
    /// until the next call.
    std::span<Approach> approaching(const glm::dvec3& p, const glm::dvec3& move, double limit,
                                    double reach) noexcept;

  private:
    [[nodiscard]] bool passesOneSided(size_t i, const glm::dvec3& p, double distance, double reach) noexcept;
    [[nodiscard]] bool comesThrough(int object, const glm::dvec3& p, double clear) noexcept;
    template <class SphereOf>
    bool gatherAll(std::span<const std::shared_ptr<const HapticObject>> objects, ObjectMotions poses,
                   const SphereOf& sphereOf, int reference, const glm::dvec3& centre, double radius,
                   Frame frame) noexcept;
    Prepared& prepared(Candidate& item) noexcept {
        if (item.prepared == Candidate::kUnprepared)
            prepare(item);
        return pool_[item.prepared];
    }
    void prepare(Candidate& item) noexcept;
    void release(uint32_t prepared) noexcept {
        if (prepared != Candidate::kUnprepared)
            free_[freeCount_++] = prepared;
    }
    void clear() noexcept {
        valid_ = false;
        count_ = 0;
        turnCount_ = 0;
        coming_.object = -1;
        shapes_.clear();
    }
    void keepPrepared() noexcept;
    void releaseKept() noexcept;
    void takeKeptBounds() noexcept;
    [[nodiscard]] uint32_t takeKept(int object, uint32_t index) noexcept;
    static size_t keptSlot(int object, uint32_t index) noexcept {
        return (index * 2654435761u + static_cast<uint32_t>(object) * 40503u) >> (32 - kKeptBits);
    }
    void turnBounds(size_t first, const Similarity& referenceFromObject) noexcept;
    bool gatherObject(const HapticObject& object, int index, const Similarity* objectFromReference,
                      const glm::dvec3& centre, double radius) noexcept;

    void setBound(size_t i, const glm::dvec3& p, double distance, const glm::dvec3& gradient) noexcept {
        Block& block = bounds_[i / kBlock];
        const size_t k = i % kBlock;
        block.x[k] = gradient.x;
        block.y[k] = gradient.y;
        block.z[k] = gradient.z;
        block.offset[k] = distance - glm::dot(gradient, p);
    }

    /// A bound may be too high by this: the gradient beside a radius of 5e-7 is good to 6e-10, and places are
    /// at most three radii from where a bound was evaluated (takeKept).
    [[nodiscard]] double uncertainty() const noexcept { return 2e-9 * radius_; }

    std::vector<Candidate> items_;
    std::vector<Block> bounds_;
    std::vector<Approach> approaches_;
    std::vector<TriangleTree::Near> found_; ///< of one object
    TriangleTree::Ahead ahead_;
    const TriangleTree* aheadOf_ = nullptr; ///< where anything waits in it
    std::vector<Similarity> turns_;         ///< reference from object, of the other objects in the ball
    size_t turnCount_ = 0;
    std::vector<Prepared> pool_;
    std::vector<uint32_t> free_; ///< of the pool, a stack: those used last come first
    size_t freeCount_ = 0;
    /// While a gather runs: what the ball before it had prepared, found by a table that may miss.
    static constexpr size_t kMaxKept = 256;
    static constexpr uint32_t kKeptBits = 10;
    struct Kept {
        int object = -1;
        uint32_t index = 0, prepared = Candidate::kUnprepared;
    };
    std::array<Kept, kMaxKept> kept_{};
    std::array<uint16_t, (size_t{1} << kKeptBits) + 1> keptAt_{}; ///< and a spare one
    size_t keptCount_ = 0;
    std::array<uint16_t, kMaxKept + 1> retaken_{}; ///< items of this ball that were kept, and a spare one
    size_t retakenCount_ = 0;
    std::array<int, kMaxIgnored> ignored_{};
    NearShapes shapes_;
    size_t ignoredCount_ = 0;
    size_t count_ = 0;
    glm::dvec3 centre_{0.0};
    double radius_ = 0.0;
    bool valid_ = false, oneSided_ = false;
    double standing_ = INFINITY; ///< standsClearBy
    /// The last answer of comesThrough; object -1: none. Holds until the next gather.
    struct {
        int object = -1;
        bool through = false;
        double clear = 0.0;
        glm::dvec3 place{0.0};
    } coming_;
    uint32_t place_ = 1; ///< counts the proxy's places
};

} // namespace touchstone
