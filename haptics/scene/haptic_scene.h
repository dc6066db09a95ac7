#pragma once
// The scene for touch: welded objects with their BVH, haptic maps and the effect plan. Immutable after
// compileHapticScene; read by the servo, the oracle and the studies alike.

#include "engine/core/built_once.h"
#include "engine/math/object_motion.h"
#include "engine/math/similarity.h"
#include "engine/scene/scene.h"
#include "haptics/settings/effect_plan.h"
#include "haptics/shape/mesh/haptic_object.h"
#include "haptics/shape/mesh/mesh_adjacency.h"
#include "haptics/texture/haptic_material.h"
#include "haptics/texture/texel_map.h"

#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

class HapticScene {
  public:
    HapticScene() = default;
    HapticScene(const HapticScene&) = delete;
    HapticScene& operator=(const HapticScene&) = delete;

    std::vector<std::shared_ptr<const HapticObject>> objects; ///< one per Scene instance with triangles
    /// Of a part of a scene (partOf): the objects of the whole one, so that bodies have the mass and size of
    /// theirs whatever is hidden or cut. Empty: it is whole.
    std::vector<std::shared_ptr<const HapticObject>> wholeObjects;
    std::vector<ObjectMotion> restMotions;     ///< one per object: at rest
    std::vector<glm::dvec4> restSpheres;       ///< one per object: boundingSphere at rest
    std::vector<double> boundingRadii;         ///< one per object: HapticObject::boundingRadius, side by side
    std::vector<HapticMaterialData> materials; ///< index = Scene material
    /// One per object where some material has a program, else empty: the frame of programs
    /// (engine/scene/program_frame.h), from the object's.
    std::vector<Similarity> programFromObject;
    /// One per object where some material has a persistent texture, else empty: where its texels lie; null
    /// for an object without one.
    std::vector<std::shared_ptr<const TexelMap>> texels;
    EffectPlan plan;
    Similarity workspaceFromScene;
    std::vector<Warning> warnings;

    /// True once every object's `rays` is built, so that contact=rays can touch it. Wait-free.
    [[nodiscard]] bool hasRays() const noexcept { return hasRays_.load(std::memory_order_acquire); }
    /// Any thread but the servo. Throws Error when Embree fails, and Cancelled.
    void buildRays(const Progress& progress = {}) const;

    /// Adjacency for contact=neighbourhood, one per object; null until built. Wait-free.
    [[nodiscard]] const std::vector<MeshAdjacency>* neighbourhoods() const noexcept {
        return neighbourhoods_.get();
    }
    /// Any thread but the servo. Also builds the rays.
    void buildNeighbourhoods() const;
    /// Shares those of a scene of the same geometry, if it has them. Before the scene is handed to a servo.
    void shareNeighbourhoods(const HapticScene& other) { neighbourhoods_.share(other.neighbourhoods_); }

    /// Slopes for textureGradient=precomputed, one per material (empty without a height map); null until
    /// built, and until then a tick computes the same values from the texels. Wait-free.
    [[nodiscard]] const std::vector<HapticMap::Slopes>* slopes() const noexcept { return slopes_.get(); }
    /// Any thread but the servo.
    void buildSlopes() const;

  private:
    mutable std::atomic<bool> hasRays_{false};
    BuiltOnce<std::vector<MeshAdjacency>> neighbourhoods_;
    BuiltOnce<std::vector<HapticMap::Slopes>> slopes_;
};

/// Recomputes which stages the scene's materials need. Before the scene is handed to a servo.
void settlePlan(HapticScene& scene);

/// A scene of its own on the same geometry, without neighbourhoods, slopes and warnings: for trial changes.
[[nodiscard]] std::shared_ptr<HapticScene> copyOf(const HapticScene& scene);

/// The scene `compiled` with other materials. `before` is what it was compiled from, `after` the new
/// materials, both with one entry for each material of `scene`, whose meshes and images it has. Geometry,
/// maps and search trees are shared; where other attributes are read, or `sides` differs, the object is
/// rebuilt with equal geometry, so that touch continues on the new scene (ServoLoop::offerScene). Any thread
/// but the servo; throws Error.
[[nodiscard]] std::shared_ptr<HapticScene> withMaterials(const HapticScene& compiled, const Scene& scene,
                                                         std::span<const Material> before,
                                                         std::span<const Material> after);

/// Removes one effect from a material and its objects, and updates the plan. Only on a copy.
void removeEffect(HapticScene& scene, int material, Effect effect);

struct CompileOptions {
    /// False: HapticScene::buildRays is called on demand. contact=sweep never needs it; building the rays
    /// takes a third of the time to build a scene, and half of its memory.
    bool rays = true;
    Progress progress;
};

/// Builds what touch needs and nothing that no material uses. Any thread but the servo; throws Error, and
/// Cancelled.
[[nodiscard]] std::shared_ptr<const HapticScene> compileHapticScene(const Scene& scene,
                                                                    const Similarity& workspaceFromScene,
                                                                    const CompileOptions& options = {});

} // namespace touchstone
