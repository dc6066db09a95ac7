#pragma once
// Buffers, images and uploads. Main thread only, private to renderer/.

#include "renderer/gpu_impl.h"

#include <cstddef>
#include <optional>
#include <span>

namespace touchstone {

enum class MemoryUse { Device, Upload, Readback }; ///< the last two stay mapped

struct GpuBuffer {
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::Buffer buffer{nullptr};
    std::byte* mapped = nullptr;
    vk::DeviceSize size = 0;
};

struct GpuImage {
    vk::raii::DeviceMemory memory{nullptr};
    vk::raii::Image image{nullptr};
    vk::raii::ImageView view{nullptr};
    vk::Extent2D extent;
    vk::DeviceSize size = 0; ///< bytes of device memory
};

/// Size 0 is rounded up to 16 bytes, since Vulkan has no empty buffers.
[[nodiscard]] GpuBuffer createBuffer(const Gpu::Impl& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage,
                                     MemoryUse use);

struct ImageRequest {
    vk::Format format = vk::Format::eR8G8B8A8Unorm;
    vk::Extent2D extent;
    uint32_t levels = 1;
    vk::ImageUsageFlags usage;
    vk::Format otherFormat = vk::Format::eUndefined; ///< a second format for views
    bool cube = false;                               ///< six square faces
};
[[nodiscard]] GpuImage createImage(const Gpu::Impl& gpu, const ImageRequest& request);
[[nodiscard]] vk::raii::ImageView createView(const Gpu::Impl& gpu, const GpuImage& image, vk::Format format,
                                             uint32_t levels = 1, bool cube = false);

/// A layout transition with the stages and accesses before and after it, for colour images or depth.
void transition(const vk::raii::CommandBuffer& commands, vk::Image image, vk::ImageAspectFlags aspect,
                vk::ImageLayout from, vk::ImageLayout to, vk::PipelineStageFlags2 stagesBefore,
                vk::AccessFlags2 accessBefore, vk::PipelineStageFlags2 stagesAfter,
                vk::AccessFlags2 accessAfter);

/// Between the two timestamps of a pool that were written last; nullopt until they are available.
[[nodiscard]] std::optional<double> secondsBetween(const Gpu::Impl& gpu,
                                                   const vk::raii::QueryPool& timestamps);

/// Records a new command buffer, submits it and waits.
template <class Record>
void runOnce(const Gpu::Impl& gpu, Record&& record) {
    vk::raii::CommandBuffers buffers(
        gpu.device, vk::CommandBufferAllocateInfo{.commandPool = *gpu.commandPool, .commandBufferCount = 1});
    const vk::raii::CommandBuffer& commands = buffers.front();
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    record(commands);
    commands.end();
    const vk::CommandBufferSubmitInfo submitted{.commandBuffer = *commands};
    const vk::raii::Fence done(gpu.device, vk::FenceCreateInfo{});
    gpu.queue.submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted}, *done);
    while (gpu.device.waitForFences(*done, true, UINT64_MAX) == vk::Result::eTimeout) {
    }
}

/// Copies through one staging buffer of fixed size, so that a large scene is not duplicated.
class Uploader {
  public:
    explicit Uploader(const Gpu::Impl& gpu);
    void buffer(const GpuBuffer& target, vk::DeviceSize offset, std::span<const std::byte> bytes);
    /// Rows of a level of an image in layout TransferDstOptimal, from `firstRow`; tightly packed, at most
    /// kStagingSize bytes or one row.
    void imageRows(const GpuImage& target, uint32_t level, vk::Extent2D extent, uint32_t firstRow,
                   std::span<const std::byte> bytes, uint32_t face = 0);

  private:
    const Gpu::Impl& gpu_;
    GpuBuffer staging_;
};

} // namespace touchstone
