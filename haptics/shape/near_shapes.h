#pragma once
// The shapes near the proxy that are not meshes, in the frame of the reference object.

#include "engine/math/similarity.h"
#include "haptics/shape/shape.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace touchstone {

/// Gathered with the triangles of the meshes (CandidateCache). No allocation.
class NearShapes {
  public:
    /// Shapes near one place: with more, the ball shrinks. Features of each: farther ones are not felt
    /// (TickFlag::CandidatesFull).
    static constexpr size_t kMaxShapes = 16, kMaxFeatures = 16;

    void clear() noexcept { count_ = 0; }
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
    /// Adds the shape if it comes within `radius` of `centre` (reference object frame). False when there are
    /// too many. `objectFromReference`: null for the reference object itself.
    [[nodiscard]] bool add(const Shape& shape, int object, const Similarity* objectFromReference,
                           const glm::dvec3& centre, double radius) noexcept;

    /// Shape::sweep of a ball of `reach` at p over all of them. Reference frame.
    [[nodiscard]] double sweep(const glm::dvec3& p, const glm::dvec3& move, double reach,
                               double limit) const noexcept;

    /// The distance of the nearest feature within `reach` of p; INFINITY where there is none.
    [[nodiscard]] double nearest(const glm::dvec3& p, double reach) const noexcept;

    /// A feature of one of the shapes, seen from p. False where the shape is not near.
    [[nodiscard]] bool seen(int object, FeatureId feature, const glm::dvec3& p,
                            FeatureDistance& found) const noexcept;

    /// Shape::restNear of one of the shapes. Reference frame. False also where the shape is not near.
    [[nodiscard]] bool restNear(int object, const glm::dvec3& from, const glm::dvec3& goal, double distance,
                                glm::dvec3& place) const noexcept;

    /// Calls visit(object, feature distance in the reference object frame) for every feature within `reach`
    /// of p. False where a shape has more features than fit.
    template <class Visit>
    bool eachNear(const glm::dvec3& p, double reach, const Visit& visit) const noexcept {
        bool all = true;
        for (size_t i = 0; i < count_; ++i) {
            const Placed& placed = placed_[i];
            std::array<FeatureDistance, kMaxFeatures> found;
            const size_t count = placed.shape->near(placed.objectFromReference.point(p),
                                                    placed.objectFromReference.scale * reach, found);
            for (size_t k = 0; k < std::min(count, found.size()); ++k)
                visit(placed.object, inReference(placed, found[k]));
            all &= count <= found.size();
        }
        return all;
    }

  private:
    struct Placed {
        const Shape* shape = nullptr;
        int object = -1; ///< HapticScene::objects
        Similarity objectFromReference, referenceFromObject;
    };
    static FeatureDistance inReference(const Placed& placed, const FeatureDistance& d) noexcept {
        const Similarity& referenceFromObject = placed.referenceFromObject;
        return {referenceFromObject.scale * d.distance, referenceFromObject.direction(d.gradient),
                referenceFromObject.point(d.closest), d.feature};
    }

    /// Null where the object's shape is not near.
    [[nodiscard]] const Placed* find(int object) const noexcept;

    std::array<Placed, kMaxShapes> placed_;
    size_t count_ = 0;
};

} // namespace touchstone
