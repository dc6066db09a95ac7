#include "assets/glb_writer.h"

#include <meshoptimizer.h>

#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>

namespace touchstone::assets {

namespace {

constexpr int kVertexTarget = 34962, kIndexTarget = 34963;
constexpr int kUint8 = 5121, kUint16 = 5123, kUint32 = 5125, kFloat = 5126;
constexpr const char* kMeshopt = "EXT_meshopt_compression";
constexpr int kPackedBuffer = 0, kFallbackBuffer = 1;

template <class T>
void appendInteger(std::vector<std::byte>& bytes, T value) {
    const auto* first = reinterpret_cast<const std::byte*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof value);
}

void pad(std::vector<std::byte>& bytes, char filler) {
    while (bytes.size() % 4 != 0)
        bytes.push_back(static_cast<std::byte>(filler));
}

template <class Vector>
Json numbers(const Vector& vector) {
    Json list = Json::array();
    for (int i = 0; i < vector.length(); ++i)
        list.push_back(static_cast<double>(vector[i]));
    return list;
}

std::vector<unsigned char> packVertices(const void* data, size_t count, size_t stride) {
    meshopt_encodeVertexVersion(0);
    std::vector<unsigned char> packed(meshopt_encodeVertexBufferBound(count, stride));
    packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), data, count, stride));
    return packed;
}

std::vector<unsigned char> packIndices(const void* data, size_t count, size_t stride) {
    std::vector<uint32_t> wide(count);
    for (size_t i = 0; i < count; ++i) {
        uint16_t narrow = 0;
        const auto* from = static_cast<const std::byte*>(data) + i * stride;
        if (stride == sizeof narrow) {
            std::memcpy(&narrow, from, sizeof narrow);
            wide[i] = narrow;
        } else {
            std::memcpy(&wide[i], from, sizeof(uint32_t));
        }
    }
    meshopt_encodeIndexVersion(1);
    std::vector<unsigned char> packed(meshopt_encodeIndexBufferBound(count, UINT32_MAX >> 4));
    packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), wide.data(), count));
    return packed;
}

} // namespace

GlbWriter::GlbWriter(std::string sceneName, Packing packing) : packing_(packing) {
    gltf_["asset"] = {{"version", "2.0"}, {"generator", "touchstone_assets"}};
    gltf_["scene"] = 0;
    gltf_["scenes"] = Json::array({Json{{"name", std::move(sceneName)}, {"nodes", Json::array()}}});
    if (packing_ == Packing::Meshopt) {
        useExtension(kMeshopt);
        gltf_["extensionsRequired"] = Json::array({kMeshopt});
    }
}

void GlbWriter::useExtension(const std::string& extension) {
    Json& used = gltf_["extensionsUsed"];
    for (const Json& other : used)
        if (other == extension)
            return;
    used.push_back(extension);
}

size_t GlbWriter::append(const void* data, size_t size) {
    pad(binary_, '\0');
    const size_t offset = binary_.size();
    const auto* first = static_cast<const std::byte*>(data);
    binary_.insert(binary_.end(), first, first + size);
    return offset;
}

int GlbWriter::addView(const void* data, const View& view) {
    const size_t size = view.count * view.stride;
    Json json;
    if (packing_ == Packing::Plain) {
        json = {{"buffer", kPackedBuffer}, {"byteOffset", append(data, size)}, {"byteLength", size}};
    } else {
        const bool vertices = view.target == kVertexTarget;
        const std::vector<unsigned char> packed = vertices ? packVertices(data, view.count, view.stride)
                                                           : packIndices(data, view.count, view.stride);
        if (packed.empty())
            throw std::runtime_error("meshoptimizer could not pack a buffer");
        unpackedSize_ = (unpackedSize_ + 3) / 4 * 4;
        json = {{"buffer", kFallbackBuffer}, {"byteOffset", unpackedSize_}, {"byteLength", size}};
        json["extensions"][kMeshopt] = {{"buffer", kPackedBuffer},
                                        {"byteOffset", append(packed.data(), packed.size())},
                                        {"byteLength", packed.size()},
                                        {"byteStride", view.stride},
                                        {"mode", vertices ? "ATTRIBUTES" : "TRIANGLES"},
                                        {"count", view.count}};
        unpackedSize_ += size;
    }
    if (view.target == kVertexTarget)
        json["byteStride"] = view.stride;
    if (view.target != 0)
        json["target"] = view.target;
    gltf_["bufferViews"].push_back(std::move(json));
    return static_cast<int>(gltf_["bufferViews"].size()) - 1;
}

