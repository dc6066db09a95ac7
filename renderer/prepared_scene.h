#pragma once
// A scene in the device's format, prepared by a worker so that the window only copies it: packed vertices,
// simplified meshes, texture levels. Pure; any thread.

#include "engine/core/progress.h"
#include "engine/scene/scene.h"
#include "renderer/scene_vertex.h"
#include "renderer/texture_levels.h"

#include <atomic>
#include <map>
#include <memory>
#include <vector>

namespace touchstone {

/// Triangles of a mesh of which 99 of 100 points are within about `error` of the full ones, in the mesh's
/// units (measured on tori and ToyCar: 0.9 to 1.6 times that).
struct DrawLevel {
    uint32_t firstIndex = 0, indexCount = 0;
    double error = 0.0;
    double meanEdge = 0.0; ///< of its triangles, mesh units
};

struct PreparedMesh {
    int32_t firstVertex = 0;
    glm::dvec3 centre{0.0};        ///< mesh frame; the packed positions are relative to it
    double radius = 0.0;           ///< of a ball about the centre that contains all vertices
    glm::dvec3 halfSize{0.0};      ///< of the box about the centre, mesh axes
    std::vector<DrawLevel> levels; ///< the full mesh, then successively coarser ones
    /// Line segments or points: two vertices or one each, from strokeVertex on, without indices.
    uint32_t strokeVertex = 0, strokes = 0;

    [[nodiscard]] bool empty() const { return strokes == 0 && levels.front().indexCount == 0; }
};

struct PreparedScene {
    ScenePtr scene;
    std::vector<PreparedMesh> meshes; ///< as Scene::meshes
    std::vector<SceneVertex> vertices;
    std::vector<uint32_t> indices; ///< relative to the mesh's first vertex
    /// Of the images used for rendering: (index of the image, role). Broken images have none.
    std::map<std::pair<int, TextureRole>, TextureLevels> textures;
};

struct PrepareOptions {
    /// Meshes of more than twice this many triangles are simplified by halves down to about this many; 0:
    /// none is.
    size_t coarsest = 100;
    /// Set it to stop: the scene may then lack levels and textures. May be null.
    const std::atomic<bool>* cancel = nullptr;
    Progress progress = {}; ///< for reporting only; `cancel` cancels
};

/// `scene` must not be null. A million triangles take about two seconds with simplification, and 60 MB until
/// they are uploaded.
[[nodiscard]] std::shared_ptr<const PreparedScene> prepareScene(ScenePtr scene,
                                                                const PrepareOptions& options = {});

/// Vertex `i` of a mesh as the device has it.
[[nodiscard]] SceneVertex packVertex(const Mesh& mesh, size_t i, const glm::dvec3& centre);

/// The coarsest level whose error stays within `allowed`, mesh units.
[[nodiscard]] const DrawLevel& levelWithin(const PreparedMesh& mesh, double allowed);

/// True if the reference has an image and it was decoded.
[[nodiscard]] bool usableTexture(const Scene& scene, const TextureRef& reference);

} // namespace touchstone
