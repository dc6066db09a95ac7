#pragma once
// What objects have in common whose vertices move from one publication to the next, whatever publishes them.

#include "haptics/scene/haptic_scene.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace touchstone {

/// The interval between two publications of a mesh: its vertices move straight from the first to the second.
struct MeshInterval {
    TriangleTree tree;    ///< its boxes hold each triangle at both ends and between
    double longest = 0.0; ///< way of a vertex, object units
    double radius = 0.0;  ///< about the object's origin, of both ends

    void fit(std::span<const glm::vec3> from, std::span<const glm::vec3> to,
             std::span<const uint32_t> indices) noexcept;
};

/// A place in an interval. What it points to lasts until the next tick has begun.
struct MeshMoment {
    const MeshInterval* interval = nullptr;
    VertexBlend places, normals; ///< normals.from null: none
};

/// An object of a scene that is the servo's own.
struct MovedMesh {
    size_t object = 0; ///< HapticScene::objects
    std::shared_ptr<HapticObject> own;
    MeshInstant instant;

    /// A tick in which the vertices move from `before` to `now`, each by `travel` at most (object units).
    /// `moves`: what is kept from tick to tick is not kept here, also where `travel` is 0.
    void step(HapticScene& scene, const MeshMoment& before, const MeshMoment& now, double travel,
              bool moves) noexcept;
};

} // namespace touchstone
