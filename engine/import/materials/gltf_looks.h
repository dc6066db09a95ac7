#pragma once
// Appearance beyond metallic-roughness: the KHR_materials_* extensions that the renderer draws.

#include "engine/import/materials/gltf_document.h"

#include <string>

namespace touchstone {

/// Fills the parts of `material` that the extensions of the file's material `stated` at `place` specify.
/// Invalid values become defaults or are clamped, with a warning: a colour cannot make the geometry wrong.
void readLookExtensions(ImportContext& context, const GltfDocument& document, const nlohmann::json& stated,
                        const std::string& place, Material& material);

} // namespace touchstone