int GlbWriter::addText(const std::string& text) {
    return addView(text.data(), {.count = text.size(), .stride = 1, .target = 0});
}

int GlbWriter::addAccessor(const void* data, const View& view, int componentType, const char* type) {
    gltf_["accessors"].push_back({{"bufferView", addView(data, view)},
                                  {"componentType", componentType},
                                  {"count", view.count},
                                  {"type", type}});
    return static_cast<int>(gltf_["accessors"].size()) - 1;
}

int GlbWriter::addPositions(const std::vector<glm::vec3>& positions) {
    glm::vec3 low = positions.at(0), high = low;
    for (const glm::vec3& p : positions) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    const int accessor =
        addAccessor(positions.data(), {positions.size(), sizeof(glm::vec3), kVertexTarget}, kFloat, "VEC3");
    gltf_["accessors"].back()["min"] = numbers(low);
    gltf_["accessors"].back()["max"] = numbers(high);
    return accessor;
}

int GlbWriter::addIndices(const std::vector<uint32_t>& indices, size_t vertexCount) {
    // 65535 is glTF's primitive restart value in 16 bits, so it must not be an index.
    if (vertexCount > 65535)
        return addAccessor(indices.data(), {indices.size(), sizeof(uint32_t), kIndexTarget}, kUint32,
                           "SCALAR");
    std::vector<uint16_t> narrow(indices.size());
    for (size_t i = 0; i < indices.size(); ++i)
        narrow[i] = static_cast<uint16_t>(indices[i]);
    return addAccessor(narrow.data(), {narrow.size(), sizeof(uint16_t), kIndexTarget}, kUint16, "SCALAR");
}

Json GlbWriter::addPrimitive(const Shape& shape, int material) {
    const size_t count = shape.positions.size();
    Json attributes{{"POSITION", addPositions(shape.positions)}};
    const auto add = [&](const char* name, const auto& values, const char* type) {
        if (values.empty())
            return;
        if (values.size() != count)
            throw std::logic_error(std::string(name) + " misses vertices");
        attributes[name] = addAccessor(values.data(), {count, sizeof values[0], kVertexTarget}, kFloat, type);
    };
    add("NORMAL", shape.normals, "VEC3");
    add("TANGENT", shape.tangents, "VEC4");
    add("TEXCOORD_0", shape.uv, "VEC2");
    const int indices = addIndices(shape.indices, count);
    return {{"attributes", attributes}, {"indices", indices}, {"material", material}};
}

int GlbWriter::addMesh(const std::string& name, const std::vector<std::pair<Shape, int>>& parts) {
    Json primitives = Json::array();
    for (const auto& [shape, material] : parts)
        primitives.push_back(addPrimitive(shape, material));
    gltf_["meshes"].push_back({{"name", name}, {"primitives", primitives}});
    return static_cast<int>(gltf_["meshes"].size()) - 1;
}

int GlbWriter::addMesh(const std::string& name, const Shape& shape, int material) {
    return addMesh(name, {{shape, material}});
}

int GlbWriter::addMeshLike(const std::string& name, int mesh, int material) {
    Json copy = gltf_["meshes"].at(static_cast<size_t>(mesh));
    copy["name"] = name;
    copy["primitives"].at(0)["material"] = material;
    gltf_["meshes"].push_back(std::move(copy));
    return static_cast<int>(gltf_["meshes"].size()) - 1;
}

