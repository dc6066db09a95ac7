#pragma once
// EXT_meshopt_compression: one compressed buffer view. Source: the extension's specification; the streams are
// decoded by meshoptimizer.

#include "engine/import/file/gltf_file.h"

#include <string>
#include <vector>

namespace touchstone {

/// Decodes to exactly `length` bytes. `extension` is unchecked JSON and is fully checked here. Throws Error
/// when it is malformed, does not fit, or is broken.
[[nodiscard]] std::vector<uint8_t> decodeMeshoptView(const ImportContext& context, const std::string& place,
                                                     const nlohmann::json& extension, uint64_t length,
                                                     const std::vector<ByteSpan>& buffers);

} // namespace touchstone
