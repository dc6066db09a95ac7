#pragma once
// The haptic programs of a scene's materials on the device: their parameters, and where instances lie in the
// programs' frames. Main thread only, private to renderer/.

#include "engine/scene/scene.h"
#include "renderer/gpu_memory.h"
#include "renderer/persistent_texels.h"
#include "renderer/pipelines.h"

#include <memory>
#include <span>
#include <vector>

namespace touchstone {

class GpuPrograms {
  public:
    /// `centres`: of each mesh, PreparedMesh's. `programs`: one for each material of the scene; without any
    /// there is nothing on the device. What it holds may be destroyed when no frame is in flight.
    /// `before`: those that these take the place of, whose persistent textures go on where they fit; null:
    /// none.
    GpuPrograms(const Gpu::Impl& gpu, const Pipelines& pipelines, const Scene& scene,
                std::span<const glm::dvec3> centres, std::vector<MaterialProgram> programs,
                GpuPrograms* before = nullptr);

    [[nodiscard]] const std::vector<MaterialProgram>& all() const { return programs_; }
    [[nodiscard]] const std::shared_ptr<const SurfaceProgram>& of(int material) const {
        return programs_[static_cast<size_t>(material)].compiled;
    }
    [[nodiscard]] vk::DescriptorSet set(int material) const { return sets_[static_cast<size_t>(material)]; }
    /// Writes a part of an instance's persistent texture; false where it has none of that size.
    bool setTexels(const PersistentTexels& texels);
    /// The dynamic offset of the set.
    [[nodiscard]] uint32_t offset(int instance) const { return static_cast<uint32_t>(instance) * stride_; }

  private:
    /// The floats of an instance's persistent texture.
    struct TexelBlock {
        PersistentTextureSize size;
        uint32_t first = 0;
        bool operator==(const TexelBlock&) const = default;
    };
    void placeTexels(const Gpu::Impl& gpu, const Scene& scene, GpuPrograms* before);
    void placeInstances(const Gpu::Impl& gpu, const Scene& scene, std::span<const glm::dvec3> centres);
    [[nodiscard]] vk::DescriptorSet makeSet(const Gpu::Impl& gpu, vk::DescriptorSetLayout layout,
                                            vk::DeviceSize at, vk::DeviceSize size) const;

    std::vector<MaterialProgram> programs_;
    GpuBuffer parameters_, instances_, texels_;
    std::vector<TexelBlock> blocks_; ///< by instance
    uint32_t stride_ = 0;
    vk::raii::DescriptorPool pool_{nullptr};
    std::vector<vk::DescriptorSet> sets_; ///< one for each material; null without a program
};

/// The programs of the file.
[[nodiscard]] std::vector<MaterialProgram> programsOf(const Scene& scene);

} // namespace touchstone
