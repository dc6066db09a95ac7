#pragma once
// The second contact model, stages 2 and 3: Ho, Basdogan and Srinivasan's neighbourhood watch (Presence 8(5),
// 1999, §3; [000] has its results). Made to be compared with the sweep, which is the better one.

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/mesh/surface_walk.h"
#include "haptics/solve/solve_result.h"
#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

/// One device in one tick. The first contact is the triangle that the HIP's path since the last tick crosses.
/// From there a point, the IHIP, walks over neighbouring faces, edges and vertices for as long as that brings
/// it nearer to the HIP. It lets go when the HIP is on the side that it came from.
///
/// A point method: it knows no radius. While it touches one object it looks at nothing but the neighbours of
/// the place that it touches; see docs/architecture.md for what that costs. Bounded: `budget` steps and
/// WalkBudget::kMaxTests triangles a tick, beyond which it stops where it is and sets BudgetReached.
class NeighbourhoodWatch {
  public:
    /// `scene` must have its neighbourhoods built.
    NeighbourhoodWatch(const HapticScene& scene, ObjectMotions motions, int budget, DeviceState& state,
                       SolveResult& rest) noexcept;

    /// Puts the proxy at the HIP in the first tick, and queries; false while the HIP is inside a closed
    /// object.
    [[nodiscard]] bool begin() noexcept;

    /// Walks to the place of the surface nearest to `goal` (reference object frame) that a walk downhill
    /// finds; without contact the proxy goes to `goal`.
    void moveTowards(const glm::dvec3& goal) noexcept;
    void dropTowards(const glm::dvec3& goal) noexcept { moveTowards(goal); }

    /// Puts the proxy back to where it was when the tick began.
    void placeAt(const glm::dvec3& p) noexcept;

  private:
    /// Finds out whether the HIP of this tick is held, by which object, and where: a new contact, the one
    /// that there is, or none any more. What is touched first becomes the reference object.
    void query() noexcept;
    bool acquire(const glm::dvec3& start, bool left) noexcept;
    bool strikes(size_t object, const glm::dvec3& from, const glm::dvec3& to, double skip, double& first,
                 SurfacePlace& place) noexcept;
    [[nodiscard]] SurfaceView surface(size_t object) const noexcept;
    void report(const glm::dvec3& goal) noexcept;

    const HapticScene& scene_;
    ObjectMotions motions_;
    DeviceState& state_;
    SolveResult& rest_;
    WalkBudget budget_;
    uint32_t steps_;      // that the tick began with
    TriangleSide before_; // where the tick began
};

/// Takes a proxy that the watch left on a surface to where the sweep can go on from: just off it, on its
/// side.
void leaveWatch(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

} // namespace touchstone
