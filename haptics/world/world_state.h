#pragma once
// The part of a scene that changes while it is touched: the poses of its objects, the forces that the hands
// exert on them, and its rigid bodies.

#include "engine/math/object_motion.h"
#include "engine/scene/animation.h"
#include "engine/scene/scene.h"
#include "haptics/body/hand_push.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/world/deforming_objects.h"

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace touchstone {

namespace body {
class BodyWorld;
struct BodyPoses;
} // namespace body
class PersistentTextures; // haptics/texture/persistent_textures.h
class DrivenObjects;      // haptics/world/driven_objects.h
class SoftObjects;        // haptics/world/soft_objects.h
class SoftStates;         // haptics/world/soft_states.h

/// Warnings where the playing animation is felt differently from what is seen.
[[nodiscard]] std::vector<Warning> animationWarnings(const Scene& scene);

/// What all hands together exert on one object in a tick: stage 7, before safety. Workspace.
struct ObjectReaction {
    glm::dvec3 force{0.0};  ///< N
    glm::dvec3 torque{0.0}; ///< N·m about the workspace's origin
};

/// Bodies of a WorldState. Simulated: they move. Shown: they are where another WorldState put them
/// (WorldState::showBodies).
enum class WorldBodies : uint8_t { Simulated, Shown };

/// What a world of equal geometry leaves to another one, which goes on with it. Each may be null.
struct CarriedOver {
    std::shared_ptr<body::BodyWorld> bodies{};
    std::shared_ptr<DeformingStates> deforming{};   ///< where the deforming objects are the same
    std::shared_ptr<SoftStates> soft{};             ///< where the soft bodies are the same
    std::shared_ptr<PersistentTextures> textures{}; ///< where they fit
    std::shared_ptr<DrivenObjects> driven{};        ///< objects that a caller moves besides (drivenProblem)
};

/// The state of a world from tick to tick. A tick begins with `advance`, which alone computes poses; the
/// haptic step reads `poses` and adds the hands' forces to `reactions`. Construct off the servo (it
/// allocates); nothing else here allocates, locks or throws. One thread at a time.
///
/// An object moves as a similarity: rotation, translation and uniform scale are followed exactly. A pose that
/// shears or scales unevenly is replaced by the similarity of the same volume with the nearest axes; one that
/// mirrors or flattens leaves the object in place.
class WorldState {
  public:
    /// Nothing moves.
    WorldState() noexcept;
    /// The animation that plays in `source` moves the objects of `haptic`, which was compiled from it, and so
    /// do its bodies. A null source: nothing moves. WorldBodies::Shown: without persistent textures and soft
    /// bodies.
    WorldState(ScenePtr source, const HapticScene& haptic, WorldBodies bodies = WorldBodies::Simulated,
               CarriedOver goesOn = {});
    ~WorldState();
    WorldState(WorldState&&) noexcept;
    WorldState& operator=(WorldState&&) noexcept;

    [[nodiscard]] bool moving() const { return !motions_.empty(); }

    /// Moves the objects to their poses and places at `time` (s since the start of the animation, any). Where
    /// the animation restarts at another pose than its last, the object has `jumped`. Returns `poses`.
    /// `hold`: deforming objects stand still, as they did where a tick has TickFlag::DeformationHeld.
    ObjectMotions advance(double time, bool hold = false) noexcept;
    /// Before the first `advance` of a world that goes on with what another one has left, or with a recorded
    /// state: the objects have their poses of the preceding tick, which was at `time` (NaN: there was none),
    /// and nothing moves on.
    void begin(double time) noexcept;
    /// `scene`, from which the world was made, or its copy with the vertices of this tick where some deform:
    /// what all queries of this tick read.
    [[nodiscard]] const HapticScene& touched(const HapticScene& scene) const noexcept {
        return own_ != nullptr ? *own_ : scene;
    }
    /// The deforming objects stand still in this tick, for want of a publication.
    [[nodiscard]] bool held() const noexcept {
        return (deforming_ != nullptr && deforming_->states()->held()) || (soft_ != nullptr && softHeld());
    }
    /// Off the servo, before it gets the world: another thread evaluates vertices ahead of `advance`, which
    /// is about to be called with `time`. For real time only.
    void publishAhead(double time) const {
        if (deforming_ != nullptr)
            deforming_->states()->publishAhead(time);
        if (soft_ != nullptr)
            stepSoftApart();
    }
    /// Before `begin`: true where the deforming objects have their vertices of `time`, which are those of
    /// `from` or are published; whoever publishes them is told that they are wanted.
    [[nodiscard]] bool reach(double time, const WorldState& from) const noexcept {
        return deforming_ == nullptr ||
               (from.deforming_ != nullptr && from.deforming_->states() == deforming_->states()) ||
               deforming_->reach(time);
    }
    /// Poses of this tick and of the preceding one; empty: every object is at rest where HapticScene placed
    /// it.
    [[nodiscard]] ObjectMotions poses() const noexcept { return poses_; }
    /// No object moved in this tick nor in the last one; false where an animation plays.
    [[nodiscard]] bool still() const noexcept { return still_; }
    /// Poses from the caller instead, who keeps them: one per object, or none for rest.
    void place(ObjectMotions poses) noexcept { poses_ = poses; }
    /// The next `advance` counts as the first: no object has a previous pose.
    void forget() noexcept { sampled_ = false; }
    /// Hash of the poses that `advance` computed for this tick; 0 where nothing moves.
    [[nodiscard]] uint32_t poseHash() const noexcept;

    /// Off the servo: from now on `reactions` has one entry per object. Otherwise they cost no time.
    void collectReactions(const HapticScene& haptic) {
        reactions_.resize(haptic.objects.size());
        collects_ = collects_ || !reactions_.empty();
    }
    [[nodiscard]] bool collectsReactions() const noexcept { return collects_; }
    /// Of the last tick, one per object; empty without collectReactions.
    [[nodiscard]] std::span<const ObjectReaction> reactions() const noexcept { return reactions_; }
    void clearReactions() noexcept {
        for (ObjectReaction& reaction : reactions_)
            reaction = {};
    }
    void push(int object, const body::HandPush& push) noexcept {
        if (!reactions_.empty()) {
            ObjectReaction& reaction = reactions_[static_cast<size_t>(object)];
            reaction.force += push.force;
            reaction.torque += glm::cross(push.point, push.force);
        }
        if (bodies_ != nullptr)
            pushBody(object, push);
        if (soft_ != nullptr) [[unlikely]]
            pushSoft(object, push);
    }

    /// Null where no body moves.
    [[nodiscard]] const std::shared_ptr<body::BodyWorld>& bodies() const noexcept { return bodies_; }
    /// Null where none is soft (never with WorldBodies::Shown).
    [[nodiscard]] const std::shared_ptr<SoftStates>& soft() const noexcept { return softStates_; }
    /// The bodies' state after `dt` s under the forces that were pushed, and the textures after the strokes
    /// of this tick. The last phase of a tick before safety.
    void integrate(const HapticSettings& settings, double dt) noexcept {
        if (bodies_ != nullptr)
            integrateBodies(settings, dt);
        if (soft_ != nullptr) [[unlikely]]
            integrateSoft(settings, dt);
        if (textures_ != nullptr) [[unlikely]]
            applyStrokes();
    }
    /// Of the scene's objects; null where none has one.
    [[nodiscard]] const std::shared_ptr<PersistentTextures>& textures() const noexcept { return textures_; }
    /// What a world of equal geometry may go on with.
    [[nodiscard]] CarriedOver carriedOver() const;
    /// Null where no caller moves objects.
    [[nodiscard]] const std::shared_ptr<DrivenObjects>& driven() const noexcept { return driven_; }
    /// Those of another world, of the same scene, which this one then reads and changes.
    void shareTextures(std::shared_ptr<PersistentTextures> textures) noexcept;
    /// WorldBodies::Shown: the next `advance` puts the bodies there.
    void showBodies(const body::BodyPoses& poses);
    /// Keeps the state of bodies or soft bodies before `tick` for another thread. False where there are none,
    /// or where that thread does not keep up. A replay that begins there shows the soft bodies that it
    /// restores: so does this one.
    [[nodiscard]] bool keepState(uint64_t tick) noexcept;
    /// The state that the rest of a recording depends on: of bodies or of soft bodies (no scene has both).
    [[nodiscard]] std::vector<std::byte> bodyState() const;
    /// That of a recording: as after the ticks before. False where the bytes do not fit.
    [[nodiscard]] bool restoreBodies(std::span<const std::byte> bytes) noexcept;
    /// BodyWorld::found of this tick.
    [[nodiscard]] uint32_t foundContacts() const noexcept;
    /// sceneFromMesh of every instance of the scene at this tick's poses. Allocates.
    [[nodiscard]] std::vector<glm::dmat4> sceneFromMesh() const;

  private:
    struct Mover {
        size_t object;                  // HapticScene::objects
        size_t instance;                // Scene::instances
        glm::dmat4 meshFromObject{1.0}; // rest pose: from the object's frame to the mesh's, uneven
        bool jumps = false;             // the animation does not end where it begins
    };

    void pushBody(int object, const body::HandPush& push) noexcept;
    void integrateBodies(const HapticSettings& settings, double dt) noexcept;
    void pushSoft(int object, const body::HandPush& push) noexcept;
    void integrateSoft(const HapticSettings& settings, double dt) noexcept;
    void advanceSoft(bool hold) noexcept;
    void stepSoftApart() const;
    [[nodiscard]] bool softHeld() const noexcept;
    void applyStrokes() noexcept;
    void findMovers(const HapticScene& haptic, std::shared_ptr<DeformingStates> deforming);
    void moveObjects(double time, bool hold) noexcept;
    void movePoses(double time) noexcept;
    void advanceBodies(double time) noexcept;

    ScenePtr scene_;
    const Animation* animation_ = nullptr;
    std::vector<ScenePose> pose_; // none or one: ScenePose has no empty state
    Similarity workspaceFromScene_;
    std::vector<Mover> movers_;
    std::vector<ObjectMotion> motions_;
    std::unique_ptr<DeformingObjects> deforming_; // null: none
    std::unique_ptr<SoftObjects> soft_;           // null: none
    std::shared_ptr<SoftStates> softStates_;      // of them
    const HapticScene* own_ = nullptr;            // of either; null: none
    ObjectMotions poses_;
    std::vector<ObjectReaction> reactions_;
    bool collects_ = false, still_ = false;
    std::shared_ptr<body::BodyWorld> bodies_;
    std::unique_ptr<body::BodyPoses> shown_; // WorldBodies::Shown
    std::shared_ptr<PersistentTextures> textures_;
    std::shared_ptr<DrivenObjects> driven_;
    std::vector<uint8_t> animated_;          // by object: a mover
    std::vector<glm::dmat4> objectFromMesh_; // by object
    std::vector<int> instanceOf_;            // by object
    double lap_ = 0.0;                       // of the animation, in the preceding tick
    bool sampled_ = false;
};

} // namespace touchstone
