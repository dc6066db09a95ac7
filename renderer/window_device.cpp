#include "renderer/window_device.h"

#include "renderer/graphics_pipeline.h"
#include "renderer/imgui_backend.h"
#include "renderer/scene_renderer_impl.h"
#include "renderer/shader_code.h"
#include "renderer/vulkan_result.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_vulkan.h>

#include <algorithm>
#include <chrono>

namespace touchstone {

namespace {

constexpr uint64_t kAcquireTimeout = 1'000'000'000; ///< ns; a lost window system must not block us

/// The part of a rectangle that lies in the window.
vk::Rect2D within(const PixelRect& where, vk::Extent2D extent) {
    const auto width = static_cast<int>(extent.width), height = static_cast<int>(extent.height);
    const int left = std::clamp(where.x, 0, width), top = std::clamp(where.y, 0, height);
    const int right = std::clamp(where.x + where.width, left, width);
    const int bottom = std::clamp(where.y + where.height, top, height);
    return {.offset = {left, top},
            .extent = {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}};
}

} // namespace

WindowDevice::WindowDevice(const Gpu::Impl& gpu, GLFWwindow* window)
    : gpu_(gpu), window_(window), swapchain_(gpu), canvas_(gpu, swapchain_.format()) {
    createScenePipeline();
    createFrames();
}

void WindowDevice::createScenePipeline() {
    sampler_ = vk::raii::Sampler(gpu_.device,
                                 vk::SamplerCreateInfo{.magFilter = vk::Filter::eLinear,
                                                       .minFilter = vk::Filter::eLinear,
                                                       .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                                       .addressModeV = vk::SamplerAddressMode::eClampToEdge});
    const vk::DescriptorSetLayoutBinding binding{.binding = 0,
                                                 .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                                                 .descriptorCount = 1,
                                                 .stageFlags = vk::ShaderStageFlagBits::eFragment};
    sceneSetLayout_ = vk::raii::DescriptorSetLayout(
        gpu_.device, vk::DescriptorSetLayoutCreateInfo{.bindingCount = 1, .pBindings = &binding});
    const vk::DescriptorSetLayout set = *sceneSetLayout_;
    sceneLayout_ = vk::raii::PipelineLayout(
        gpu_.device, vk::PipelineLayoutCreateInfo{.setLayoutCount = 1, .pSetLayouts = &set});
    PipelineRecipe recipe;
    recipe.vertexCode = shaders::full_screen_vert;
    recipe.fragmentCode = shaders::window_frag;
    recipe.depthTest = recipe.depthWrite = false;
    recipe.layout = *sceneLayout_;
    recipe.renderPass = swapchain_.renderPass();
    scenePipeline_ =
        makePipeline(gpu_, vk::raii::PipelineCache(gpu_.device, vk::PipelineCacheCreateInfo{}), recipe);
}

void WindowDevice::createFrames() {
    const vk::DescriptorPoolSize size{vk::DescriptorType::eCombinedImageSampler, 2 * kFramesInFlight + 8};
    // ImGui frees its own set.
    pool_ = vk::raii::DescriptorPool(
        gpu_.device,
        vk::DescriptorPoolCreateInfo{.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                     .maxSets = 2 * kFramesInFlight + 8,
                                     .poolSizeCount = 1,
                                     .pPoolSizes = &size});
    for (Frame& frame : frames_) {
        vk::raii::CommandBuffers buffers(
            gpu_.device,
            vk::CommandBufferAllocateInfo{.commandPool = *gpu_.commandPool, .commandBufferCount = 1});
        frame.commands = std::move(buffers.front());
        frame.done =
            vk::raii::Fence(gpu_.device, vk::FenceCreateInfo{.flags = vk::FenceCreateFlagBits::eSignaled});
        frame.acquired = vk::raii::Semaphore(gpu_.device, vk::SemaphoreCreateInfo{});
        if (gpu_.timestampBits > 0)
            frame.timestamps = vk::raii::QueryPool(
                gpu_.device,
                vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = 2});
        for (vk::DescriptorSet& set : frame.sceneSets)
            set = newSet();
    }
}

