#pragma once

#include "assets/shapes.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace touchstone::assets {

using Json = nlohmann::ordered_json;

enum class Packing {
    Plain,  ///< vertex arrays as in core glTF: any viewer opens the file
    Meshopt ///< EXT_meshopt_compression, lossless (codecs without filters), no fallback data: half the size
};

/// Builds a scene as one GLB file (glTF 2.0 §4, binary container). The same calls give the same bytes. Every
/// `add` returns the glTF index. One thread.
class GlbWriter {
  public:
    explicit GlbWriter(std::string sceneName, Packing packing = Packing::Plain);

    /// A texture from a PNG file image in memory, with a repeating, trilinear sampler.
    int addTexture(const std::string& name, const std::vector<std::byte>& png);
    /// A buffer view that holds a text. Only with Packing::Plain.
    int addText(const std::string& text);
    int addMaterial(Json material);
    int addMesh(const std::string& name, const Shape& shape, int material);
    /// One mesh of several primitives, each with its own material.
    int addMesh(const std::string& name, const std::vector<std::pair<Shape, int>>& parts);
    /// The same vertices and indices as a mesh of one primitive, with another material.
    int addMeshLike(const std::string& name, int mesh, int material);
    /// Points (mode 0), line segments (1), a loop (2) or a strip (3) in these colours, linear. Only with
    /// Packing::Plain.
    int addStrokes(const std::string& name, int mode, const std::vector<glm::vec3>& positions,
                   const std::vector<glm::vec3>& colors, int material);
    /// The joints that move each vertex, by their place in the skin, and their weights; four of each.
    struct Influences {
        std::vector<std::array<uint8_t, 4>> joints;
        std::vector<glm::vec4> weights;
    };
    /// A mesh for a node with a skin. Only with Packing::Plain, as what follows.
    int addSkinnedMesh(const std::string& name, const Shape& shape, const Influences& influences,
                       int material);
    /// A mesh with a morph target for each of `targets`: the shape with other positions and normals.
    int addMorphMesh(const std::string& name, const Shape& shape, const std::vector<Shape>& targets,
                     int material);
    /// A node without a mesh; `parent` -1: at the root.
    int addJoint(const std::string& name, int parent, const glm::dvec3& translation);
    /// Gives a node a skin whose joints stand at `heads` (mesh frame) where it does not deform.
    void addSkin(int node, const std::vector<int>& joints, const std::vector<glm::dvec3>& heads);
    /// A node at the root of the scene, m.
    int addNode(const std::string& name, int mesh, const glm::dvec3& translation = glm::dvec3(0.0));
    /// A node below another one, m; `mesh` -1: a frame alone. `rotation`: x, y, z, w.
    int addChild(int parent, const std::string& name, int mesh, const glm::dvec3& translation,
                 const std::vector<double>& rotation = {});
    /// Turns a node; x, y, z, w.
    void turnNode(int node, const std::vector<double>& rotation) {
        gltf_["nodes"][static_cast<size_t>(node)]["rotation"] = rotation;
    }
    /// An extension of a node, and one of the whole file.
    void extendNode(int node, const std::string& extension, Json value) {
        gltf_["nodes"][static_cast<size_t>(node)]["extensions"][extension] = std::move(value);
    }
    void extend(const std::string& extension, Json value) {
        gltf_["extensions"][extension] = std::move(value);
    }
    /// Animation of a node: one channel. Only with Packing::Plain.
    struct Track {
        int node;
        const char* path;          ///< "translation" (m), "rotation" (x, y, z, w) or "weights"
        const char* interpolation; ///< "LINEAR", or "CUBICSPLINE" with in-tangent, value, out-tangent per key
        std::vector<float> times;  ///< s, ascending
        std::vector<float> values;
        size_t animation = 0;       ///< index; a new one is the next
        const char* name = nullptr; ///< of the animation; null: that of the scene
    };
    void animate(const Track& track);
    /// A line of description, as asset.extras.description.
    void describe(const std::string& line) { gltf_["asset"]["extras"]["description"] = line; }
    void useExtension(const std::string& extension);

    /// The finished file. Call once.
    [[nodiscard]] std::vector<std::byte> finish();

  private:
    struct View {
        size_t count, stride;
        int target; ///< 34962 vertices, 34963 indices, 0 neither
    };
    int addView(const void* data, const View& view);
    int addAccessor(const void* data, const View& view, int componentType, const char* type);
    int addPositions(const std::vector<glm::vec3>& positions);
    int addIndices(const std::vector<uint32_t>& indices, size_t vertexCount);
    Json addPrimitive(const Shape& shape, int material);
    size_t append(const void* data, size_t size);

    Packing packing_;
    Json gltf_;
    std::vector<std::byte> binary_;
    size_t unpackedSize_ = 0; ///< of the fallback buffer that Packing::Meshopt leaves out
};

/// Writes the file atomically, through a temporary file beside it. Throws std::runtime_error.
void writeFile(const std::filesystem::path& path, const std::vector<std::byte>& bytes);

} // namespace touchstone::assets
