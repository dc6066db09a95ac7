#include "engine/import/file/meshopt_view.h"

#include "engine/import/file/gltf_schema.h"

#include <meshoptimizer.h>

namespace touchstone {
namespace {

using nlohmann::json;

uint64_t countField(const ImportContext& context, const std::string& place, const json& extension,
                    const char* name, uint64_t low, uint64_t high, const uint64_t* fallback = nullptr) {
    const auto found = extension.find(name);
    if (found == extension.end() && fallback != nullptr)
        return *fallback;
    if (found == extension.end())
        context.fail(place, std::string("property '") + name + "' is missing");
    if (!found->is_number() || !isWhole(found->get<double>()))
        context.fail(place + "." + name, "should be an integer");
    if (found->get<double>() < static_cast<double>(low) || found->get<double>() > static_cast<double>(high))
        context.fail(place + "." + name, found->dump() + " is out of range");
    return found->get<uint64_t>();
}

std::string textField(const ImportContext& context, const std::string& place, const json& extension,
                      const char* name, const char* fallback) {
    const auto found = extension.find(name);
    if (found == extension.end())
        return fallback;
    if (!found->is_string())
        context.fail(place + "." + name, "should be a string");
    return found->get<std::string>();
}

int decode(const std::string& mode, std::vector<uint8_t>& out, size_t count, size_t stride, ByteSpan data) {
    if (mode == "ATTRIBUTES")
        return meshopt_decodeVertexBuffer(out.data(), count, stride, data.data(), data.size());
    if (mode == "TRIANGLES")
        return meshopt_decodeIndexBuffer(out.data(), count, stride, data.data(), data.size());
    return meshopt_decodeIndexSequence(out.data(), count, stride, data.data(), data.size());
}

} // namespace

std::vector<uint8_t> decodeMeshoptView(const ImportContext& context, const std::string& place,
                                       const json& extension, uint64_t length,
                                       const std::vector<ByteSpan>& buffers) {
    if (!extension.is_object())
        context.fail(place, "should be an object");
    constexpr uint64_t kMax = 1ull << 53;
    const uint64_t zero = 0;
    const uint64_t buffer = countField(context, place, extension, "buffer", 0, kMax);
    if (buffer >= buffers.size())
        context.fail(place + ".buffer", "refers to a buffer that does not exist");
    const uint64_t offset = countField(context, place, extension, "byteOffset", 0, kMax, &zero);
    const uint64_t bytes = countField(context, place, extension, "byteLength", 1, kMax);
    const uint64_t stride = countField(context, place, extension, "byteStride", 1, 256);
    const uint64_t count = countField(context, place, extension, "count", 1, 1u << 31);
    const std::string mode = textField(context, place, extension, "mode", "");
    const std::string filter = textField(context, place, extension, "filter", "NONE");

    const ByteSpan source = buffers[buffer];
    if (offset > source.size() || bytes > source.size() - offset)
        context.fail(place, "the compressed data reach beyond their buffer");
    if (count * stride != length) // both below 2^39
        context.fail(place, "count * byteStride is not the buffer view's byteLength");
    const bool attributes = mode == "ATTRIBUTES", triangles = mode == "TRIANGLES",
               indices = mode == "INDICES";
    if (!attributes && !triangles && !indices)
        context.fail(place + ".mode", "\"" + mode.substr(0, 40) + "\" is not a mode");
    if (attributes ? stride % 4 != 0 : stride != 2 && stride != 4)
        context.fail(place + ".byteStride", std::to_string(stride) + " does not fit mode " + mode);
    if (triangles && count % 3 != 0)
        context.fail(place + ".count", "is not a multiple of three");
    const bool octahedral = filter == "OCTAHEDRAL", quaternion = filter == "QUATERNION",
               exponential = filter == "EXPONENTIAL";
    if (!octahedral && !quaternion && !exponential && filter != "NONE")
        context.fail(place + ".filter", "\"" + filter.substr(0, 40) + "\" is not a filter");
    if ((filter != "NONE" && !attributes) || (octahedral && stride != 4 && stride != 8) ||
        (quaternion && stride != 8))
        context.fail(place + ".filter",
                     filter + " does not fit mode " + mode + " with byteStride " + std::to_string(stride));

    std::vector<uint8_t> out(length);
    if (decode(mode, out, count, stride, source.subspan(offset, bytes)) != 0)
        context.fail(place, "the compressed data are broken");
    if (octahedral)
        meshopt_decodeFilterOct(out.data(), count, stride);
    if (quaternion)
        meshopt_decodeFilterQuat(out.data(), count, stride);
    if (exponential)
        meshopt_decodeFilterExp(out.data(), count, stride);
    return out;
}

} // namespace touchstone
