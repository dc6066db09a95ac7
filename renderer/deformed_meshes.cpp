#include "renderer/deformed_meshes.h"

#include "renderer/gpu_scene.h"
#include "renderer/prepared_scene.h"

#include <algorithm>
#include <cstring>

namespace touchstone {

void DeformedMeshes::set(GpuScene& scene, int index, const DrawnVertices& drawn) {
    const Mesh& mesh = scene.scene().meshes[static_cast<size_t>(index)];
    if (drawn.positions.size() != mesh.positions.size() || mesh.indices.empty())
        return;
    const PreparedMesh& prepared = scene.mesh(index).mesh;
    Packed& packed = meshes_[index];
    if (packed.vertices.empty()) {
        packed.offset = static_cast<vk::DeviceSize>(prepared.firstVertex) * sizeof(SceneVertex);
        for (size_t v = 0; v < mesh.positions.size(); ++v)
            packed.vertices.push_back(packVertex(mesh, v, prepared.centre));
    }
    bool changed = packed.revision == 0;
    double radius = 0.0;
    glm::dvec3 half(0.0);
    for (size_t v = 0; v < packed.vertices.size(); ++v) {
        SceneVertex& vertex = packed.vertices[v];
        const glm::dvec3 offset = glm::dvec3(drawn.positions[v]) - prepared.centre;
        changed |= vertex.position != glm::vec3(offset) ||
                   (!drawn.normals.empty() && vertex.normal != drawn.normals[v]);
        vertex.position = glm::vec3(offset);
        if (!drawn.normals.empty())
            vertex.normal = drawn.normals[v];
        if (!drawn.tangents.empty())
            vertex.tangent = drawn.tangents[v];
        radius = std::max(radius, glm::length(offset));
        half = glm::max(half, glm::abs(offset));
    }
    if (!changed)
        return; // it stands still: a kept picture stays
    scene.setBounds(index, radius, half);
    ++packed.revision;
    packed.due = true;
}

uint64_t DeformedMeshes::revision(int mesh) const {
    const auto found = meshes_.find(mesh);
    return found != meshes_.end() ? found->second.revision : 0;
}

void DeformedMeshes::record(const Gpu::Impl& gpu, const vk::raii::CommandBuffer& commands, GpuBuffer& staging,
                            vk::Buffer vertices) {
    vk::DeviceSize bytes = 0;
    for (const auto& [mesh, packed] : meshes_)
        bytes += packed.due ? packed.vertices.size() * sizeof(SceneVertex) : 0;
    if (bytes == 0)
        return;
    if (staging.size < bytes)
        staging = createBuffer(gpu, bytes, vk::BufferUsageFlagBits::eTransferSrc, MemoryUse::Upload);
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    // Earlier frames read the vertices that this one overwrites.
    const auto barrier = [&](vk::PipelineStageFlags2 before, vk::AccessFlags2 written,
                             vk::PipelineStageFlags2 after, vk::AccessFlags2 access) {
        const vk::MemoryBarrier2 memory{
            .srcStageMask = before, .srcAccessMask = written, .dstStageMask = after, .dstAccessMask = access};
        commands.pipelineBarrier2(vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &memory});
    };
    barrier(Stage::eVertexAttributeInput, {}, Stage::eCopy, Access::eTransferWrite);
    vk::DeviceSize at = 0;
    for (auto& [mesh, packed] : meshes_) {
        if (!packed.due)
            continue;
        const vk::DeviceSize size = packed.vertices.size() * sizeof(SceneVertex);
        std::memcpy(staging.mapped + at, packed.vertices.data(), size);
        commands.copyBuffer(*staging.buffer, vertices,
                            vk::BufferCopy{.srcOffset = at, .dstOffset = packed.offset, .size = size});
        at += size;
        packed.due = false;
    }
    barrier(Stage::eCopy, Access::eTransferWrite, Stage::eVertexAttributeInput, Access::eVertexAttributeRead);
}

} // namespace touchstone
