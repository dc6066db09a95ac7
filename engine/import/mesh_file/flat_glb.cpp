#include "engine/import/mesh_file/flat_glb.h"

#include "engine/core/error.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

// Numbers of the glTF specification.
constexpr int kFloat = 5126, kUnsignedInt = 5125, kVertices = 34962, kIndices = 34963;
constexpr uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

/// Lowest and highest coordinates, which glTF demands of positions.
struct Extent {
    std::array<float, 3> low, high;
};

Extent extentOf(std::span<const uint8_t> positions) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Extent extent{{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
    std::array<float, 3> vertex{};
    for (size_t at = 0; at < positions.size(); at += sizeof vertex) {
        std::memcpy(vertex.data(), positions.data() + at, sizeof vertex);
        for (size_t axis = 0; axis < 3; ++axis) {
            extent.low[axis] = std::min(extent.low[axis], vertex[axis]);
            extent.high[axis] = std::max(extent.high[axis], vertex[axis]);
        }
    }
    return extent;
}

class GlbJson {
  public:
    explicit GlbJson(const FlatMeshes& source) : source_(source) {}

    Json make(const std::string& generator) {
        Json root{{"asset", {{"version", "2.0"}, {"generator", generator}}},
                  {"scene", 0},
                  {"scenes", {{{"nodes", Json::array()}}}},
                  {"nodes", Json::array()},
                  {"materials", Json::array()},
                  {"meshes", Json::array()}};
        for (const std::string& name : source_.materials)
            root["materials"].push_back(
                {{"name", name},
                 {"pbrMetallicRoughness",
                  {{"baseColorFactor", {0.6, 0.6, 0.6, 1.0}}, {"metallicFactor", 0.0}}},
                 {"doubleSided", true}});
        for (const FlatMesh& mesh : source_.meshes) {
            const size_t index = root["meshes"].size();
            root["scenes"][0]["nodes"].push_back(index);
            root["nodes"].push_back({{"name", mesh.name}, {"mesh", index}});
            root["meshes"].push_back({{"name", mesh.name}, {"primitives", Json::array({primitive(mesh)})}});
        }
        root["accessors"] = std::move(accessors_);
        root["bufferViews"] = std::move(views_);
        root["buffers"] = {{{"byteLength", source_.arrays.size()}}};
        return root;
    }

  private:
    Json primitive(const FlatMesh& mesh) {
        const uint32_t vertices = mesh.counts.vertices;
        Json attributes{{"POSITION", accessor(mesh.positions, vertices, "VEC3", kVertices)}};
        const Extent extent = extentOf(source_.arrays.subspan(mesh.positions.offset, mesh.positions.bytes));
        accessors_.back()["min"] = extent.low;
        accessors_.back()["max"] = extent.high;
        if (mesh.normals)
            attributes["NORMAL"] = accessor(*mesh.normals, vertices, "VEC3", kVertices);
        if (mesh.textureCoordinates)
            attributes["TEXCOORD_0"] = accessor(*mesh.textureCoordinates, vertices, "VEC2", kVertices);
        if (mesh.colors)
            attributes["COLOR_0"] = accessor(*mesh.colors, vertices, "VEC4", kVertices);
        const size_t corners = accessor(mesh.corners, 3 * size_t{mesh.counts.triangles}, "SCALAR", kIndices);
        return {
            {"attributes", std::move(attributes)}, {"indices", corners}, {"material", mesh.counts.material}};
    }

    size_t accessor(const FlatRange& range, size_t count, const char* type, int target) {
        views_.push_back(
            {{"buffer", 0}, {"byteOffset", range.offset}, {"byteLength", range.bytes}, {"target", target}});
        accessors_.push_back({{"bufferView", views_.size() - 1},
                              {"componentType", target == kIndices ? kUnsignedInt : kFloat},
                              {"count", count},
                              {"type", type}});
        return accessors_.size() - 1;
    }

    const FlatMeshes& source_;
    Json accessors_ = Json::array(), views_ = Json::array();
};

} // namespace

std::vector<uint8_t> glbOf(const FlatMeshes& meshes, const std::string& generator,
                           const std::string& shownAs) {
    // Names are bytes of a foreign file: what is no UTF-8 is replaced.
    std::string text = GlbJson(meshes).make(generator).dump(-1, ' ', false, Json::error_handler_t::replace);
    text.append((4 - text.size() % 4) % 4, ' ');
    constexpr size_t kHeader = 12, kChunkHeader = 8;
    const uint64_t size = kHeader + 2 * kChunkHeader + text.size() + meshes.arrays.size();
    if (size > std::numeric_limits<uint32_t>::max())
        throw Error(shownAs, "", "has more geometry than the 4 GiB that a GLB can hold",
                    "split the model into several files");
    std::vector<uint8_t> glb;
    glb.reserve(size);
    const auto put = [&](uint64_t number) {
        const auto word = static_cast<uint32_t>(number);
        const auto* bytes = reinterpret_cast<const uint8_t*>(&word);
        glb.insert(glb.end(), bytes, bytes + sizeof word);
    };
    for (const uint64_t number :
         {uint64_t{kMagic}, uint64_t{kVersion}, size, uint64_t{text.size()}, uint64_t{kJsonChunk}})
        put(number);
    glb.insert(glb.end(), text.begin(), text.end());
    put(meshes.arrays.size());
    put(kBinChunk);
    glb.insert(glb.end(), meshes.arrays.begin(), meshes.arrays.end());
    return glb;
}

} // namespace touchstone
