#pragma once
// The kind of a file: glTF 2.0, or another format that people open by mistake.

#include "engine/import/file/import_context.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <span>

namespace touchstone {

/// Throws Error naming the format where `bytes`, which are neither a GLB nor begin like JSON, are a Git LFS
/// pointer, a web page, an archive, another 3D format or a picture. Returns for an unknown format.
void refuseOtherFormats(const ImportContext& context, std::span<const uint8_t> bytes);

/// Throws Error for a file of glTF 1.0, whose JSON has another structure, and for any version but 2.x.
/// Ignores a missing or malformed version, which checkSchema refuses.
void checkGltfVersion(const ImportContext& context, const nlohmann::json& gltf);

/// How to convert glTF 1.0, for a message.
inline constexpr const char* kConvertGltf1 =
    "convert it to glTF 2.0, for example with: npx gltf-pipeline -i old.gltf -o new.gltf";

} // namespace touchstone
