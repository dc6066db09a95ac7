#pragma once
// Primitives to indexed triangle lists.

#include "engine/scene/import/gltf_document.h"

#include <optional>

namespace touchstone {

/// Builds one primitive. Nothing if it holds no triangles by its nature (points, lines, no positions), with a
/// warning. Strips, fans and missing indices become lists; degenerate index triples are dropped; missing
/// normals become flat ones (vertices split); missing tangents are generated where `material` needs them.
/// `mesh.material` is left to the caller. Throws Error for indices out of range, values that are not finite,
/// and counts that differ.
[[nodiscard]] std::optional<Mesh> buildMesh(ImportContext& context, const GltfDocument& document,
                                            size_t meshIndex, size_t primitiveIndex,
                                            const Material& material);

} // namespace touchstone
