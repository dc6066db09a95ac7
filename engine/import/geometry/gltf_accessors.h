#pragma once
// Reads accessors into plain arrays: strides, sparse replacement, normalised integers.

#include "engine/import/materials/gltf_document.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

[[nodiscard]] size_t accessorCount(const GltfDocument& document, int accessor);
/// False if the file does not contain the accessor's bytes (BufferStore::hasData).
[[nodiscard]] bool accessorHasData(const GltfDocument& document, int accessor);
[[nodiscard]] int accessorComponents(const GltfDocument& document, int accessor);

/// All components as float, `accessorComponents` per element. Integers are divided by their largest value
/// when the accessor is `normalized` (signed ones are clamped at -1). Not for matrices. Spends geometry
/// memory.
[[nodiscard]] std::vector<float> readFloats(ImportContext& context, const GltfDocument& document,
                                            int accessor, const std::string& place);

/// The first `count` matrices of a MAT4 accessor of floats. Fails for other types and for fewer matrices.
/// Spends geometry memory.
[[nodiscard]] std::vector<glm::mat4> readMatrices(ImportContext& context, const GltfDocument& document,
                                                  int accessor, size_t count, const std::string& place);

/// The range of an accessor's stored values: not normalised, with the sparse values in place.
struct StoredRange {
    std::vector<double> low,
        high;          ///< by component, over the finite values; infinity and -infinity where there is none
    size_t broken = 0; ///< number of values that are not finite
};
/// Not for matrices.
[[nodiscard]] StoredRange storedRange(ImportContext& context, const GltfDocument& document, int accessor,
                                      const Progress& progress);

/// A SCALAR accessor of unsigned integers. Fails for other types.
[[nodiscard]] std::vector<uint32_t> readIndices(ImportContext& context, const GltfDocument& document,
                                                int accessor, const std::string& place);
/// The largest value of an index accessor's type, which graphics interfaces treat as the end of a strip.
[[nodiscard]] uint32_t restartIndex(const GltfDocument& document, int accessor);

} // namespace touchstone
