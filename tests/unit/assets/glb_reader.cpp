#include "tests/unit/assets/glb_reader.h"

#include <meshoptimizer.h>

#include <cstdint>
#include <cstring>
#include <stdexcept>

namespace touchstone::test {

namespace {

void demand(bool holds, const char* what) {
    if (!holds)
        throw std::runtime_error(what);
}

uint32_t wordAt(const std::vector<std::byte>& bytes, size_t offset) {
    demand(offset + 4 <= bytes.size(), "the file ends early");
    uint32_t word = 0;
    std::memcpy(&word, bytes.data() + offset, 4);
    return word;
}

} // namespace

GlbReader::GlbReader(const std::vector<std::byte>& file) {
    demand(wordAt(file, 0) == 0x46546C67 && wordAt(file, 4) == 2, "no glTF 2 container");
    demand(wordAt(file, 8) == file.size(), "the length of the file is not what its header says");
    const size_t jsonLength = wordAt(file, 12), binaryStart = 20 + jsonLength + 8;
    demand(wordAt(file, 16) == 0x4E4F534A && jsonLength % 4 == 0, "the first chunk is not JSON");
    const auto* text = reinterpret_cast<const char*>(file.data()) + 20;
    json_ = nlohmann::json::parse(text, text + jsonLength);
    demand(wordAt(file, 20 + jsonLength + 4) == 0x004E4942, "the second chunk is not BIN");
    demand(binaryStart + wordAt(file, 20 + jsonLength) == file.size(),
           "the binary chunk does not end the file");
    binary_.assign(file.begin() + static_cast<std::ptrdiff_t>(binaryStart), file.end());
}

std::vector<std::byte> GlbReader::view(size_t index) const {
    const nlohmann::json& json = json_.at("bufferViews").at(index);
    const auto slice = [&](const nlohmann::json& where) {
        const size_t offset = where.value("byteOffset", size_t{0}), length = where.at("byteLength");
        demand(where.at("buffer") == 0 && offset + length <= binary_.size(),
               "a buffer view leaves its buffer");
        return std::vector(binary_.begin() + static_cast<std::ptrdiff_t>(offset),
                           binary_.begin() + static_cast<std::ptrdiff_t>(offset + length));
    };
    if (!json.contains("extensions"))
        return slice(json);
    const nlohmann::json& packed = json.at("extensions").at("EXT_meshopt_compression");
    const std::vector<std::byte> source = slice(packed);
    const auto* bytes = reinterpret_cast<const unsigned char*>(source.data());
    const size_t count = packed.at("count"), stride = packed.at("byteStride");
    std::vector<std::byte> result(count * stride);
    demand(result.size() == json.at("byteLength"), "the unpacked size is not the view's");
    const int status = packed.at("mode") == "TRIANGLES"
                           ? meshopt_decodeIndexBuffer(result.data(), count, stride, bytes, source.size())
                           : meshopt_decodeVertexBuffer(result.data(), count, stride, bytes, source.size());
    demand(status == 0, "a packed view cannot be unpacked");
    return result;
}

template <class T>
std::vector<T> GlbReader::accessor(size_t index) const {
    const nlohmann::json& json = json_.at("accessors").at(index);
    const std::vector<std::byte> bytes = view(json.at("bufferView"));
    std::vector<T> values(json.at("count").get<size_t>());
    demand(bytes.size() == values.size() * sizeof(T), "an accessor does not fill its view");
    std::memcpy(values.data(), bytes.data(), bytes.size());
    return values;
}

std::vector<uint32_t> GlbReader::indices(size_t index) const {
    if (json_.at("accessors").at(index).at("componentType") == 5125)
        return accessor<uint32_t>(index);
    const std::vector<uint16_t> narrow = accessor<uint16_t>(index);
    return {narrow.begin(), narrow.end()};
}

std::vector<Primitive> GlbReader::primitives() const {
    std::vector<Primitive> result;
    for (const auto& mesh : json_.at("meshes"))
        for (const auto& json : mesh.at("primitives")) {
            constexpr int kTriangles = 4;
            if (json.value("mode", kTriangles) != kTriangles)
                continue;
            Primitive primitive;
            const auto& attributes = json.at("attributes");
            primitive.positions = accessor<glm::vec3>(attributes.at("POSITION"));
            if (attributes.contains("NORMAL"))
                primitive.normals = accessor<glm::vec3>(attributes.at("NORMAL"));
            if (attributes.contains("TANGENT"))
                primitive.tangents = accessor<glm::vec4>(attributes.at("TANGENT"));
            if (attributes.contains("TEXCOORD_0"))
                primitive.uv = accessor<glm::vec2>(attributes.at("TEXCOORD_0"));
            primitive.indices = indices(json.at("indices"));
            result.push_back(std::move(primitive));
        }
    return result;
}

std::vector<std::byte> GlbReader::image(size_t index) const {
    return view(json_.at("images").at(index).at("bufferView"));
}

} // namespace touchstone::test
