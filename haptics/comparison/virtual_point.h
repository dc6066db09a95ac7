#pragma once
// The fourth and fifth contact models, stages 2 and 3: Kim, Kyrikou, Sukhatme and Desbrun's virtual contact
// point [002 §4], and the force proportional to the potential that it replaces [002 Fig. 3a]. Comparison
// solvers for scenes of fields: the sweep is the better method.

#include "engine/math/object_motion.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/solve/solve_result.h"
#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

namespace touchstone {

/// One device in one tick. The tip touches where the potential f is negative. The force follows n, the
/// gradients at the eight nodes of its cell interpolated at the tip [002 eqs. 1, 2], and the contact point is
///   virtualPoint: where the line from the tip along n first leaves the object, by a bracket and bisection;
///   potential:    the tip - f n, whatever lies there.
/// Neither remembers a side: a tip that passes the medial axis of a thin part is pushed out behind it. Where
/// the interpolated gradient vanishes, as where the field is flat, deeper than a device pushes, there is no
/// direction and no force. The object in which the tip lies
/// deepest is the one touched.
///
/// A point method: it has no radius. Bounded: a line makes at most three steps a cell of the grid's diagonal.
class VirtualPoint {
  public:
    /// Every object of `scene` has a potential (Shape::potential), or is empty.
    VirtualPoint(const HapticScene& scene, ObjectMotions motions, ContactMethod method, DeviceState& state,
                 SolveResult& rest) noexcept;

    /// Puts the proxy at the HIP in the first tick; false while the HIP is where touch may not begin.
    [[nodiscard]] bool begin() noexcept;
    /// The tip is at `goal` (reference object frame).
    void moveTowards(const glm::dvec3& goal) noexcept;
    void dropTowards(const glm::dvec3& goal) noexcept { moveTowards(goal); }
    void placeAt(const glm::dvec3& place) noexcept { state_.proxy = place; }
    /// Moves the contact point of the last move to where the line from the tip through `place` leaves the
    /// object [002 §4.3, Fig. 5]; potential: to `place` itself. Always true.
    bool slideTo(const glm::dvec3& place) noexcept;

  private:
    void report(int object, const glm::dvec3& normal) noexcept;

    const HapticScene& scene_;
    ObjectMotions motions_;
    ContactMethod method_;
    DeviceState& state_;
    SolveResult& rest_;
    glm::dvec3 tip_{0.0}; ///< reference object frame
};

} // namespace touchstone