vk::DescriptorSet WindowDevice::newSet() const {
    const vk::DescriptorSetLayout layout = *sceneSetLayout_;
    return (*gpu_.device)
        .allocateDescriptorSets(vk::DescriptorSetAllocateInfo{.descriptorPool = *pool_,
                                                              .descriptorSetCount = 1,
                                                              .pSetLayouts = &layout},
                                *gpu_.device.getDispatcher())
        .front();
}

void WindowDevice::point(vk::DescriptorSet set, vk::ImageView image) const {
    const vk::DescriptorImageInfo info{*sampler_, image, vk::ImageLayout::eShaderReadOnlyOptimal};
    gpu_.device.updateDescriptorSets(
        vk::WriteDescriptorSet{.dstSet = set,
                               .descriptorCount = 1,
                               .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                               .pImageInfo = &info},
        {});
}

vk::DescriptorSet WindowDevice::makeSet(vk::ImageView image) const {
    const vk::DescriptorSet set = newSet();
    point(set, image);
    return set;
}

vk::Extent2D WindowDevice::framebufferSize() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window_, &width, &height);
    return {static_cast<uint32_t>(std::max(width, 0)), static_cast<uint32_t>(std::max(height, 0))};
}

bool WindowDevice::followWindow(WindowTarget::Statistics& statistics) {
    const vk::Extent2D size = framebufferSize();
    if (size.width == 0 || size.height == 0 || glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0)
        return false;
    if (!outdated_ && size == lastSize_)
        return true;
    gpu_.device.waitIdle();
    // The semaphore of an acquire that was never submitted stays signalled; new ones cost nothing.
    for (Frame& frame : frames_)
        frame.acquired = vk::raii::Semaphore(gpu_.device, vk::SemaphoreCreateInfo{});
    outdated_ = true; // until one exists: creation may fail, or find no area, and the size may return
    if (!swapchain_.recreate(size))
        return false;
    if (drawsOnCanvas())
        canvas_.resize(swapchain_.extent());
    ++statistics.swapchainsMade;
    lastSize_ = size;
    outdated_ = false;
    return true;
}

void WindowDevice::drawScene(vk::DescriptorSet set, const FrameSlot& scene, const PixelRect& where) const {
    point(set, *scene.colorBytes);
    drawImage(set,
              {.x = static_cast<float>(where.x),
               .y = static_cast<float>(where.y),
               .width = static_cast<float>(where.width),
               .height = static_cast<float>(where.height),
               .maxDepth = 1.0f},
              where);
}

void WindowDevice::drawImage(vk::DescriptorSet image, const vk::Viewport& viewport,
                             const PixelRect& where) const {
    const vk::Rect2D visible = within(where, swapchain_.extent());
    if (visible.extent.width == 0 || visible.extent.height == 0)
        return;
    const vk::raii::CommandBuffer& commands = *recording_;
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *scenePipeline_);
    commands.setCullMode(vk::CullModeFlagBits::eNone);
    commands.setFrontFace(vk::FrontFace::eCounterClockwise);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *sceneLayout_, 0, image, {});
    commands.setViewport(0, viewport);
    commands.setScissor(0, visible);
    commands.draw(3, 1, 0, 0);
}

