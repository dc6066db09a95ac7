#pragma once
// The vertex attributes of a primitive, from accessors or from a Draco stream, each checked as it is read.

#include "engine/import/materials/gltf_document.h"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// The raw arrays of one primitive: attribute name -> components per vertex and values.
struct RawAttribute {
    int components = 0;
    std::vector<float> values;
};

/// Contents of KHR_draco_mesh_compression: the attributes and the triangle list.
struct DracoPrimitive {
    std::map<std::string, RawAttribute> attributes;
    std::vector<uint32_t> indices;
};

/// Decodes the Draco extension of a primitive. The numbers of vertices and indices must be those of the
/// primitive's accessors. Throws Error when the stream is broken.
[[nodiscard]] DracoPrimitive decodeDraco(ImportContext& context, const GltfDocument& document,
                                         const nlohmann::json& extension,
                                         const tinygltf::Primitive& primitive, const std::string& place);

class MorphTargets;

/// Fills the vertex arrays of `mesh`, displaced by `morph`. Accessors that `draco` (may be null) does not
/// replace are read.
void readVertexAttributes(ImportContext& context, const GltfDocument& document,
                          const tinygltf::Primitive& primitive, DracoPrimitive* draco,
                          const MorphTargets& morph, const std::string& place, Mesh& mesh);

/// One attribute of the primitive, of `count` vertices and the given components, all finite and as stored:
/// not displaced. Throws Error otherwise. Removes it from `draco` (may be null).
[[nodiscard]] RawAttribute readAttribute(ImportContext& context, const GltfDocument& document,
                                         const tinygltf::Primitive& primitive, DracoPrimitive* draco,
                                         const std::string& place, const std::string& name, size_t count,
                                         int components);

} // namespace touchstone
