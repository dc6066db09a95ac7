#include "renderer/gpu_memory.h"

#include <algorithm>
#include <cstring>

namespace touchstone {

namespace {

constexpr vk::DeviceSize kStagingSize = 2u << 20;

uint32_t memoryType(const Gpu::Impl& gpu, uint32_t allowed, vk::MemoryPropertyFlags wanted,
                    vk::MemoryPropertyFlags preferred) {
    for (const vk::MemoryPropertyFlags flags : {wanted | preferred, wanted})
        for (uint32_t i = 0; i < gpu.memory.memoryTypeCount; ++i)
            if ((allowed & (1u << i)) != 0 && (gpu.memory.memoryTypes[i].propertyFlags & flags) == flags)
                return i;
    throw vk::OutOfDeviceMemoryError("no memory of the wanted kind");
}

vk::raii::DeviceMemory allocate(const Gpu::Impl& gpu, const vk::MemoryRequirements& needed, MemoryUse use) {
    using Flag = vk::MemoryPropertyFlagBits;
    vk::MemoryPropertyFlags wanted = Flag::eHostVisible | Flag::eHostCoherent, preferred;
    if (use == MemoryUse::Device) {
        wanted = {};
        preferred = Flag::eDeviceLocal;
    } else if (use == MemoryUse::Readback) {
        preferred = Flag::eHostCached;
    }
    return {gpu.device, vk::MemoryAllocateInfo{
                            .allocationSize = needed.size,
                            .memoryTypeIndex = memoryType(gpu, needed.memoryTypeBits, wanted, preferred)}};
}

} // namespace

GpuBuffer createBuffer(const Gpu::Impl& gpu, vk::DeviceSize size, vk::BufferUsageFlags usage, MemoryUse use) {
    GpuBuffer result;
    result.size = std::max<vk::DeviceSize>(size, 16);
    result.buffer = vk::raii::Buffer(gpu.device, vk::BufferCreateInfo{.size = result.size, .usage = usage});
    result.memory = allocate(gpu, result.buffer.getMemoryRequirements(), use);
    result.buffer.bindMemory(*result.memory, 0);
    if (use != MemoryUse::Device)
        result.mapped = static_cast<std::byte*>(result.memory.mapMemory(0, VK_WHOLE_SIZE));
    return result;
}

GpuImage createImage(const Gpu::Impl& gpu, const ImageRequest& request) {
    GpuImage result;
    result.extent = request.extent;
    const std::array<vk::Format, 2> formats{request.format, request.otherFormat};
    const bool twoFormats = request.otherFormat != vk::Format::eUndefined;
    vk::ImageCreateFlags flags;
    if (twoFormats)
        flags |= vk::ImageCreateFlagBits::eMutableFormat;
    if (request.cube)
        flags |= vk::ImageCreateFlagBits::eCubeCompatible;
    const vk::ImageFormatListCreateInfo list{.viewFormatCount = 2, .pViewFormats = formats.data()};
    result.image = vk::raii::Image(
        gpu.device, vk::ImageCreateInfo{.pNext = twoFormats ? &list : nullptr,
                                        .flags = flags,
                                        .imageType = vk::ImageType::e2D,
                                        .format = request.format,
                                        .extent = {request.extent.width, request.extent.height, 1},
                                        .mipLevels = request.levels,
                                        .arrayLayers = request.cube ? 6u : 1u,
                                        .usage = request.usage});
    const vk::MemoryRequirements needed = result.image.getMemoryRequirements();
    result.size = needed.size;
    result.memory = allocate(gpu, needed, MemoryUse::Device);
    result.image.bindMemory(*result.memory, 0);
    result.view = createView(gpu, result, request.format, request.levels, request.cube);
    return result;
}

vk::raii::ImageView createView(const Gpu::Impl& gpu, const GpuImage& image, vk::Format format,
                               uint32_t levels, bool cube) {
    const vk::ImageAspectFlags aspect =
        format == vk::Format::eD32Sfloat ? vk::ImageAspectFlagBits::eDepth : vk::ImageAspectFlagBits::eColor;
    return {gpu.device,
            vk::ImageViewCreateInfo{.image = *image.image,
                                    .viewType = cube ? vk::ImageViewType::eCube : vk::ImageViewType::e2D,
                                    .format = format,
                                    .subresourceRange = {aspect, 0, levels, 0, cube ? 6u : 1u}}};
}

void transition(const vk::raii::CommandBuffer& commands, vk::Image image, vk::ImageAspectFlags aspect,
                vk::ImageLayout from, vk::ImageLayout to, vk::PipelineStageFlags2 stagesBefore,
                vk::AccessFlags2 accessBefore, vk::PipelineStageFlags2 stagesAfter,
                vk::AccessFlags2 accessAfter) {
    const vk::ImageMemoryBarrier2 barrier{
        .srcStageMask = stagesBefore,
        .srcAccessMask = accessBefore,
        .dstStageMask = stagesAfter,
        .dstAccessMask = accessAfter,
        .oldLayout = from,
        .newLayout = to,
        .srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED,
        .image = image,
        .subresourceRange = {aspect, 0, VK_REMAINING_MIP_LEVELS, 0, VK_REMAINING_ARRAY_LAYERS}};
    commands.pipelineBarrier2(
        vk::DependencyInfo{.imageMemoryBarrierCount = 1, .pImageMemoryBarriers = &barrier});
}

std::optional<double> secondsBetween(const Gpu::Impl& gpu, const vk::raii::QueryPool& timestamps) {
    const auto [result, ticks] = timestamps.getResults<uint64_t>(0, 2, 2 * sizeof(uint64_t), sizeof(uint64_t),
                                                                 vk::QueryResultFlagBits::e64);
    if (result != vk::Result::eSuccess)
        return std::nullopt;
    const uint64_t mask = gpu.timestampBits >= 64 ? UINT64_MAX : (uint64_t{1} << gpu.timestampBits) - 1;
    return 1e-9 * static_cast<double>(gpu.limits.timestampPeriod) *
           static_cast<double>((ticks[1] - ticks[0]) & mask);
}

Uploader::Uploader(const Gpu::Impl& gpu)
    : gpu_(gpu),
      staging_(createBuffer(gpu, kStagingSize, vk::BufferUsageFlagBits::eTransferSrc, MemoryUse::Upload)) {}

void Uploader::buffer(const GpuBuffer& target, vk::DeviceSize offset, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const size_t count = std::min<size_t>(bytes.size(), kStagingSize);
        std::memcpy(staging_.mapped, bytes.data(), count);
        runOnce(gpu_, [&](const vk::raii::CommandBuffer& commands) {
            commands.copyBuffer(*staging_.buffer, *target.buffer,
                                vk::BufferCopy{.srcOffset = 0, .dstOffset = offset, .size = count});
        });
        offset += count;
        bytes = bytes.subspan(count);
    }
}

void Uploader::imageRows(const GpuImage& target, uint32_t level, vk::Extent2D extent, uint32_t firstRow,
                         std::span<const std::byte> bytes, uint32_t face) {
    std::memcpy(staging_.mapped, bytes.data(), bytes.size());
    runOnce(gpu_, [&](const vk::raii::CommandBuffer& commands) {
        commands.copyBufferToImage(
            *staging_.buffer, *target.image, vk::ImageLayout::eTransferDstOptimal,
            vk::BufferImageCopy{.imageSubresource = {vk::ImageAspectFlagBits::eColor, level, face, 1},
                                .imageOffset = {0, static_cast<int32_t>(firstRow), 0},
                                .imageExtent = {extent.width, extent.height, 1}});
    });
}

} // namespace touchstone
