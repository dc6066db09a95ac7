#pragma once
// How far what is felt is from the best that this program knows: the same hand on the same scene, touched a
// second time with the most exact configuration of every ablation.

#include "haptics/scene/moving_objects.h"
#include "haptics/servo/servo_loop.h"

#include <cstdint>
#include <memory>

namespace touchstone::study {

/// What is felt with `settings`, as exactly as it can be: every choice of method at its most exact
/// configuration, every choice of what is to be felt as it is. Method: contact (the sweep, in double), the
/// proxy's moves (to the end), shading (two-pass wherever the material does not say off; `off` and the
/// one-facet models are cheaper configurations of it). To be felt: stiffness, damping, friction and its law,
/// texture and its law, tilt limits, the proxy's radius (of a point method none).
[[nodiscard]] HapticSettings referenceOf(const HapticSettings& settings);

/// One tick beside the reference. Workspace, SI.
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

/// The reference's hand. It runs free, on the servo's samples: in the air both are the same again, and what
/// it cannot know (before its first tick, behind a gap in the records) it takes from the servo. One thread;
/// allocates.
///
/// Free, and not put back where the servo is from tick to tick: an error that builds up over a contact, as
/// with a proxy that lags behind, is what the hand feels, and would not be seen. The price: where a law
/// slips, the two may slip at other moments (docs/accuracy.md).
class ReferenceTouch {
  public:
    /// The scene of the records that follow; null: none.
    void enter(std::shared_ptr<const HapticScene> scene, ScenePtr source);

    /// The next tick in order, or a later one. False where there is nothing to compare with: no scene, or the
    /// tick that the reference begins with.
    [[nodiscard]] bool compare(const TickRecord& record, const HapticSettings& settings, TickError& error);

    /// What the reference felt in the tick compared last.
    [[nodiscard]] const HapticOutput& output() const { return output_; }

  private:
    /// The state after `record`, as far as it tells.
    void adopt(const TickRecord& record, const HapticSettings& settings, ObjectMotions motions);

    std::shared_ptr<const HapticScene> scene_;
    MovingObjects moving_;
    DeviceState state_;
    WorldState world_;
    HapticOutput output_;
    uint64_t nextStep_ = 0;
    bool follows_ = false; // the state is that of the tick before nextStep_
};

} // namespace touchstone::study
