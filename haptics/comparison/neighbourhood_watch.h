#pragma once
// The second contact model, stages 2 and 3: Ho, Basdogan and Srinivasan's neighbourhood watch (Presence 8(5),
// 1999, §3; [000] has its results). A comparison solver: the sweep is the better method.

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
/// it nearer to the HIP. Contact ends when the HIP is on the side that it came from.
///
/// A point method: it has no radius. During contact with one object it tests only the neighbours of the
/// touched place; docs/architecture.md states the cost of that. Bounded: `budget` steps and
/// WalkBudget::kMaxTests triangles a tick, beyond which it stops where it is and sets BudgetReached.
class NeighbourhoodWatch {
  public:
    /// `scene` must have its neighbourhoods built.
    NeighbourhoodWatch(const HapticScene& scene, ObjectMotions motions, int budget, DeviceState& state,
                       SolveResult& rest) noexcept;

    /// Puts the proxy at the HIP in the first tick, and queries; false while the HIP is inside a closed
    /// object.
    [[nodiscard]] bool begin() noexcept;

    /// Walks downhill to the place of the surface nearest to `goal` (reference object frame) that a walk can
    /// find; without contact the proxy moves to `goal`.
    void moveTowards(const glm::dvec3& goal) noexcept;
    void dropTowards(const glm::dvec3& goal) noexcept { moveTowards(goal); }

    /// Puts the proxy back to its place at the start of the tick.
    void placeAt(const glm::dvec3& p) noexcept;

  private:
    /// Determines whether the HIP of this tick is held, by which object, and where: a new contact, the
    /// present one, or none. The object first touched becomes the reference object.
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
    uint32_t steps_;      // at the start of the tick
    TriangleSide before_; // side at the start of the tick
};

/// Moves a proxy that the watch left on a surface to a valid start of the sweep: just off it, on its side.
void leaveWatch(const HapticScene& scene, ObjectMotions motions, DeviceState& state) noexcept;

} // namespace touchstone
