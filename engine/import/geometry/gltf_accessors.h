#pragma once
// Accessors to plain arrays: strides, sparse replacement, normalised integers.

#include "engine/import/materials/gltf_document.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

[[nodiscard]] size_t accessorCount(const GltfDocument& document, int accessor);
/// False if the bytes that it reads are not in the file (BufferStore::hasData).
[[nodiscard]] bool accessorHasData(const GltfDocument& document, int accessor);
[[nodiscard]] int accessorComponents(const GltfDocument& document, int accessor);

/// All components as float, `accessorComponents` per element. Integers are divided by their largest value
/// when the accessor says `normalized` (signed ones are clamped at -1). Not for matrices. Spends geometry
/// memory.
[[nodiscard]] std::vector<float> readFloats(ImportContext& context, const GltfDocument& document,
                                            int accessor, const std::string& place);

/// The first `count` matrices of a MAT4 accessor of floats. Fails for other types and for fewer matrices.
/// Spends geometry memory.
[[nodiscard]] std::vector<glm::mat4> readMatrices(ImportContext& context, const GltfDocument& document,
                                                  int accessor, size_t count, const std::string& place);

/// What the numbers of an accessor are as stored: not normalised, with the sparse values in place.
struct StoredRange {
    std::vector<double> low,
        high;          ///< by component, of the finite ones; infinity and -infinity where there is none
    size_t broken = 0; ///< not finite
};
/// Not for matrices.
[[nodiscard]] StoredRange storedRange(ImportContext& context, const GltfDocument& document, int accessor,
                                      const Progress& progress);

/// A SCALAR accessor of unsigned integers. Fails for other types.
[[nodiscard]] std::vector<uint32_t> readIndices(ImportContext& context, const GltfDocument& document,
                                                int accessor, const std::string& place);
/// The largest value of the type of an index accessor, which graphics interfaces take for the end of a strip.
[[nodiscard]] uint32_t restartIndex(const GltfDocument& document, int accessor);

} // namespace touchstone
