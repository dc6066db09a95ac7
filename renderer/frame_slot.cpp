#include "renderer/frame_slot.h"

#include "renderer/pipelines.h"
#include "shaders/shared/scene_types.h"

#include <chrono>
#include <utility>

namespace touchstone {

namespace {

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

void createSlot(const Gpu::Impl& gpu, vk::DescriptorSetLayout layout, FrameSlot& slot) {
    vk::raii::CommandBuffers buffers(
        gpu.device, vk::CommandBufferAllocateInfo{.commandPool = *gpu.commandPool, .commandBufferCount = 1});
    slot.commands = std::move(buffers.front());
    slot.done = vk::raii::Fence(gpu.device, vk::FenceCreateInfo{.flags = vk::FenceCreateFlagBits::eSignaled});
    if (gpu.timestampBits > 0)
        slot.timestamps = vk::raii::QueryPool(
            gpu.device, vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = 2});
    slot.uniforms = createBuffer(gpu, sizeof(shared::FrameUniforms), vk::BufferUsageFlagBits::eUniformBuffer,
                                 MemoryUse::Upload);
    const std::array sizes{vk::DescriptorPoolSize{vk::DescriptorType::eUniformBuffer, 1},
                           vk::DescriptorPoolSize{vk::DescriptorType::eCombinedImageSampler, 1}};
    slot.pool = vk::raii::DescriptorPool(
        gpu.device, vk::DescriptorPoolCreateInfo{
                        .maxSets = 1, .poolSizeCount = sizes.size(), .pPoolSizes = sizes.data()});
    slot.frameSet = (*gpu.device)
                        .allocateDescriptorSets(vk::DescriptorSetAllocateInfo{.descriptorPool = *slot.pool,
                                                                              .descriptorSetCount = 1,
                                                                              .pSetLayouts = &layout},
                                                *gpu.device.getDispatcher())
                        .front();
    const vk::DescriptorBufferInfo uniforms{*slot.uniforms.buffer, 0, VK_WHOLE_SIZE};
    gpu.device.updateDescriptorSets(
        vk::WriteDescriptorSet{.dstSet = slot.frameSet,
                               .descriptorCount = 1,
                               .descriptorType = vk::DescriptorType::eUniformBuffer,
                               .pBufferInfo = &uniforms},
        {});
}

void setEnvironment(const Gpu::Impl& gpu, const GpuEnvironment& environment, FrameSlot& slot) {
    const vk::DescriptorImageInfo image{*environment.sampler, *environment.cube.view,
                                        vk::ImageLayout::eShaderReadOnlyOptimal};
    gpu.device.updateDescriptorSets(
        vk::WriteDescriptorSet{.dstSet = slot.frameSet,
                               .dstBinding = 1,
                               .descriptorCount = 1,
                               .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                               .pImageInfo = &image},
        {});
}

void resizeSlot(const Gpu::Impl& gpu, vk::Extent2D extent, FrameSlot& slot) {
    // A submission of the window may still read the old image.
    gpu.device.waitIdle();
    using Usage = vk::ImageUsageFlagBits;
    slot.colorBytes = nullptr; // first: both sizes at once may not fit
    slot.color = GpuImage{};
    slot.depth = GpuImage{};
    GpuImage color = createImage(
        gpu, {.format = kSceneFormat,
              .extent = extent,
              .levels = 1,
              .usage = Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc | Usage::eTransferDst,
              .otherFormat = kSceneByteFormat});
    slot.depth = createImage(gpu, {.format = kDepthFormat,
                                   .extent = extent,
                                   .levels = 1,
                                   .usage = Usage::eDepthStencilAttachment | Usage::eSampled |
                                            Usage::eTransferSrc | Usage::eTransferDst});
    slot.colorBytes = createView(gpu, color, kSceneByteFormat);
    slot.color = std::move(color); // last: its extent says that the slot has this size
}

void beginCommands(FrameSlot& slot) {
    slot.commands.reset();
    slot.commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    slot.timed = *slot.timestamps != vk::QueryPool{};
    if (!slot.timed)
        return;
    slot.commands.resetQueryPool(*slot.timestamps, 0, 2);
    slot.commands.writeTimestamp2(vk::PipelineStageFlagBits2::eTopOfPipe, *slot.timestamps, 0);
}

void waitFor(const Gpu::Impl& gpu, FrameSlot& slot, SceneRenderer::Statistics& statistics) {
    const auto start = std::chrono::steady_clock::now();
    while (gpu.device.waitForFences(*slot.done, true, UINT64_MAX) == vk::Result::eTimeout) {
    }
    statistics.waitSeconds = secondsSince(start);
    if (!slot.timed)
        return;
    statistics.gpuSeconds = secondsBetween(gpu, slot.timestamps).value_or(statistics.gpuSeconds);
}

} // namespace touchstone
