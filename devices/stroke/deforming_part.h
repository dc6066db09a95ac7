#pragma once
// A stroke on a mesh that the scene's animation deforms: each stretch of the path moves with the triangle
// that it is laid on.

#include "devices/stroke/stroke_path.h"
#include "devices/surface/triangle_source.h"
#include "engine/math/similarity.h"
#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "engine/scene/scene.h"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchstone {

/// An instance whose vertices the played animation moves. Device frame. The scene outlives it. One thread.
class DeformingPart {
  public:
    static constexpr size_t kMostPoses = 64; ///< of the animation, that boxAround has boxes of

    /// `parts`: of the scene, which share time and memory.
    DeformingPart(const Scene& scene, const Animation& animation, size_t instance,
                  const Similarity& deviceFromScene, size_t parts);

    /// The places that it takes around a share of the animation, 0 to 1.
    [[nodiscard]] Bounds boxAround(double share) const;

    /// `laid`, which holds on the surface at rest, carried by it: a hand keeps its distance from the
    /// triangle under it, in m. Nullopt where in one of 8 to kMostPoses moments of the animation the hand
    /// would be too deep, in one of the boxes of `keepOut`, or in the air with another part of the surface
    /// between it and the triangle. `mayJump`: also where the animation starts again at another place and
    /// takes the hand there through the surface, or while it presses.
    [[nodiscard]] std::optional<StrokePath> carried(const StrokePath& laid, double depth,
                                                    std::span<const Bounds> keepOut, bool mayJump) const;

  private:
    using Places = std::vector<glm::dvec3>; ///< m, by vertex of the mesh
    /// A triangle under the path and the place on it.
    struct Anchor {
        size_t triangle = 0;
        glm::dvec3 weights{1.0, 0.0, 0.0}; ///< of its corners
    };
    struct Moment {
        double time = 0.0; ///< s
        Places places;
    };
    /// Evaluates the vertices at a moment of the animation.
    class Poser;

    [[nodiscard]] double timeOf(size_t pose) const; ///< s
    [[nodiscard]] const std::vector<Moment>& moments() const;
    [[nodiscard]] TriangleSource trianglesAt(const Places& places) const;
    [[nodiscard]] bool isFreeAt(const Moment& moment, const StrokePath& path, std::span<const Anchor> anchors,
                                double depth, const StrokePath* last) const;
    [[nodiscard]] std::vector<Anchor> anchorsAlong(const StrokePath& path) const;
    [[nodiscard]] glm::dvec3 placeOf(const Anchor& anchor, const Places& places) const;
    /// From rest to the given places, about the anchor. `before`: in the sample before; null: none.
    [[nodiscard]] Similarity motionOf(const Anchor& anchor, const Places& places,
                                      const Similarity* before) const;
    [[nodiscard]] PathMotion motionOf(std::span<const Anchor> anchors) const;

    const Scene& scene_;
    const Animation& animation_;
    size_t instance_;
    Similarity deviceFromScene_;
    const Mesh& mesh_;
    int front_ = 0;                       ///< SurfaceTriangle::front
    Places rest_;                         ///< in the static pose
    size_t poses_ = 0;                    ///< at equal times from 0 on, before the animation's end
    std::vector<Bounds> boxes_;           ///< by pose, and at the animation's end
    mutable std::vector<Moment> moments_; ///< the poses, in an order in which neighbours are far apart
};

} // namespace touchstone
