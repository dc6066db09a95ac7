#pragma once
// The vertices of deforming meshes on their way to the device. Main thread only, private to renderer/.

#include "engine/scene/mesh_deformation.h"
#include "renderer/gpu_memory.h"
#include "renderer/scene_vertex.h"

#include <cstdint>
#include <map>
#include <vector>

namespace touchstone {

class GpuScene;

/// Vertices are evaluated by the CPU, as the hand's are, and copied to the device's own buffer at the start
/// of the next frame.
class DeformedMeshes {
  public:
    void clear() { meshes_.clear(); }
    /// The vertices of a mesh from the next frame on; adapts the bounds that the scene's culling uses.
    void set(GpuScene& scene, int mesh, const DrawnVertices& drawn);
    /// Grows with each change of the mesh; 0: it never changed.
    [[nodiscard]] uint64_t revision(int mesh) const;
    /// Records the copies that are due, from `staging`, which belongs to the frame and grows as needed.
    void record(const Gpu::Impl& gpu, const vk::raii::CommandBuffer& commands, GpuBuffer& staging,
                vk::Buffer vertices);

  private:
    struct Packed {
        vk::DeviceSize offset = 0; ///< bytes, in the buffer of all vertices
        std::vector<SceneVertex> vertices;
        uint64_t revision = 0;
        bool due = false;
    };
    std::map<int, Packed> meshes_;
};

} // namespace touchstone
