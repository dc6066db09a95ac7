#pragma once
// The haptic properties of a file's surfaces (docs/materials.md): the project's extension, MPEG's in both
// spellings, KHR physics materials.

#include "engine/import/materials/gltf_materials.h"
#include "engine/scene/haptic_layers.h"

#include <vector>

namespace touchstone {

// MPEG maps carry no units: linear, R channel, 0..1. They are interpreted as follows.
/// Stiffness: this factor of the device's recommended stiffness, black to white. Black is soft, but not zero.
inline constexpr float kMpegStiffnessMin = 0.1f, kMpegStiffnessMax = 1.0f;
/// Friction: static coefficient, black to white; the dynamic one is kSlidingShare of it.
inline constexpr float kMpegFrictionMin = 0.0f, kMpegFrictionMax = 1.0f;
/// KHR_physics_rigid_bodies' default for both coefficients.
inline constexpr float kPhysicsFriction = 0.6f;

/// The statement of TOUCHSTONE_materials_haptic for a material of the file. Throws Error where it is invalid.
[[nodiscard]] HapticStatement readStatement(ImportContext& context, const GltfDocument& document,
                                            size_t material, ShaderReader& shaders);

/// Adds physics material `index`; a broken one costs a warning.
void readPhysics(ImportContext& context, const GltfDocument& document, size_t index, HapticLayers& says);

/// The physics material of every node's mesh, -1 for none. A collider applies to the mesh of its own node;
/// without one, to its geometry.node; without that, to the nearest ancestor that has a mesh.
[[nodiscard]] std::vector<int> physicsMaterialOfNodes(ImportContext& context, const GltfDocument& document);

} // namespace touchstone
