#pragma once

#include "engine/import/geometry/gltf_nodes.h"
#include "engine/scene/physics.h"

#include <memory>

namespace touchstone {

/// Rigid bodies of KHR_physics_rigid_bodies with the shapes of KHR_implicit_shapes (or KHR_collision_shapes,
/// their name in earlier drafts); a collider's geometry is `shape`, `mesh` or `node`. What is wrong is left
/// out with a warning. Null where nothing moves. Expects the scene's nodes and instances.
[[nodiscard]] std::shared_ptr<const Physics> readPhysicsBodies(ImportContext& context,
                                                               const GltfDocument& document,
                                                               const NodeForest& forest, const Scene& scene);

} // namespace touchstone
