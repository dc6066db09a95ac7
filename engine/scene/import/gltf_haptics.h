#pragma once
// What the file says that a surface feels like (DESIGN §6): our extension, MPEG's in both spellings, KHR
// physics materials. Precedence is per field: ours, MPEG, physics, then what PBR gives (deriveFriction).

#include "engine/scene/import/gltf_materials.h"

#include <optional>

namespace touchstone {

// MPEG maps carry no units: linear, R channel, 0..1. What we take them to mean:
/// Stiffness: this factor of the device's recommended stiffness, black to white. Black is soft, never
/// nothing.
inline constexpr float kMpegStiffnessMin = 0.1f, kMpegStiffnessMax = 1.0f;
/// Friction: static coefficient, black to white; the dynamic one is kSlidingShare of it.
inline constexpr float kMpegFrictionMin = 0.0f, kMpegFrictionMax = 1.0f;
/// Share of the static coefficient that is left while sliding, where the file gives only one value.
inline constexpr float kSlidingShare = 0.8f;
/// KHR_physics_rigid_bodies' default for both coefficients.
inline constexpr float kPhysicsFriction = 0.6f;

/// Checks the root-level extension objects once (types, references). Throws Error naming the field.
void checkHapticExtensions(ImportContext& context, const GltfDocument& document);

/// Reads all fields for one surface. Starts from nothing; every field gets its source.
void readHaptics(ImportContext& context, const GltfDocument& document, const SurfaceKey& key,
                 HapticMaterial& haptic);

/// MPEG's material of a mesh, in either spelling; nothing if it has none.
[[nodiscard]] std::optional<int> mpegMaterialOf(ImportContext& context, const GltfDocument& document,
                                                size_t mesh);

/// The physics material of every node's mesh, -1 for none. A collider speaks for the mesh of its own node;
/// without one, for its geometry.node; without that, for the nearest ancestor that has a mesh.
[[nodiscard]] std::vector<int> physicsMaterialOfNodes(ImportContext& context, const GltfDocument& document);

/// Friction from the roughness that the file states, where no extension gave one:
///   mu_s = 0.15 + 0.6 roughness,  mu_d = kSlidingShare mu_s,
/// so a mirror feels like polished glass (0.15) and a fully rough surface like dry rubber on wood (0.75).
/// `meanRoughness` is the roughness factor times the texture's mean green; nothing derives nothing.
void deriveFriction(HapticMaterial& haptic, std::optional<float> meanRoughness);

} // namespace touchstone