void WindowDevice::recordCapture(const Frame& frame, uint32_t image) {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    using Layout = vk::ImageLayout;
    const vk::ImageAspectFlags color = vk::ImageAspectFlagBits::eColor;
    captureExtent_ = swapchain_.extent();
    captureBuffer_ = createBuffer(gpu_, size_t{4} * captureExtent_.width * captureExtent_.height,
                                  vk::BufferUsageFlagBits::eTransferDst, MemoryUse::Readback);
    transition(frame.commands, swapchain_.image(image), color, Layout::ePresentSrcKHR,
               Layout::eTransferSrcOptimal, Stage::eColorAttachmentOutput | Stage::eAllTransfer,
               Access::eColorAttachmentWrite | Access::eTransferWrite, Stage::eCopy, Access::eTransferRead);
    frame.commands.copyImageToBuffer(
        swapchain_.image(image), Layout::eTransferSrcOptimal, *captureBuffer_.buffer,
        vk::BufferImageCopy{.imageSubresource = {color, 0, 0, 1},
                            .imageExtent = {captureExtent_.width, captureExtent_.height, 1}});
    transition(frame.commands, swapchain_.image(image), color, Layout::eTransferSrcOptimal,
               Layout::ePresentSrcKHR, Stage::eCopy, Access::eTransferRead, Stage::eNone, Access::eNone);
    const vk::MemoryBarrier2 toHost{.srcStageMask = Stage::eCopy,
                                    .srcAccessMask = Access::eTransferWrite,
                                    .dstStageMask = Stage::eHost,
                                    .dstAccessMask = Access::eHostRead};
    frame.commands.pipelineBarrier2(vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &toHost});
    captured_ = true;
    captureWanted = false;
}

void WindowDevice::begin(const Frame& frame, uint32_t image, const EyePlaces& where, bool whole) {
    // The background has the colour of ImGui's windows, which then need none of their own.
    const ImVec4 behind = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
    const vk::ClearValue clear{vk::ClearColorValue{std::array{behind.x, behind.y, behind.z, 1.0f}}};
    if (!whole)
        canvas_.beginWithin(frame.commands, within(where.main, swapchain_.extent()));
    else if (drawsOnCanvas())
        canvas_.begin(frame.commands, clear);
    else
        frame.commands.beginRenderPass(vk::RenderPassBeginInfo{.renderPass = swapchain_.renderPass(),
                                                               .framebuffer = swapchain_.framebuffer(image),
                                                               .renderArea = {.extent = swapchain_.extent()},
                                                               .clearValueCount = 1,
                                                               .pClearValues = &clear},
                                       vk::SubpassContents::eInline);
}

void WindowDevice::record(Frame& frame, uint32_t image, const SceneRenderer* scene, const EyePlaces& where,
                          bool whole) {
    const vk::raii::CommandBuffer& commands = frame.commands;
    commands.reset();
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    frame.timed = *frame.timestamps != vk::QueryPool{};
    if (frame.timed) {
        commands.resetQueryPool(*frame.timestamps, 0, 2);
        commands.writeTimestamp2(vk::PipelineStageFlagBits2::eTopOfPipe, *frame.timestamps, 0);
    }
    begin(frame, image, where, whole);
    recording_ = &commands;
    const std::array places{where.main, where.magnifier};
    for (size_t eye = 0; scene != nullptr && eye < places.size(); ++eye) {
        const FrameSlot* slot = scene->impl().lastFrame(static_cast<Eye>(eye));
        if (slot != nullptr && places[eye].width > 0 && places[eye].height > 0)
            drawScene(frame.sceneSets[eye], *slot, places[eye]);
    }
    if (!whole)
        keepWithin(*ImGui::GetDrawData(), where.main);
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), *commands);
    recording_ = nullptr;
    commands.endRenderPass();
    if (drawsOnCanvas())
        canvas_.copyTo(commands, swapchain_.image(image));
    if (captureWanted && swapchain_.copyable())
        recordCapture(frame, image);
    if (frame.timed)
        commands.writeTimestamp2(vk::PipelineStageFlagBits2::eAllCommands, *frame.timestamps, 1);
    commands.end();
}

void WindowDevice::waitFor(const Frame& frame, WindowTarget::Statistics& statistics) {
    while (gpu_.device.waitForFences(*frame.done, true, UINT64_MAX) == vk::Result::eTimeout) {
    }
    if (frame.timed)
        statistics.gpuSeconds = secondsBetween(gpu_, frame.timestamps).value_or(statistics.gpuSeconds);
}

