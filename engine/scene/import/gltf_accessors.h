#pragma once
// Accessors to plain arrays: strides, sparse replacement, normalised integers.

#include "engine/scene/import/gltf_document.h"

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

[[nodiscard]] size_t accessorCount(const GltfDocument& document, int accessor);
[[nodiscard]] int accessorComponents(const GltfDocument& document, int accessor);

/// All components as float, `accessorComponents` per element. Integers are divided by their largest value
/// when the accessor says `normalized` (signed ones are clamped at -1). Not for matrices. Spends geometry
/// memory.
[[nodiscard]] std::vector<float> readFloats(ImportContext& context, const GltfDocument& document,
                                            int accessor, const std::string& place);

/// A SCALAR accessor of unsigned integers. Fails for other types and for the primitive-restart value.
[[nodiscard]] std::vector<uint32_t> readIndices(ImportContext& context, const GltfDocument& document,
                                                int accessor, const std::string& place);

} // namespace touchstone
