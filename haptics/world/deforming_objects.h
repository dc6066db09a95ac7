#pragma once
// The deforming objects of a world as its scene has them. Where their vertices are is kept in states that
// scenes with the same ones share, so that a sculpted field beside them makes no new ones.

#include "engine/math/object_motion.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/world/deforming_states.h"
#include "haptics/world/mesh_interval.h"

#include <memory>
#include <span>
#include <vector>

namespace touchstone {

/// Construct off the servo (it allocates). One thread calls `advance`.
class DeformingObjects {
  public:
    /// Null where the animation that plays in `source` deforms none of the objects. `goOn`: the states of a
    /// scene before it, which go on here where its deforming objects are these; the servo and their thread
    /// may use them meanwhile.
    [[nodiscard]] static std::unique_ptr<DeformingObjects>
    of(const ScenePtr& source, const HapticScene& haptic, std::shared_ptr<DeformingStates> goOn = nullptr);
    DeformingObjects(const DeformingObjects&) = delete;
    DeformingObjects& operator=(const DeformingObjects&) = delete;

    /// The scene with the objects as they are in this tick; the others are those of the scene it was made of.
    /// With the states of another scene: from the first `advance` on.
    [[nodiscard]] const HapticScene& scene() const noexcept { return *scene_; }
    [[nodiscard]] const std::shared_ptr<DeformingStates>& states() const noexcept { return states_; }

    /// DeformingStates::advance. Sets `jumped` of the objects whose animation starts again at another place.
    void advance(double time, bool begins, bool hold, std::span<ObjectMotion> motions) noexcept;
    /// Begins at `time`; false where its publication is not there yet, but wanted.
    [[nodiscard]] bool reach(double time) noexcept {
        advance(time, true, false, {});
        return !states_->held();
    }

  private:
    DeformingObjects(const HapticScene& haptic, const std::vector<size_t>& objects,
                     std::shared_ptr<DeformingStates> states);
    void step(std::span<ObjectMotion> motions) noexcept;

    std::shared_ptr<HapticScene> scene_;
    std::shared_ptr<DeformingStates> states_;
    std::vector<MovedMesh> meshes_; // in the order of the states
};

} // namespace touchstone
