#pragma once
// The objects' poses at a tick: glTF node animation sampled at the tick's time.

#include "engine/math/object_motion.h"
#include "engine/scene/animation.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"

#include <glm/glm.hpp>

#include <memory>
#include <vector>

namespace touchstone {

/// Warnings where the playing animation is felt differently from what is seen.
[[nodiscard]] std::vector<Warning> animationWarnings(const Scene& scene);

/// Poses of a HapticScene's objects over time; remembers the preceding tick. Construct off the servo (it
/// allocates); `at` allocates nothing, takes no lock and does not throw. One thread at a time.
///
/// An object moves as a similarity: rotation, translation and uniform scale are followed exactly. A pose that
/// shears or scales unevenly is replaced by the similarity of the same volume with the nearest axes; one that
/// mirrors or flattens leaves the object in place.
class MovingObjects {
  public:
    /// Nothing moves.
    MovingObjects() = default;
    MovingObjects(ScenePtr scene, const HapticScene& haptic);

    [[nodiscard]] bool moving() const { return !movers_.empty(); }

    /// The poses at `time` (s since the start of the animation, any) and at the preceding call; empty when
    /// nothing moves, which TickInput takes as rest. Where the animation restarts at another pose than its
    /// last, the object has `jumped`.
    [[nodiscard]] ObjectMotions at(double time) noexcept;

    /// The next call counts as the first: no object has a previous pose.
    void forget() noexcept { sampled_ = false; }

  private:
    struct Mover {
        size_t object;                  // HapticScene::objects
        size_t instance;                // Scene::instances
        glm::dmat4 meshFromObject{1.0}; // rest pose: from the object's frame to the mesh's, uneven
        bool jumps = false;             // the animation does not end where it begins
    };

    ScenePtr scene_;
    const Animation* animation_ = nullptr;
    std::vector<ScenePose> pose_; // none or one: ScenePose has no empty state
    Similarity workspaceFromScene_;
    std::vector<Mover> movers_;
    std::vector<ObjectMotion> motions_;
    double lap_ = 0.0; // of the animation, in the preceding tick
    bool sampled_ = false;
};

} // namespace touchstone
