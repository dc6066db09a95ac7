#pragma once
// The surfaces that a straight move meets, found by Embree's rays and tested in the selected precision.

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace touchstone {

/// Distance that a god-object of rays keeps from every surface, object units: several times the error of
/// float rays and, with precision=single, float heights (1e-7 of the object). 75 nm and 0.3 µm on a fitted
/// model.
template <class Real>
inline constexpr Real kRayClearance = Real(sizeof(Real) == sizeof(double) ? 5e-7 : 2e-6);

/// A triangle of the scene in its object's frame.
template <class Real>
struct RayFacet {
    using Vec = glm::vec<3, Real>;
    Vec a, b, c, normal; ///< counter-clockwise, unit; zero where the triangle has no area
    RayFacet(const HapticObject& object, uint32_t triangle) noexcept;
};

/// A surface that a move hits, in the reference object's frame.
template <class Real>
struct RayStrike {
    using Vec = glm::vec<3, Real>;
    Vec normal{Real(0)}; ///< unit, on the side that the move comes from
    Real share = 0;      ///< fraction of the move at which it is nearer to the surface than the clearance
    Real back = 1;       ///< 1 or -1: sign of the triangle's own normal
    Real clearance = 0;  ///< of its object, reference object units
    int object = -1;
    uint32_t triangle = 0;
};

/// One ray in the frame of one object. Bounded: four triangles. A hit counts if the start is on the near side
/// of the plane of the triangle that Embree found, evaluated in Real. `far`: length of the ray. Returns the
/// distance from `from`, triangle and side.
template <class Real>
struct RayMeeting {
    Real distance = 0, height = 0, rate = 0; ///< height of the start, and its rate along the path
    Real back = 1;
    glm::vec<3, Real> normal{Real(0)};
    uint32_t triangle = 0;
};
template <class Real>
[[nodiscard]] std::optional<RayMeeting<Real>>
meetAlong(const HapticObject& object, const glm::vec<3, Real>& from, const glm::vec<3, Real>& direction,
          Real far) noexcept;

/// The objects near one device's god-object in one tick. Reference frame.
template <class Real>
class RayPath {
  public:
    using Vec = glm::vec<3, Real>;
    RayPath(const HapticScene& scene, ObjectMotions motions, int reference) noexcept
        : scene_(scene), motions_(motions), reference_(reference) {}

    /// The first surface to which the move from `from` comes nearer than its clearance.
    [[nodiscard]] std::optional<RayStrike<Real>> strike(const Vec& from, const Vec& move) noexcept;

    /// Height above the plane of the hit triangle, on the side of the hit; reference object units.
    [[nodiscard]] Real height(const RayStrike<Real>& at, const Vec& p) const noexcept;
    /// True where `p` is near the triangle and its projection lies on it.
    [[nodiscard]] bool stands(const RayStrike<Real>& at, const Vec& p) const noexcept;
    /// More objects are near than fit: nothing may move.
    [[nodiscard]] bool full() const noexcept { return full_; }

  private:
    static constexpr size_t kMaxNear = 64;
    void gather(const glm::dvec3& from, const glm::dvec3& to) noexcept;
    void strikeOne(int object, const Vec& from, const Vec& direction, Real length, Real& first,
                   std::optional<RayStrike<Real>>& hit) const noexcept;
    [[nodiscard]] Similarity objectFromReference(int object) const noexcept;

    const HapticScene& scene_;
    ObjectMotions motions_;
    int reference_;
    std::array<int, kMaxNear> near_; // `count_` of them
    size_t count_ = 0;
    bool full_ = false;
    glm::dvec3 middle_{0.0}; ///< workspace, of the ball whose objects are listed
    double radius_ = -1.0;
};

extern template class RayPath<double>;
extern template class RayPath<float>;

} // namespace touchstone
