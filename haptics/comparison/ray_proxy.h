#pragma once
// The third contact model, stages 2 and 3: Zilles and Salisbury's god-object [001], a point that is moved by
// rays. A comparison solver: the sweep is the better method.

#include "engine/math/object_motion.h"
#include "haptics/comparison/ray_path.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/solve/solve_result.h"
#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace touchstone {

/// One device in one tick. A ray runs from the god-object along its target displacement. Each surface that it
/// meets becomes a constraint plane, and the next target is the place nearest to the goal on the planes; at
/// most three are active, selected by the multipliers. A free move drops the planes whose triangles the
/// god-object has left, and the next ray finds their successors. It ends where the planes leave no target
/// displacement.
///
/// Real: the precision of all of this, double or float (precision=single); poses of several objects are
/// double in both, and Embree's rays float in both. It keeps kRayClearance from every surface that a ray
/// finds. A point: it has no radius. See docs/architecture.md for the contacts that rays may miss. Bounded:
/// `budget` moves and four times as many rays, beyond which it stops where it is and sets BudgetReached.
template <class Real>
class RayProxy {
  public:
    using Vec = glm::vec<3, Real>;
    RayProxy(const HapticScene& scene, ObjectMotions motions, int budget, DeviceState& state,
             SolveResult& rest) noexcept;

    /// Puts the god-object at the HIP in the first tick; false while the HIP is inside a closed object.
    [[nodiscard]] bool begin() noexcept;

    /// Moves the god-object to rest (`goal`: reference object frame). Anytime: every move ends in free space.
    void moveTowards(const glm::dvec3& goal) noexcept { solve(goal, true); }
    /// Moves it straight until contact.
    void dropTowards(const glm::dvec3& goal) noexcept { solve(goal, false); }
    /// Without a ray: only for its former places.
    void placeAt(const glm::dvec3& p) noexcept;

  private:
    void solve(const glm::dvec3& goal, bool sliding) noexcept;
    void target(const Vec& goal) noexcept;
    void add(const RayStrike<Real>& hit) noexcept;
    void holdInTheAir(const Vec& goal) noexcept;
    void report() noexcept;

    const HapticScene& scene_;
    ObjectMotions motions_;
    DeviceState& state_;
    SolveResult& rest_;
    uint32_t moves_, rays_; ///< that remain in the tick
    RayPath<Real> path_;
    Vec at_; ///< the god-object, reference object frame
    std::array<RayStrike<Real>, 4> held_;
    size_t heldCount_ = 0;
    RayStrike<Real> last_; ///< of this tick
    Vec target_{Real(0)};  ///< displacement to the place nearest to the goal on the planes held
    std::array<Real, 4> multiplier_{};
};

extern template class RayProxy<double>;
extern template class RayProxy<float>;

/// Stage 2 where objects move: the god-object moves with its reference object; an object that hits it takes
/// it along. A god-object hit by two stays with the last, and may be left behind by the other (Jammed).
void sweepMovingObstaclesByRays(const HapticScene& scene, ObjectMotions motions, DeviceState& state,
                                uint32_t& flags) noexcept;

} // namespace touchstone