std::optional<uint32_t> WindowDevice::acquire(const Frame& frame) {
    // The C call: its error codes are expected here, not exceptional.
    uint32_t image = 0;
    const VkResult acquired = gpu_.device.getDispatcher()->vkAcquireNextImageKHR(
        *gpu_.device, swapchain_.handle(), kAcquireTimeout, *frame.acquired, VK_NULL_HANDLE, &image);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR || acquired == VK_TIMEOUT || acquired == VK_NOT_READY) {
        outdated_ = true;
        return std::nullopt;
    }
    if (acquired != VK_SUCCESS && acquired != VK_SUBOPTIMAL_KHR)
        throwResult(acquired, "vkAcquireNextImageKHR");
    return image;
}

bool WindowDevice::present(const SceneRenderer* scene, const EyePlaces& where, bool whole,
                           WindowTarget::Statistics& statistics) {
    const auto start = std::chrono::steady_clock::now();
    Frame& frame = frames_[nextFrame_];
    waitFor(frame, statistics);
    const std::optional<uint32_t> image = acquire(frame);
    statistics.waitSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (!image)
        return false;
    record(frame, *image, scene, where, whole);
    submit(frame, *image);
    nextFrame_ = (nextFrame_ + 1) % frames_.size();
    ++statistics.framesPresented;
    statistics.wholeFrames += whole;
    return true;
}

void WindowDevice::submit(const Frame& frame, uint32_t image) {
    gpu_.device.resetFences(*frame.done);
    using Stage = vk::PipelineStageFlagBits2;
    const vk::SemaphoreSubmitInfo waits{.semaphore = *frame.acquired,
                                        .stageMask =
                                            drawsOnCanvas() ? Stage::eCopy : Stage::eColorAttachmentOutput};
    const vk::SemaphoreSubmitInfo signals{.semaphore = swapchain_.drawn(image),
                                          .stageMask = Stage::eAllCommands};
    const vk::CommandBufferSubmitInfo commands{.commandBuffer = *frame.commands};
    gpu_.queue.submit2(vk::SubmitInfo2{.waitSemaphoreInfoCount = 1,
                                       .pWaitSemaphoreInfos = &waits,
                                       .commandBufferInfoCount = 1,
                                       .pCommandBufferInfos = &commands,
                                       .signalSemaphoreInfoCount = 1,
                                       .pSignalSemaphoreInfos = &signals},
                       *frame.done);
    const vk::Semaphore drawn = swapchain_.drawn(image);
    const vk::SwapchainKHR handle = swapchain_.handle();
    const vk::PresentInfoKHR info{.waitSemaphoreCount = 1,
                                  .pWaitSemaphores = &drawn,
                                  .swapchainCount = 1,
                                  .pSwapchains = &handle,
                                  .pImageIndices = &image};
    const VkResult presented = gpu_.device.getDispatcher()->vkQueuePresentKHR(
        *gpu_.queue, reinterpret_cast<const VkPresentInfoKHR*>(&info));
    // Suboptimal is ignored: followWindow handles changes of size, and some drivers report it forever.
    if (presented == VK_ERROR_OUT_OF_DATE_KHR)
        outdated_ = true;
    else if (presented != VK_SUCCESS && presented != VK_SUBOPTIMAL_KHR)
        throwResult(presented, "vkQueuePresentKHR");
}

std::optional<PixelData> WindowDevice::takeCapture() {
    if (!captured_)
        return std::nullopt;
    gpu_.device.waitIdle();
    PixelData pixels;
    pixels.width = static_cast<int>(captureExtent_.width);
    pixels.height = static_cast<int>(captureExtent_.height);
    pixels.channels = 4;
    const std::byte* from = captureBuffer_.mapped;
    const size_t count = size_t{4} * captureExtent_.width * captureExtent_.height;
    pixels.bytes.assign(from, from + count);
    for (size_t i = 0; i < count; i += 4) {
        if (swapchain_.blueFirst())
            std::swap(pixels.bytes[i], pixels.bytes[i + 2]);
        pixels.bytes[i + 3] = std::byte{255};
    }
    captured_ = false;
    return pixels;
}

} // namespace touchstone
