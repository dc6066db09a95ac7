#pragma once
// URIs of buffers and images: data URIs, or files inside the model's own folder only.

#include "engine/import/file/import_context.h"

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

struct DataUri {
    std::string mediaType; ///< lower case, without parameters; may be empty
    std::vector<uint8_t> bytes;
};

[[nodiscard]] bool isDataUri(std::string_view uri);

/// Decodes `data:[type][;parameter=value]*[;base64],payload`. Throws Error at `place` when malformed.
[[nodiscard]] DataUri decodeDataUri(const ImportContext& context, const std::string& place,
                                    std::string_view uri);

/// `data:` URI of bytes, base64.
[[nodiscard]] std::string dataUriOf(std::string_view mediaType, std::span<const uint8_t> bytes);

/// The file of a relative URI, inside `folder`. Percent-escapes are decoded first and the result is checked:
/// absolute paths, `..`, schemes and NUL are refused with Error. `\` counts as a separator, because exporters
/// write it. The file need not exist. Symbolic links in the folder are the user's own and followed.
[[nodiscard]] std::filesystem::path resolveUri(const ImportContext& context, const std::string& place,
                                               const std::filesystem::path& folder, std::string_view uri);

} // namespace touchstone
