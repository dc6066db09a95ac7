// KHR_draco_mesh_compression, decoded by libdraco.
#include "engine/import/file/gltf_schema.h"
#include "engine/import/file/json_fields.h"
#include "engine/import/geometry/gltf_accessors.h"
#include "engine/import/geometry/vertex_attributes.h"

#include <draco/compression/decode.h>

namespace touchstone {
namespace {

using nlohmann::json;

std::unique_ptr<draco::Mesh> decodeStream(ImportContext& context, ByteSpan stream, const std::string& place) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    const auto type = draco::Decoder::GetEncodedGeometryType(&buffer);
    if (!type.ok() || type.value() != draco::TRIANGULAR_MESH)
        context.fail(place, "the Draco stream holds no triangle mesh");
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok())
        context.fail(place,
                     std::string("the Draco stream is broken: ") + decoded.status().error_msg_string());
    return std::move(decoded).value();
}

RawAttribute copyAttribute(ImportContext& context, const draco::Mesh& mesh,
                           const draco::PointAttribute& source, bool normalized, const std::string& place) {
    RawAttribute copy;
    copy.components = source.num_components();
    if (copy.components < 1 || copy.components > 4)
        context.fail(place, "the Draco stream has an attribute of " + std::to_string(copy.components) +
                                " components");
    const size_t components = static_cast<size_t>(copy.components);
    context.spendGeometry(mesh.num_points() * components * sizeof(float), place);
    copy.values.resize(mesh.num_points() * components);
    draco::PointAttribute view; // ConvertValue divides integers by their range only if normalised
    const bool divides = source.normalized() == normalized;
    if (!divides) {
        view.CopyFrom(source);
        view.set_normalized(normalized);
    }
    const draco::PointAttribute& attribute = divides ? source : view;
    for (uint32_t point = 0; point < mesh.num_points(); ++point) {
        const auto value = attribute.mapped_index(draco::PointIndex(point));
        if (value.value() >= attribute.size() ||
            !attribute.ConvertValue<float>(value, static_cast<int8_t>(copy.components),
                                           &copy.values[point * components]))
            context.fail(place, "the Draco stream has a value that cannot be read");
    }
    return copy;
}

} // namespace

DracoPrimitive decodeDraco(ImportContext& context, const GltfDocument& document, const json& extension,
                           const tinygltf::Primitive& primitive, const std::string& place) {
    const auto view =
        indexField(context, extension, "bufferView", place, document.model.bufferViews.size(), "bufferViews");
    if (!view)
        context.fail(place, "property 'bufferView' is missing");
    const auto names = extension.find("attributes");
    if (names == extension.end() || !names->is_object())
        context.fail(place + ".attributes", "should be an object");
    if (!document.buffers.hasData(static_cast<size_t>(*view)))
        context.fail(place + ".bufferView", "its buffer has no data");
    if (primitive.indices < 0)
        context.fail(place, "the primitive has no indices accessor, which Draco needs");
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
        context.fail(place, "the primitive has no POSITION accessor, which Draco needs");
    const size_t vertices = accessorCount(document, position->second),
                 indices = accessorCount(document, primitive.indices);
    context.spendGeometry(indices * sizeof(uint32_t), place);

    const auto mesh = decodeStream(context, document.buffers.view(static_cast<size_t>(*view)), place);
    if (mesh->num_points() != vertices)
        context.fail(place, "the Draco stream has " + std::to_string(mesh->num_points()) +
                                " vertices, the accessor " + std::to_string(vertices));
    if (static_cast<size_t>(mesh->num_faces()) * 3 != indices)
        context.fail(place, "the Draco stream has " + std::to_string(mesh->num_faces()) +
                                " triangles, the accessor " + std::to_string(indices) + " indices");

    DracoPrimitive result;
    for (const auto& [name, id] : names->items()) {
        const std::string at = place + ".attributes." + name;
        if (!id.is_number() || !isWhole(id.get<double>()) || id.get<double>() < 0.0 ||
            id.get<double>() > 4294967295.0)
            context.fail(at, "should be an attribute id");
        const draco::PointAttribute* attribute = mesh->GetAttributeByUniqueId(id.get<uint32_t>());
        if (attribute == nullptr)
            context.fail(at, "the Draco stream has no attribute " + id.dump());
        const auto accessor = primitive.attributes.find(name);
        if (accessor == primitive.attributes.end())
            continue;
        const bool normalized = document.model.accessors[static_cast<size_t>(accessor->second)].normalized;
        result.attributes.emplace(name, copyAttribute(context, *mesh, *attribute, normalized, at));
    }
    if (!result.attributes.contains("POSITION"))
        context.fail(place, "the Draco stream has no POSITION");
    result.indices.reserve(indices);
    for (uint32_t f = 0; f < mesh->num_faces(); ++f)
        for (const draco::PointIndex& point : mesh->face(draco::FaceIndex(f)))
            result.indices.push_back(point.value());
    return result;
}

} // namespace touchstone
