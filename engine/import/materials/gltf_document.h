#pragma once
// A validated glTF, ready for reading: its JSON, the same as typed structures, and its bytes.

#include "engine/import/file/gltf_buffers.h"
#include "engine/import/file/tinygltf.h"

#include <filesystem>

namespace touchstone {

/// MPEG's haptic materials: an array of objects, and its place in the file, for messages.
struct MpegMaterials {
    nlohmann::json list = nlohmann::json::array();
    std::string place;
};

/// `model` holds the core objects (accessors, meshes, nodes, materials, ...) typed; `json` is the whole file,
/// for extensions and for distinguishing stated values from defaults; `buffers` has the bytes.
struct GltfDocument {
    const nlohmann::json& json;
    tinygltf::Model model;
    BufferStore buffers;
    MpegMaterials mpeg;
    std::filesystem::path folder; ///< base of its URIs
};

/// tinygltf gets only the validated core of the JSON: no buffers, no images, no extras, no extensions. So it
/// opens no file, decodes nothing, and sees no unchecked data.
[[nodiscard]] GltfDocument makeDocument(ImportContext& context, const GltfFile& file);

} // namespace touchstone
