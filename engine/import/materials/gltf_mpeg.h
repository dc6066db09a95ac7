#pragma once
// MPEG's haptic materials (ISO/IEC 23090-14). Its drafts and its public sample differ in the place and the
// notation of the materials; all of these are read:
// - the extension is MPEG_haptic_material or MPEG_material_haptic;
// - its root object holds `materials`, or is the array of materials itself, or is one material;
// - the root object is in the model's file or in "extensions.gltf" beside it, which may hold comments;
// - a mesh refers to a material by {"hapticMaterialIndex": i} or by i;
// - a channel is an array of maps or one map; a map is {"texture": textureInfo or index, "type"} or a
//   textureInfo.
// Anything else costs a warning: touch continues without it.

#include "engine/import/materials/gltf_document.h"
#include "engine/scene/haptic_layers.h"

#include <optional>

namespace touchstone {

/// The materials of the file, or of the one beside it; empty without them.
[[nodiscard]] MpegMaterials findMpegMaterials(ImportContext& context, const GltfFile& file);

/// The MPEG material of a mesh; empty if it has none.
[[nodiscard]] std::optional<int> mpegMaterialOf(ImportContext& context, const GltfDocument& document,
                                                size_t mesh);

/// Adds the statements of material `index` to `says`.
void readMpeg(ImportContext& context, const GltfDocument& document, size_t index, HapticLayers& says);

} // namespace touchstone
