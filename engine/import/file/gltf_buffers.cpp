#include "engine/import/file/gltf_buffers.h"

#include "engine/import/file/gltf_uri.h"
#include "engine/import/file/meshopt_view.h"

namespace touchstone {
namespace {

using nlohmann::json;

const json* meshoptExtension(const json& object) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end())
        return nullptr;
    const auto found = extensions->find("EXT_meshopt_compression");
    return found == extensions->end() ? nullptr : &*found;
}

/// A buffer that only declares the size of its views' decompressed bytes.
bool isFallback(const json& buffer) {
    const json* extension = meshoptExtension(buffer);
    return extension != nullptr && extension->is_object() &&
           extension->value("fallback", json()) == json(true);
}

std::vector<uint8_t> dataUriBytes(const ImportContext& context, const std::string& place,
                                  const std::string& uri) {
    DataUri data = decodeDataUri(context, place, uri);
    // The two types of the specification, or none, as some exporters write.
    if (data.mediaType != "application/octet-stream" && data.mediaType != "application/gltf-buffer" &&
        !data.mediaType.empty())
        context.fail(place, "the data URI of a buffer must be application/octet-stream, not \"" +
                                data.mediaType.substr(0, 60) + "\"");
    return std::move(data.bytes);
}

} // namespace

BufferStore::BufferStore(ImportContext& context, const GltfFile& file) {
    loadBuffers(context, file);
    loadViews(context, file);
}

void BufferStore::loadBuffers(ImportContext& context, const GltfFile& file) {
    if (!file.json.contains("buffers"))
        return;
    const json& buffers = file.json["buffers"];
    for (size_t i = 0; i < buffers.size(); ++i) {
        context.stopIfCancelled();
        const std::string place = element("buffers", i);
        const uint64_t length = buffers[i]["byteLength"];
        ByteSpan bytes;
        if (buffers[i].contains("uri")) {
            bytes = bytesOfUri(context, file, buffers[i]["uri"], place + ".uri");
        } else if (i == 0 && file.binary) {
            bytes = *file.binary;
            context.countFileBytes(bytes.size());
        } else if (i == 0 && file.isGlb && !isFallback(buffers[i])) {
            context.fail(place, "is the GLB's binary chunk, but the file has none",
                         "copy or re-export the file");
        } else {
            buffers_.push_back({});
            continue;
        }
        if (bytes.size() < length)
            context.fail(place,
                         "has " + std::to_string(bytes.size()) + " bytes, but byteLength says " +
                             std::to_string(length),
                         "the file is truncated or was changed: re-export the model");
        buffers_.push_back(bytes.first(length));
    }
}

ByteSpan BufferStore::bytesOfUri(ImportContext& context, const GltfFile& file, const std::string& uri,
                                 const std::string& place) {
    if (isDataUri(uri)) {
        owned_.push_back(dataUriBytes(context, place, uri));
        context.countFileBytes(owned_.back().size());
        return owned_.back();
    }
    const auto path = resolveUri(context, place, file.folder, uri);
    // Several buffers may be the same file; it is read and kept once.
    const auto [known, isNew] = files_.try_emplace(path);
    if (isNew) {
        if (!std::filesystem::exists(path))
            context.fail(place, "the file \"" + uri + "\" is missing",
                         "copy it beside the model, or export as .glb");
        owned_.push_back(readWholeFile(path, path.string()));
        context.countFileBytes(owned_.back().size());
        known->second = owned_.back();
    }
    return known->second;
}

void BufferStore::loadViews(ImportContext& context, const GltfFile& file) {
    if (!file.json.contains("bufferViews"))
        return;
    const json& views = file.json["bufferViews"];
    for (size_t i = 0; i < views.size(); ++i) {
        context.stopIfCancelled();
        const std::string place = element("bufferViews", i);
        const uint64_t offset = views[i].value("byteOffset", uint64_t{0}), length = views[i]["byteLength"];
        if (const json* extension = meshoptExtension(views[i])) {
            context.spendGeometry(length, place);
            owned_.push_back(decodeMeshoptView(context, place + ".extensions.EXT_meshopt_compression",
                                               *extension, length, buffers_));
            views_.push_back(owned_.back());
            continue;
        }
        const ByteSpan buffer = buffers_[views[i]["buffer"].get<size_t>()];
        views_.push_back(buffer.empty() ? buffer : buffer.subspan(offset, length));
    }
}

} // namespace touchstone
