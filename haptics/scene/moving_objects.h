#pragma once
// Where the objects are at a tick: glTF node animation sampled at the tick's time.

#include "engine/math/object_motion.h"
#include "engine/scene/animation.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"

#include <glm/glm.hpp>

#include <memory>
#include <vector>

namespace touchstone {

/// What the hand feels otherwise than the eye sees it, of the animation that plays.
[[nodiscard]] std::vector<Warning> animationWarnings(const Scene& scene);

/// Poses of a HapticScene's objects in time, with memory of the tick before. Construct off the servo (it
/// allocates); `at` allocates nothing, takes no lock and does not throw. One thread at a time.
///
/// An object moves as a similarity: rotation, translation and even scale are followed exactly. A pose that
/// shears or scales unevenly is replaced by the similarity of the same volume whose axes are nearest, and one
/// that mirrors or flattens leaves the object where it was.
class MovingObjects {
  public:
    /// Nothing moves.
    MovingObjects() = default;
    MovingObjects(ScenePtr scene, const HapticScene& haptic);

    [[nodiscard]] bool moving() const { return !movers_.empty(); }

    /// The poses at `time` (s since the start of the animation, any) and at the call before; empty when
    /// nothing moves, which is what TickInput takes for rest. Where the animation begins again somewhere else
    /// than it ended the object has `jumped`.
    [[nodiscard]] ObjectMotions at(double time) noexcept;

    /// The next call is as the first: nothing has come from anywhere.
    void forget() noexcept { sampled_ = false; }

  private:
    struct Mover {
        size_t object;                  // HapticScene::objects
        size_t instance;                // Scene::instances
        glm::dmat4 meshFromObject{1.0}; // rest pose: what takes the object's frame to the mesh's, unevenly
        bool jumps = false;             // the animation does not end where it begins
    };

    ScenePtr scene_;
    const Animation* animation_ = nullptr;
    std::vector<ScenePose> pose_; // none or one: it has no empty state
    Similarity workspaceFromScene_;
    std::vector<Mover> movers_;
    std::vector<ObjectMotion> motions_;
    double lap_ = 0.0; // of the animation, in the tick before
    bool sampled_ = false;
};

} // namespace touchstone
