#pragma once
// What the file says that a surface feels like (docs/materials.md): our extension, MPEG's in both spellings,
// KHR physics materials.

#include "engine/import/materials/gltf_materials.h"
#include "engine/scene/haptic_layers.h"

#include <vector>

namespace touchstone {

// MPEG maps carry no units: linear, R channel, 0..1. What we take them to mean:
/// Stiffness: this factor of the device's recommended stiffness, black to white. Black is soft, never
/// nothing.
inline constexpr float kMpegStiffnessMin = 0.1f, kMpegStiffnessMax = 1.0f;
/// Friction: static coefficient, black to white; the dynamic one is kSlidingShare of it.
inline constexpr float kMpegFrictionMin = 0.0f, kMpegFrictionMax = 1.0f;
/// KHR_physics_rigid_bodies' default for both coefficients.
inline constexpr float kPhysicsFriction = 0.6f;

/// What TOUCHSTONE_materials_haptic says of a material of the file. Throws Error where it says nonsense.
[[nodiscard]] HapticStatement readStatement(ImportContext& context, const GltfDocument& document,
                                            size_t material);

/// Adds what physics material `index` says; a broken one costs a warning.
void readPhysics(ImportContext& context, const GltfDocument& document, size_t index, HapticLayers& says);

/// The physics material of every node's mesh, -1 for none. A collider speaks for the mesh of its own node;
/// without one, for its geometry.node; without that, for the nearest ancestor that has a mesh.
[[nodiscard]] std::vector<int> physicsMaterialOfNodes(ImportContext& context, const GltfDocument& document);

} // namespace touchstone
