#pragma once
// The triangles near the proxy: gathered once with Embree, reused by every move until the proxy leaves the
// ball.

#include "engine/math/similarity.h"
#include "haptics/contact/haptic_object.h"
#include "haptics/contact/triangle.h"
#include "haptics/object_motion.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace touchstone {

/// One triangle near the proxy.
struct Candidate {
    const HapticObject* source = nullptr;
    int object = -1;       ///< HapticScene::objects
    uint32_t index = 0;    ///< triangle of that object
    bool prepared = false; ///< `triangle` is filled in
    Triangle triangle;     ///< frame of the anchor object, object units
};

/// Every triangle that meets the ball (centre, radius) is in `items`; those alone can stop a proxy that stays
/// in it. Preallocated; gather neither allocates nor throws.
class CandidateCache {
  public:
    /// Room for the densest neighbourhood in which the proxy still moves; beyond it the ball is made smaller.
    static constexpr size_t kCapacity = 4096;

    CandidateCache() : items_(kCapacity), lowerBounds_(kCapacity) {}

    /// Collects what meets the ball, in the frame of `anchor`; the lower bounds hold for a proxy at `centre`.
    /// False when there are more than kCapacity: then the cache is empty and invalid.
    bool gather(std::span<const std::unique_ptr<const HapticObject>> objects, ObjectMotions poses, int anchor,
                const glm::dvec3& centre, double radius) noexcept;

    void invalidate() noexcept {
        valid_ = false;
        count_ = 0;
    }

    /// How far the proxy may go from `p` in any direction and still know every triangle within `reach` of it;
    /// negative when p itself is not covered.
    [[nodiscard]] double slack(const glm::dvec3& p, double reach) const noexcept {
        return valid_ ? radius_ - reach - glm::length(p - centre_) : -1.0;
    }

    [[nodiscard]] size_t count() const noexcept { return count_; }
    [[nodiscard]] const Candidate& item(size_t i) const noexcept { return items_[i]; }
    /// Ready for distance queries. Most of a ball's triangles are never come near to, so each is prepared at
    /// its first use.
    [[nodiscard]] const Triangle& triangle(size_t i) noexcept {
        if (!items_[i].prepared)
            prepare(items_[i]);
        return items_[i].triangle;
    }
    /// A distance that triangle i is surely not nearer than, from where the proxy stands now.
    [[nodiscard]] double lowerBound(size_t i) const noexcept { return lowerBounds_[i]; }
    void setDistance(size_t i, double distance) noexcept { lowerBounds_[i] = distance; }
    /// The proxy moved by `length`: every bound shrinks by it.
    void moved(double length) noexcept {
        for (size_t i = 0; i < count_; ++i)
            lowerBounds_[i] -= length;
    }

  private:
    struct Visit;
    static void prepare(Candidate& item) noexcept;
    bool gatherObject(const HapticObject& object, int index, const Similarity* objectFromAnchor,
                      const glm::dvec3& centre, double radius) noexcept;

    std::vector<Candidate> items_;
    std::vector<double> lowerBounds_;
    size_t count_ = 0;
    glm::dvec3 centre_{0.0};
    double radius_ = 0.0;
    bool valid_ = false;
};

} // namespace touchstone
