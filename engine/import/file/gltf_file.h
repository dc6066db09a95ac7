#pragma once
// The outermost layer: from the bytes of a .gltf or .glb to its JSON and binary chunk.

#include "engine/import/file/import_context.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

namespace touchstone {

using ByteSpan = std::span<const uint8_t>;

/// A parsed glTF file. `binary` points into `bytes`.
struct GltfFile {
    std::filesystem::path folder; ///< base of its URIs
    std::vector<uint8_t> bytes;
    nlohmann::json json; ///< an object, at most kMaxJsonDepth deep, kMaxJsonValues values
    bool isGlb = false;
    std::optional<ByteSpan> binary; ///< the GLB's BIN chunk
};

enum class Comments { Refuse, Ignore };

/// The JSON in `text`, within the limits of an import. Throws Error.
[[nodiscard]] nlohmann::json parseJson(ImportContext& context, ByteSpan text, Comments comments);

/// Reads a whole regular file. Throws Error (missing, a folder, unreadable, beyond kMaxFileBytes) and
/// Cancelled.
[[nodiscard]] std::vector<uint8_t> readWholeFile(const std::filesystem::path& path,
                                                 const std::string& shownAs, const Progress& progress = {});

/// Reads and parses `path`. Checks the GLB header and chunk table against the file's actual size.
[[nodiscard]] GltfFile readGltfFile(ImportContext& context, const std::filesystem::path& path);

/// The same for bytes in memory; URIs are relative to `folder`.
[[nodiscard]] GltfFile takeGltfApart(ImportContext& context, std::vector<uint8_t> bytes,
                                     const std::filesystem::path& folder);

} // namespace touchstone