int GlbWriter::addStrokes(const std::string& name, int mode, const std::vector<glm::vec3>& positions,
                          const std::vector<glm::vec3>& colors, int material) {
    if (packing_ != Packing::Plain || positions.size() != colors.size())
        throw std::logic_error("strokes are written plain, with a colour each");
    Json attributes{{"POSITION", addPositions(positions)}};
    attributes["COLOR_0"] =
        addAccessor(colors.data(), {colors.size(), sizeof(glm::vec3), kVertexTarget}, kFloat, "VEC3");
    Json primitive{{"attributes", attributes}, {"material", material}, {"mode", mode}};
    gltf_["meshes"].push_back({{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
    return static_cast<int>(gltf_["meshes"].size()) - 1;
}

int GlbWriter::addSkinnedMesh(const std::string& name, const Shape& shape, const Influences& influences,
                              int material) {
    const size_t count = shape.positions.size();
    if (packing_ != Packing::Plain || influences.joints.size() != count || influences.weights.size() != count)
        throw std::logic_error("a skin is written plain, with influences for each vertex");
    Json primitive = addPrimitive(shape, material);
    primitive["attributes"]["JOINTS_0"] =
        addAccessor(influences.joints.data(), {count, 4, kVertexTarget}, kUint8, "VEC4");
    primitive["attributes"]["WEIGHTS_0"] =
        addAccessor(influences.weights.data(), {count, sizeof(glm::vec4), kVertexTarget}, kFloat, "VEC4");
    gltf_["meshes"].push_back({{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
    return static_cast<int>(gltf_["meshes"].size()) - 1;
}

int GlbWriter::addMorphMesh(const std::string& name, const Shape& shape, const std::vector<Shape>& targets,
                            int material) {
    if (packing_ != Packing::Plain)
        throw std::logic_error("morph targets are written plain");
    Json primitive = addPrimitive(shape, material);
    const auto displacement = [](const std::vector<glm::vec3>& from, const std::vector<glm::vec3>& to) {
        std::vector<glm::vec3> way;
        for (size_t v = 0; v < from.size(); ++v)
            way.push_back(to.at(v) - from[v]);
        return way;
    };
    for (const Shape& target : targets) {
        const std::vector<glm::vec3> normals = displacement(shape.normals, target.normals);
        Json made{{"POSITION", addPositions(displacement(shape.positions, target.positions))}};
        made["NORMAL"] =
            addAccessor(normals.data(), {normals.size(), sizeof(glm::vec3), kVertexTarget}, kFloat, "VEC3");
        primitive["targets"].push_back(std::move(made));
    }
    gltf_["meshes"].push_back({{"name", name}, {"primitives", Json::array({std::move(primitive)})}});
    return static_cast<int>(gltf_["meshes"].size()) - 1;
}

int GlbWriter::addJoint(const std::string& name, int parent, const glm::dvec3& translation) {
    gltf_["nodes"].push_back({{"name", name}, {"translation", numbers(translation)}});
    const int index = static_cast<int>(gltf_["nodes"].size()) - 1;
    if (parent < 0)
        gltf_["scenes"][0]["nodes"].push_back(index);
    else
        gltf_["nodes"][static_cast<size_t>(parent)]["children"].push_back(index);
    return index;
}

void GlbWriter::addSkin(int node, const std::vector<int>& joints, const std::vector<glm::dvec3>& heads) {
    std::vector<std::array<float, 16>> inverses;
    for (const glm::dvec3& head : heads) {
        const glm::vec3 back(-head);
        inverses.push_back({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, back.x, back.y, back.z, 1});
    }
    const int matrices = addAccessor(inverses.data(), {inverses.size(), 64, 0}, kFloat, "MAT4");
    gltf_["skins"].push_back({{"joints", joints}, {"inverseBindMatrices", matrices}});
    gltf_["nodes"][static_cast<size_t>(node)]["skin"] = gltf_["skins"].size() - 1;
}

int GlbWriter::addNode(const std::string& name, int mesh, const glm::dvec3& translation) {
    Json node{{"name", name}, {"mesh", mesh}};
    if (translation != glm::dvec3(0.0))
        node["translation"] = numbers(translation);
    gltf_["nodes"].push_back(std::move(node));
    const int index = static_cast<int>(gltf_["nodes"].size()) - 1;
    gltf_["scenes"][0]["nodes"].push_back(index);
    return index;
}

int GlbWriter::addChild(int parent, const std::string& name, int mesh, const glm::dvec3& translation,
                        const std::vector<double>& rotation) {
    Json node{{"name", name}};
    if (mesh >= 0)
        node["mesh"] = mesh;
    if (translation != glm::dvec3(0.0))
        node["translation"] = numbers(translation);
    if (!rotation.empty())
        node["rotation"] = rotation;
    gltf_["nodes"].push_back(std::move(node));
    const int index = static_cast<int>(gltf_["nodes"].size()) - 1;
    gltf_[parent >= 0 ? "nodes" : "scenes"][static_cast<size_t>(std::max(parent, 0))]
         [parent >= 0 ? "children" : "nodes"]
             .push_back(index);
    return index;
}

void GlbWriter::animate(const Track& track) {
    if (packing_ != Packing::Plain)
        throw std::logic_error("an animation is written plain");
    const std::string_view path = track.path;
    const size_t components = path == "rotation" ? 4 : path == "weights" ? 1 : 3;
    constexpr std::array<const char*, 5> kTypes{"", "SCALAR", "", "VEC3", "VEC4"};
    const int input =
        addAccessor(track.times.data(), {track.times.size(), sizeof(float), 0}, kFloat, "SCALAR");
    gltf_["accessors"].back()["min"] = Json::array({static_cast<double>(track.times.front())});
    gltf_["accessors"].back()["max"] = Json::array({static_cast<double>(track.times.back())});
    const View keys{track.values.size() / components, components * sizeof(float), 0};
    const int output = addAccessor(track.values.data(), keys, kFloat, kTypes[components]);
    Json& animation = gltf_["animations"][track.animation];
    animation["name"] = track.name != nullptr ? Json(track.name) : gltf_["scenes"][0]["name"];
    animation["samplers"].push_back(
        {{"input", input}, {"interpolation", track.interpolation}, {"output", output}});
    animation["channels"].push_back({{"sampler", animation["samplers"].size() - 1},
                                     {"target", {{"node", track.node}, {"path", track.path}}}});
}

int GlbWriter::addTexture(const std::string& name, const std::vector<std::byte>& png) {
    if (!gltf_.contains("samplers"))
        gltf_["samplers"].push_back(
            {{"magFilter", 9729}, {"minFilter", 9987}, {"wrapS", 10497}, {"wrapT", 10497}});
    gltf_["bufferViews"].push_back({{"buffer", kPackedBuffer},
                                    {"byteOffset", append(png.data(), png.size())},
                                    {"byteLength", png.size()}});
    gltf_["images"].push_back(
        {{"name", name}, {"bufferView", gltf_["bufferViews"].size() - 1}, {"mimeType", "image/png"}});
    gltf_["textures"].push_back({{"name", name}, {"sampler", 0}, {"source", gltf_["images"].size() - 1}});
    return static_cast<int>(gltf_["textures"].size()) - 1;
}

int GlbWriter::addMaterial(Json material) {
    if (material.contains("extensions"))
        for (const auto& [extension, value] : material["extensions"].items())
            useExtension(extension);
    gltf_["materials"].push_back(std::move(material));
    return static_cast<int>(gltf_["materials"].size()) - 1;
}

std::vector<std::byte> GlbWriter::finish() {
    pad(binary_, '\0');
    gltf_["buffers"] = Json::array({Json{{"byteLength", binary_.size()}}});
    if (unpackedSize_ > 0)
        gltf_["buffers"].push_back(
            {{"byteLength", unpackedSize_}, {"extensions", {{kMeshopt, {{"fallback", true}}}}}});

    const std::string text = gltf_.dump();
    std::vector<std::byte> json(reinterpret_cast<const std::byte*>(text.data()),
                                reinterpret_cast<const std::byte*>(text.data()) + text.size());
    pad(json, ' ');

    std::vector<std::byte> file;
    const auto chunk = [&](const std::vector<std::byte>& content, uint32_t kind) {
        appendInteger(file, static_cast<uint32_t>(content.size()));
        appendInteger(file, kind);
        file.insert(file.end(), content.begin(), content.end());
    };
    appendInteger(file, uint32_t{0x46546C67}); // "glTF"
    appendInteger(file, uint32_t{2});
    appendInteger(file, static_cast<uint32_t>(12 + 8 + json.size() + 8 + binary_.size()));
    chunk(json, 0x4E4F534A);    // "JSON"
    chunk(binary_, 0x004E4942); // "BIN"
    return file;
}

void writeFile(const std::filesystem::path& path, const std::vector<std::byte>& bytes) {
    std::filesystem::path unfinished = path;
    unfinished += ".part";
    {
        std::ofstream out(unfinished, std::ios::binary);
        out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
        out.close();
        if (!out) {
            std::error_code ignored;
            std::filesystem::remove(unfinished, ignored);
            throw std::runtime_error(path.string() + ": cannot be written");
        }
    }
    std::filesystem::rename(unfinished, path);
}

} // namespace touchstone::assets
