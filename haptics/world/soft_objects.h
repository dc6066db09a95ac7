#pragma once
// The soft bodies of a world as its scene has them. Where they are is kept in states that scenes of equal
// geometry share, so that an edit of a material moves none.

#include "engine/math/object_motion.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/world/mesh_interval.h"
#include "haptics/world/soft_states.h"

#include <memory>
#include <span>
#include <vector>

namespace touchstone {

/// Construct off the servo (it allocates). One thread calls `advance`.
class SoftObjects {
  public:
    /// Null where `source` has no soft bodies that are felt as meshes. `goOn`: the states of a scene before
    /// it, which go on here where its soft bodies are these; the servo and their thread may use them
    /// meanwhile.
    [[nodiscard]] static std::unique_ptr<SoftObjects> of(const ScenePtr& source, const HapticScene& haptic,
                                                         std::shared_ptr<SoftStates> goOn = nullptr);
    SoftObjects(const SoftObjects&) = delete;
    SoftObjects& operator=(const SoftObjects&) = delete;

    /// The scene with the objects as they are in this tick: from the first `advance` on.
    [[nodiscard]] const HapticScene& scene() const noexcept { return *scene_; }
    [[nodiscard]] const std::shared_ptr<SoftStates>& states() const noexcept { return states_; }

    /// Moves the vertices on by what was integrated. `begins`: they have no previous places, and stay where
    /// they are. `hold`: they stay, as they did where a tick was held. Sets `jumped` of the objects in the
    /// first tick of their states.
    void advance(bool begins, bool hold, std::span<ObjectMotion> motions) noexcept;
    /// Nothing moved in this tick nor in the last one.
    [[nodiscard]] bool still() const noexcept { return still_ && wasStill_; }
    /// After SoftStates::restore, and where a state is kept: nothing is still.
    void showRestored() noexcept { step(true); }

  private:
    SoftObjects(const HapticScene& haptic, std::shared_ptr<SoftStates> states);
    void step(bool begins) noexcept;

    std::shared_ptr<HapticScene> scene_;
    std::shared_ptr<SoftStates> states_;
    std::vector<MovedMesh> meshes_; // by body of the states
    bool still_ = false, wasStill_ = false;
};

} // namespace touchstone
