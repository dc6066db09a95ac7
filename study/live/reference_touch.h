#pragma once
// The error against the best solution of this program: the same hand on the same scene, computed a second
// time with the most exact configuration of every ablation.

#include "haptics/servo/servo_loop.h"
#include "haptics/world/world_state.h"

#include <cstdint>
#include <memory>

namespace touchstone::study {

/// The most exact settings that render the same effects as `settings`: every choice of method at its most
/// exact configuration, every choice of effect unchanged. Methods: contact (the sweep, in double), the
/// proxy's moves (until it converges), shading (two-pass wherever the material does not disable it; `off` and
/// the one-facet models are cheaper configurations of it). Effects: stiffness, damping, friction and its law,
/// texture and its law, tilt limits, the proxy's radius (of a point method none).
[[nodiscard]] HapticSettings referenceOf(const HapticSettings& settings);

/// The error of one tick. Workspace, SI.
struct TickError {
    /// Lost: only the reference touches. Invented: only the servo does.
    enum class Contact : uint8_t { None, Both, Lost, Invented };
    Contact contact = Contact::None;
    // Where both touch.
    double position = 0.0;        ///< m, proxy from proxy
    double force = 0.0;           ///< N, | |F| - |F_ref| |
    double forceShare = 0.0;      ///< the same, of |F_ref|
    double direction = 0.0;       ///< rad, between the forces
    double forceDifference = 0.0; ///< N, |F - F_ref|: where either touches
};

/// The hand of the reference. It runs free on the servo's samples: in the air both states are equal again.
/// What it cannot know (before its first tick, after a gap in the records) it copies from the servo. One
/// thread; allocates.
///
/// It is not reset to the servo's state at every tick: the hand feels an error that builds up over a contact,
/// such as a lagging proxy, and a reset would hide it. The cost: with stick-slip, the two may slip at
/// different moments (docs/accuracy.md).
class ReferenceTouch {
  public:
    /// The scene of the following records; null: none.
    void enter(std::shared_ptr<const HapticScene> scene, ScenePtr source);

    /// The next tick in order, or a later one. False without a comparison: no scene, or the first tick of the
    /// reference.
    [[nodiscard]] bool compare(const TickRecord& record, const HapticSettings& settings, TickError& error);

    /// The reference's output of the tick compared last.
    [[nodiscard]] const HapticOutput& output() const { return output_; }

  private:
    /// The state after `record`, as far as the record contains it.
    void adopt(const TickRecord& record, const HapticSettings& settings, ObjectMotions motions);

    std::shared_ptr<const HapticScene> scene_;
    DeviceState state_;
    WorldState world_;
    HapticOutput output_;
    uint64_t nextStep_ = 0;
    bool follows_ = false; // the state is that of the tick before nextStep_
};

} // namespace touchstone::study
