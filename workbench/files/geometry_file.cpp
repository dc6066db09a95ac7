#include "workbench/files/geometry_file.h"

#include "engine/core/output_file.h"
#include "engine/import/mesh_file/flat_glb.h"

#include <cstring>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// The vertices that triangles of a mesh use, in their order of use.
struct UsedVertices {
    explicit UsedVertices(const Mesh& mesh) : corners(mesh.indices.size()) {
        constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
        std::vector<uint32_t> place(mesh.positions.size(), kNone);
        for (size_t i = 0; i < corners.size(); ++i) {
            uint32_t& own = place[mesh.indices[i]];
            if (own == kNone) {
                own = static_cast<uint32_t>(vertices.size());
                vertices.push_back(mesh.indices[i]);
            }
            corners[i] = own;
        }
    }
    std::vector<uint32_t> vertices, corners;
};

class FlatScene {
  public:
    void add(const Scene& scene, const Instance& instance) {
        const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
        if (mesh.indices.empty())
            return;
        UsedVertices used(mesh);
        const glm::dmat3 turn(instance.sceneFromMesh);
        if (glm::determinant(turn) < 0.0) // a mirror turns the triangles round
            for (size_t i = 0; i + 2 < used.corners.size(); i += 3)
                std::swap(used.corners[i + 1], used.corners[i + 2]);
        FlatMesh flat;
        flat.name = instance.node >= 0 ? scene.nodes[static_cast<size_t>(instance.node)].name : mesh.name;
        flat.counts = {.material = static_cast<uint32_t>(mesh.material),
                       .vertices = static_cast<uint32_t>(used.vertices.size()),
                       .triangles = static_cast<uint32_t>(used.corners.size() / 3)};
        flat.positions = put(used, [&](uint32_t v) {
            return glm::vec3(glm::dvec3(instance.sceneFromMesh * glm::dvec4(mesh.positions[v], 1.0)));
        });
        const glm::dmat3 turnNormal = glm::transpose(glm::inverse(turn));
        if (mesh.normalsFromFile && !mesh.normals.empty())
            flat.normals = put(used, [&](uint32_t v) {
                const glm::dvec3 normal = turnNormal * glm::dvec3(mesh.normals[v]);
                const double length = glm::length(normal);
                return glm::vec3(length > 0.0 ? normal / length : glm::dvec3(0.0, 1.0, 0.0));
            });
        if (!mesh.uv0.empty())
            flat.textureCoordinates = put(used, [&](uint32_t v) { return mesh.uv0[v]; });
        if (!mesh.colors.empty())
            flat.colors = put(used, [&](uint32_t v) { return mesh.colors[v]; });
        flat.corners = append(used.corners);
        meshes_.meshes.push_back(std::move(flat));
    }

    std::vector<uint8_t> finish(const Scene& scene, const std::string& shownAs) {
        for (const Material& material : scene.materials)
            meshes_.materials.push_back(material.name);
        meshes_.arrays = arrays_;
        return glbOf(meshes_, "Touchstone " TOUCHSTONE_VERSION ", simplified", shownAs);
    }

  private:
    template <class Value>
    FlatRange append(const std::vector<Value>& values) {
        const FlatRange range{arrays_.size(), values.size() * sizeof(Value)};
        arrays_.resize(range.offset + range.bytes);
        std::memcpy(arrays_.data() + range.offset, values.data(), range.bytes);
        return range;
    }
    template <class Get>
    FlatRange put(const UsedVertices& used, const Get& get) {
        std::vector<decltype(get(0u))> values;
        values.reserve(used.vertices.size());
        for (const uint32_t v : used.vertices)
            values.push_back(get(v));
        return append(values);
    }

    FlatMeshes meshes_;
    std::vector<uint8_t> arrays_;
};

} // namespace

void writeGeometry(const std::filesystem::path& file, const Scene& scene) {
    FlatScene flat;
    for (const Instance& instance : scene.instances)
        if (instance.mesh >= 0)
            flat.add(scene, instance);
    const std::vector<uint8_t> glb = flat.finish(scene, file.string());
    writeFile(file, std::string_view(reinterpret_cast<const char*>(glb.data()), glb.size()));
}

} // namespace touchstone
