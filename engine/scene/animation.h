#pragma once
// Poses at a time: samples glTF node animation and composes the poses of the instances.

#include "engine/scene/scene.h"

#include <span>
#include <vector>

namespace touchstone {

/// The animation that plays in a loop, for the hand and for the eye: Scene::animation, else the first one
/// that moves or deforms an instance, else the first one that moves a node (a camera). Null: nothing moves.
[[nodiscard]] const Animation* playedAnimation(const Scene& scene);

/// By node: whether the animation moves it, by itself or through a parent.
[[nodiscard]] std::vector<bool> movedNodes(const Scene& scene, const Animation& animation);

/// One channel at `time` s: clamped to its first and last key (glTF 2.0, section 3.11). Linear rotations are
/// slerped along the short arc, cubic ones normalised. Rotations are x, y, z, w. Any thread, no allocation.
[[nodiscard]] glm::dvec4 sampleChannel(const AnimationChannel& channel, double time) noexcept;

/// A channel of morph weights at `time`: that of target `target`, below channel.targets.
[[nodiscard]] double sampleWeight(const AnimationChannel& channel, size_t target, double time) noexcept;

/// True where the animation moves the instance or deforms its mesh. `moved`: movedNodes of the animation.
[[nodiscard]] bool animates(const Scene& scene, const Animation& animation, const std::vector<bool>& moved,
                            const Instance& instance);

/// The static pose of a node relative to its parent.
[[nodiscard]] glm::dmat4 parentFromNode(const Node& node) noexcept;

/// The static pose of every node in the scene. Parents come before children.
[[nodiscard]] std::vector<glm::dmat4> sceneFromNodes(const std::vector<Node>& nodes);

/// sceneFromMesh of every instance of a scene at a time. The constructor allocates; `evaluate` allocates
/// nothing, takes no lock and does not throw, so the servo may call it. Not shared between threads.
class ScenePose {
  public:
    explicit ScenePose(const Scene& scene);

    /// `animation` null: the static pose. `time` is in the animation's own seconds; wrap it to loop.
    void evaluate(const Scene& scene, const Animation* animation, double time) noexcept;

    /// By instance, as of the last `evaluate` (the static pose before any).
    [[nodiscard]] std::span<const glm::dmat4> sceneFromMesh() const { return sceneFromMesh_; }
    /// By node, likewise.
    [[nodiscard]] std::span<const glm::dmat4> sceneFromNode() const { return sceneFromNode_; }
    /// The morph weights that the animation gives a node; empty where it gives none.
    [[nodiscard]] std::span<const double> weightsOf(int node) const noexcept;

  private:
    /// Weights of a node that some animation of the file drives.
    struct NodeWeights {
        int node = -1;
        size_t first = 0, count = 0; // in weights_
        bool driven = false;         // by the animation of the last `evaluate`
    };
    struct LocalPose {
        glm::dvec3 translation, scale;
        glm::dquat rotation;
    };
    std::vector<LocalPose> local_;
    std::vector<glm::dmat4> sceneFromNode_, sceneFromMesh_;
    std::vector<NodeWeights> nodeWeights_;
    std::vector<double> weights_;
};

/// The same as one pure call, for use outside the servo.
[[nodiscard]] std::vector<glm::dmat4> sceneFromMeshAt(const Scene& scene, const Animation* animation,
                                                      double time);

/// `time` wrapped into the animation, so that it repeats without end; 0 if its duration is 0.
[[nodiscard]] double loopedTime(const Animation& animation, double time) noexcept;

} // namespace touchstone
