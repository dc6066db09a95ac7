#pragma once
// The search for a place of the proxy among objects that move: moving_obstacles.cpp tells how. One tick, one
// hand.

#include "haptics/contact/moving_triangle.h"
#include "haptics/proxy/moving_obstacles.h"
#include "haptics/shape/mesh/triangle.h"
#include "haptics/shape/shape.h"
#include "haptics/solve/sub_goal.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace touchstone {

/// Distance beyond the radius at which the proxy ends a tick, object units: more than the rounding between
/// frames, less than a thousandth of the smallest radius. A sweep ends at half of it.
inline constexpr double kObstacleGap = 1e-10;

/// The proxy and the objects near it, from the poses of the last tick to those of this one.
class MovingObstacles {
  public:
    MovingObstacles(const HapticScene& scene, ObjectMotions motions, double radius, DeviceState& state,
                    uint32_t& flags) noexcept
        : scene_(scene), motions_(motions), state_(state), flags_(flags) {
        const ObjectMotion& reference = motions_[index(state_.reference)];
        const double skin = 0.5 * kWeldTolerance * scene_.objects[index(state_.reference)]->diagonal;
        radius_ = std::max(radius, skin * reference.before.scale);
        place_ = reference.before.point(state_.proxy);
        start_ = place_;
    }

    void run() noexcept;

  private:
    /// What stopped a copy: a triangle, or a feature of a shape. Object frame.
    struct Hit {
        size_t copy = 0;
        Triangle triangle;
        const Shape* shape = nullptr;
        FeatureId feature = 0;
        bool moving = false; ///< the triangle, at the step's end, of an object that deforms
        glm::dvec3 at{0.0};  ///< then: where it is linearised

        [[nodiscard]] FeatureDistance from(const glm::dvec3& place) const noexcept {
            if (moving) [[unlikely]]
                return fromAside(place);
            if (shape != nullptr)
                return shape->distanceFrom(feature, place);
            const TriangleDistance d = distanceTo(triangle, place);
            return {.distance = d.distance, .gradient = d.gradient, .closest = d.closest};
        }
        /// As if measured at `place`: the plane is what counts.
        [[gnu::noinline]] FeatureDistance fromAside(const glm::dvec3& place) const noexcept {
            const TriangleDistance d = distanceTo(triangle, at);
            return {.distance = d.distance + glm::dot(d.gradient, place - at),
                    .gradient = d.gradient,
                    .closest = d.closest};
        }
    };
    static constexpr size_t kMaxHit = 32;

    static size_t index(int object) { return static_cast<size_t>(object); }
    const HapticObject& objectOf(const MovingObstacle& copy) const {
        return *scene_.objects[index(copy.object)];
    }
    bool moves(size_t k) const;
    [[nodiscard]] const MeshInstant* instantOf(const MovingObstacle& copy) const {
        return objectOf(copy).instant;
    }
    [[nodiscard]] MovingTriangle movingTriangle(const MovingObstacle& copy, uint32_t index) const noexcept;
    bool gatherMoving(const MovingObstacle& copy, const glm::dvec3& to) noexcept;
    bool sweepMoving(size_t copy, MovingObstacle& object, const glm::dvec3& to) noexcept;
    void noteMoving(size_t copy, const MovingObstacle& object, uint32_t index, const MovingTriangle& triangle,
                    const glm::dvec3& to) noexcept;
    [[nodiscard]] glm::dvec3 carried(const MovingObstacle& copy) noexcept;
    bool isNear(size_t k, double within) const;
    bool settleJumps() noexcept;
    bool blockedAt(size_t k, const glm::dvec3& place) noexcept;
    bool listNear() noexcept;
    void startStep(double from, double to) noexcept;
    bool solve(const glm::dvec3& target) noexcept;
    glm::dvec3 target(double step) noexcept;
    void advance() noexcept;
    void pinch(double from) noexcept;
    bool advanceWith(size_t holder, bool commit) noexcept;
    bool followJammed() noexcept;
    bool follow(MovingObstacle& copy) noexcept;
    bool sweep(size_t copy, MovingObstacle& object, const glm::dvec3& to) noexcept;
    void note(size_t copy, const MovingObstacle& object) noexcept;
    bool nearestPlace(std::span<const MovingObstacle> copies, const glm::dvec3& target, double unit,
                      glm::dvec3& place) noexcept;
    void keepOnly(const SubGoal& goal) noexcept;
    void lose() noexcept;
    void finish() noexcept;

    const HapticScene& scene_;
    ObjectMotions motions_;
    DeviceState& state_;
    uint32_t& flags_;
    double radius_; // workspace
    glm::dvec3 start_, place_;
    double room_ = 0.0; // every object within this distance of start_ is known, workspace
    double unit_ = 1.0; // workspace metres per unit of the solve
    double largestAngle_ = 0.0;
    size_t near_ = 0; // copies in use
    int sweeps_ = 0;
    std::array<Hit, kMaxHit> hit_;
    std::array<ConstraintPlane, kMaxHit> planes_;
    size_t struckCount_ = 0;
    bool revised_ = false;                   // a moving triangle was linearised again in this round
    bool deforming_ = false;                 // some object near does
    double from_ = 0.0, to_ = 0.0;           // of the step, in ticks
    glm::dvec3 drift_{0.0}, stepDrift_{0.0}; // of the reference object's deforming surface at the proxy
    int pusher_ = -1;                        // object whose plane held the last place that was pushed
    bool anchorPushes_ = false;
};

} // namespace touchstone
