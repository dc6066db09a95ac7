#include "renderer/window_target.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#define GLFW_INCLUDE_NONE
#include "engine/core/error.h"
#include "renderer/gpu_memory.h"
#include "renderer/graphics_pipeline.h"
#include "renderer/scene_renderer_impl.h"
#include "renderer/shader_code.h"
#include "renderer/swapchain.h"

#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_vulkan.h>

// GLFW declares this only when it includes Vulkan itself.
extern "C" VkResult glfwCreateWindowSurface(VkInstance instance, GLFWwindow* window,
                                            const VkAllocationCallbacks* allocator, VkSurfaceKHR* surface);

namespace touchstone {

namespace {

constexpr size_t kFramesInFlight = 2;
constexpr uint64_t kAcquireTimeout = 1'000'000'000; ///< ns; a window system that is gone must not hang us

/// What a frame in flight needs of its own.
struct WindowFrame {
    vk::raii::CommandBuffer commands{nullptr};
    vk::raii::Fence done{nullptr};
    vk::raii::Semaphore acquired{nullptr};
    std::array<vk::DescriptorSet, 2> sceneSets; ///< of each Eye
};

void checkImGui(VkResult result) {
    // Called from C callbacks of a foreign library, within our own call of it.
    if (result < 0)
        vk::throwResultException(static_cast<vk::Result>(result), "Dear ImGui");
}

} // namespace

std::unique_ptr<Gpu> createGpuForWindow(GLFWwindow* window, const GpuOptions& options) {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr)
        throw Error(
            "Vulkan", "window", "the window system offers no Vulkan surface",
            "apt install libvulkan1 mesa-vulkan-drivers, or run without a window: touchstone run --headless");
    SurfaceRequest request;
    request.instanceExtensions.assign(names, names + count);
    request.create = [window](VkInstance instance) {
        VkSurfaceKHR surface = VK_NULL_HANDLE;
        if (glfwCreateWindowSurface(instance, window, nullptr, &surface) != VK_SUCCESS)
            throw Error("Vulkan", "window", "no surface can be made for this window",
                        "run without a window: touchstone run --headless");
        return surface;
    };
    return createGpu(options, &request);
}

struct WindowTarget::Impl {
    Impl(Gpu& owner, GLFWwindow* target);
    ~Impl();

    void createImGui();
    void createScenePipeline();
    void createFrames();
    [[nodiscard]] vk::Extent2D framebufferSize() const;
    bool followWindow();
    void present(SceneRenderer* scene, const EyePlaces& where);
    void record(const WindowFrame& frame, uint32_t image, const SceneRenderer* scene, const EyePlaces& where);
    void drawScene(const WindowFrame& frame, vk::DescriptorSet set, const FrameSlot& scene,
                   const PixelRect& where);
    void recordCapture(const WindowFrame& frame, uint32_t image);

    Gpu::Impl& gpu;
    GLFWwindow* window;
    Swapchain swapchain;
    vk::raii::Sampler sampler{nullptr};
    vk::raii::DescriptorSetLayout sceneSetLayout{nullptr};
    vk::raii::PipelineLayout sceneLayout{nullptr};
    vk::raii::Pipeline scenePipeline{nullptr};
    vk::raii::DescriptorPool pool{nullptr}; ///< our sets and ImGui's font
    std::array<WindowFrame, kFramesInFlight> frames;
    size_t nextFrame = 0;
    vk::Extent2D lastSize;
    bool outdated = true;
    bool frameBegun = false;
    WindowTarget::Statistics statistics;

    bool captureWanted = false;
    GpuBuffer captureBuffer;
    vk::Extent2D captureExtent;
    bool captured = false;
};

WindowTarget::Impl::Impl(Gpu& owner, GLFWwindow* target) : gpu(owner.impl()), window(target), swapchain(gpu) {
    createScenePipeline();
    createFrames();
    createImGui();
}

WindowTarget::Impl::~Impl() {
    // A lost device cannot be waited for.
    try {
        gpu.device.waitIdle();
    } catch (const vk::SystemError&) {
    }
    ImGui_ImplVulkan_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
}

void WindowTarget::Impl::createScenePipeline() {
    sampler = vk::raii::Sampler(gpu.device,
                                vk::SamplerCreateInfo{.magFilter = vk::Filter::eLinear,
                                                      .minFilter = vk::Filter::eLinear,
                                                      .addressModeU = vk::SamplerAddressMode::eClampToEdge,
                                                      .addressModeV = vk::SamplerAddressMode::eClampToEdge});
    const vk::DescriptorSetLayoutBinding binding{.binding = 0,
                                                 .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                                                 .descriptorCount = 1,
                                                 .stageFlags = vk::ShaderStageFlagBits::eFragment};
    sceneSetLayout = vk::raii::DescriptorSetLayout(
        gpu.device, vk::DescriptorSetLayoutCreateInfo{.bindingCount = 1, .pBindings = &binding});
    const vk::DescriptorSetLayout set = *sceneSetLayout;
    sceneLayout = vk::raii::PipelineLayout(
        gpu.device, vk::PipelineLayoutCreateInfo{.setLayoutCount = 1, .pSetLayouts = &set});
    PipelineRecipe recipe;
    recipe.vertexCode = shaders::full_screen_vert;
    recipe.fragmentCode = shaders::window_frag;
    recipe.depthTest = recipe.depthWrite = false;
    recipe.layout = *sceneLayout;
    recipe.renderPass = swapchain.renderPass();
    scenePipeline =
        makePipeline(gpu, vk::raii::PipelineCache(gpu.device, vk::PipelineCacheCreateInfo{}), recipe);
}

void WindowTarget::Impl::createFrames() {
    const vk::DescriptorPoolSize size{vk::DescriptorType::eCombinedImageSampler, 2 * kFramesInFlight + 8};
    // ImGui frees its own set.
    pool = vk::raii::DescriptorPool(
        gpu.device,
        vk::DescriptorPoolCreateInfo{.flags = vk::DescriptorPoolCreateFlagBits::eFreeDescriptorSet,
                                     .maxSets = 2 * kFramesInFlight + 8,
                                     .poolSizeCount = 1,
                                     .pPoolSizes = &size});
    for (WindowFrame& frame : frames) {
        vk::raii::CommandBuffers buffers(
            gpu.device,
            vk::CommandBufferAllocateInfo{.commandPool = *gpu.commandPool, .commandBufferCount = 1});
        frame.commands = std::move(buffers.front());
        frame.done =
            vk::raii::Fence(gpu.device, vk::FenceCreateInfo{.flags = vk::FenceCreateFlagBits::eSignaled});
        frame.acquired = vk::raii::Semaphore(gpu.device, vk::SemaphoreCreateInfo{});
        const vk::DescriptorSetLayout layout = *sceneSetLayout;
        for (vk::DescriptorSet& set : frame.sceneSets)
            set = (*gpu.device)
                      .allocateDescriptorSets(vk::DescriptorSetAllocateInfo{.descriptorPool = *pool,
                                                                            .descriptorSetCount = 1,
                                                                            .pSetLayouts = &layout},
                                              *gpu.device.getDispatcher())
                      .front();
    }
}

void WindowTarget::Impl::createImGui() {
    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // nothing is written behind the user's back
    ImGui_ImplGlfw_InitForVulkan(window, true);
    ImGui_ImplVulkan_InitInfo info{};
    info.Instance = *gpu.instance;
    info.PhysicalDevice = *gpu.physical;
    info.Device = *gpu.device;
    info.QueueFamily = gpu.queueFamily;
    info.Queue = *gpu.queue;
    info.DescriptorPool = *pool;
    info.MinImageCount = 2;
    // It cycles this many vertex buffers; not fewer than the frames in flight.
    info.ImageCount = static_cast<uint32_t>(kFramesInFlight) + 1;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    info.CheckVkResultFn = &checkImGui;
    ImGui_ImplVulkan_Init(&info, swapchain.renderPass());
}

vk::Extent2D WindowTarget::Impl::framebufferSize() const {
    int width = 0, height = 0;
    glfwGetFramebufferSize(window, &width, &height);
    return {static_cast<uint32_t>(std::max(width, 0)), static_cast<uint32_t>(std::max(height, 0))};
}

bool WindowTarget::Impl::followWindow() {
    const vk::Extent2D size = framebufferSize();
    if (size.width == 0 || size.height == 0 || glfwGetWindowAttrib(window, GLFW_ICONIFIED) != 0)
        return false;
    if (!outdated && size == lastSize)
        return true;
    gpu.device.waitIdle();
    // A semaphore of an acquire that was never submitted stays signalled; fresh ones cost nothing.
    for (WindowFrame& frame : frames)
        frame.acquired = vk::raii::Semaphore(gpu.device, vk::SemaphoreCreateInfo{});
    if (!swapchain.recreate(size))
        return false;
    ++statistics.swapchainsMade;
    lastSize = size;
    outdated = false;
    return true;
}

void WindowTarget::Impl::drawScene(const WindowFrame& frame, vk::DescriptorSet set, const FrameSlot& scene,
                                   const PixelRect& where) {
    const vk::DescriptorImageInfo image{*sampler, *scene.colorBytes, vk::ImageLayout::eShaderReadOnlyOptimal};
    gpu.device.updateDescriptorSets(
        vk::WriteDescriptorSet{.dstSet = set,
                               .descriptorCount = 1,
                               .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                               .pImageInfo = &image},
        {});
    // The scissor is the part of the place that lies in the window.
    const auto width = static_cast<int>(swapchain.extent().width),
               height = static_cast<int>(swapchain.extent().height);
    const int left = std::clamp(where.x, 0, width), top = std::clamp(where.y, 0, height);
    const int right = std::clamp(where.x + where.width, left, width);
    const int bottom = std::clamp(where.y + where.height, top, height);
    if (right == left || bottom == top)
        return;
    const vk::raii::CommandBuffer& commands = frame.commands;
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, *scenePipeline);
    commands.setCullMode(vk::CullModeFlagBits::eNone);
    commands.setFrontFace(vk::FrontFace::eCounterClockwise);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, *sceneLayout, 0, set, {});
    commands.setViewport(0, vk::Viewport{.x = static_cast<float>(where.x),
                                         .y = static_cast<float>(where.y),
                                         .width = static_cast<float>(where.width),
                                         .height = static_cast<float>(where.height),
                                         .maxDepth = 1.0f});
    commands.setScissor(
        0, vk::Rect2D{.offset = {left, top},
                      .extent = {static_cast<uint32_t>(right - left), static_cast<uint32_t>(bottom - top)}});
    commands.draw(3, 1, 0, 0);
}

void WindowTarget::Impl::recordCapture(const WindowFrame& frame, uint32_t image) {
    using Stage = vk::PipelineStageFlagBits2;
    using Access = vk::AccessFlagBits2;
    using Layout = vk::ImageLayout;
    const vk::ImageAspectFlags color = vk::ImageAspectFlagBits::eColor;
    captureExtent = swapchain.extent();
    captureBuffer = createBuffer(gpu, size_t{4} * captureExtent.width * captureExtent.height,
                                 vk::BufferUsageFlagBits::eTransferDst, MemoryUse::Readback);
    transition(frame.commands, swapchain.image(image), color, Layout::ePresentSrcKHR,
               Layout::eTransferSrcOptimal, Stage::eColorAttachmentOutput | Stage::eAllTransfer,
               Access::eColorAttachmentWrite, Stage::eCopy, Access::eTransferRead);
    frame.commands.copyImageToBuffer(
        swapchain.image(image), Layout::eTransferSrcOptimal, *captureBuffer.buffer,
        vk::BufferImageCopy{.imageSubresource = {color, 0, 0, 1},
                            .imageExtent = {captureExtent.width, captureExtent.height, 1}});
    transition(frame.commands, swapchain.image(image), color, Layout::eTransferSrcOptimal,
               Layout::ePresentSrcKHR, Stage::eCopy, Access::eTransferRead, Stage::eNone, Access::eNone);
    const vk::MemoryBarrier2 toHost{.srcStageMask = Stage::eCopy,
                                    .srcAccessMask = Access::eTransferWrite,
                                    .dstStageMask = Stage::eHost,
                                    .dstAccessMask = Access::eHostRead};
    frame.commands.pipelineBarrier2(vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &toHost});
    captured = true;
    captureWanted = false;
}

void WindowTarget::Impl::record(const WindowFrame& frame, uint32_t image, const SceneRenderer* scene,
                                const EyePlaces& where) {
    const vk::raii::CommandBuffer& commands = frame.commands;
    commands.reset();
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    // What lies behind everything is as the windows are, which then need no background of their own.
    const ImVec4 behind = ImGui::GetStyleColorVec4(ImGuiCol_WindowBg);
    const vk::ClearValue clear{vk::ClearColorValue{std::array{behind.x, behind.y, behind.z, 1.0f}}};
    commands.beginRenderPass(vk::RenderPassBeginInfo{.renderPass = swapchain.renderPass(),
                                                     .framebuffer = swapchain.framebuffer(image),
                                                     .renderArea = {.extent = swapchain.extent()},
                                                     .clearValueCount = 1,
                                                     .pClearValues = &clear},
                             vk::SubpassContents::eInline);
    const std::array places{where.main, where.magnifier};
    for (size_t eye = 0; scene != nullptr && eye < places.size(); ++eye) {
        const FrameSlot* slot = scene->impl().lastFrame(static_cast<Eye>(eye));
        if (slot != nullptr && places[eye].width > 0 && places[eye].height > 0)
            drawScene(frame, frame.sceneSets[eye], *slot, places[eye]);
    }
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), *commands);
    commands.endRenderPass();
    if (captureWanted && swapchain.copyable())
        recordCapture(frame, image);
    commands.end();
}

void WindowTarget::Impl::present(SceneRenderer* scene, const EyePlaces& where) {
    const auto start = std::chrono::steady_clock::now();
    WindowFrame& frame = frames[nextFrame];
    while (gpu.device.waitForFences(*frame.done, true, UINT64_MAX) == vk::Result::eTimeout) {
    }
    // The C call: its error codes are ordinary news here, not exceptions.
    uint32_t image = 0;
    const VkResult acquired = gpu.device.getDispatcher()->vkAcquireNextImageKHR(
        *gpu.device, swapchain.handle(), kAcquireTimeout, *frame.acquired, VK_NULL_HANDLE, &image);
    statistics.waitSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR || acquired == VK_TIMEOUT || acquired == VK_NOT_READY) {
        outdated = true;
        return;
    }
    if (acquired != VK_SUCCESS && acquired != VK_SUBOPTIMAL_KHR)
        vk::throwResultException(static_cast<vk::Result>(acquired), "vkAcquireNextImageKHR");
    record(frame, image, scene, where);

    gpu.device.resetFences(*frame.done);
    const vk::SemaphoreSubmitInfo waits{.semaphore = *frame.acquired,
                                        .stageMask = vk::PipelineStageFlagBits2::eColorAttachmentOutput};
    const vk::SemaphoreSubmitInfo signals{.semaphore = swapchain.drawn(image),
                                          .stageMask = vk::PipelineStageFlagBits2::eAllCommands};
    const vk::CommandBufferSubmitInfo commands{.commandBuffer = *frame.commands};
    gpu.queue.submit2(vk::SubmitInfo2{.waitSemaphoreInfoCount = 1,
                                      .pWaitSemaphoreInfos = &waits,
                                      .commandBufferInfoCount = 1,
                                      .pCommandBufferInfos = &commands,
                                      .signalSemaphoreInfoCount = 1,
                                      .pSignalSemaphoreInfos = &signals},
                      *frame.done);
    nextFrame = (nextFrame + 1) % frames.size();
    const vk::Semaphore drawn = swapchain.drawn(image);
    const vk::SwapchainKHR handle = swapchain.handle();
    const vk::PresentInfoKHR info{.waitSemaphoreCount = 1,
                                  .pWaitSemaphores = &drawn,
                                  .swapchainCount = 1,
                                  .pSwapchains = &handle,
                                  .pImageIndices = &image};
    const VkResult presented = gpu.device.getDispatcher()->vkQueuePresentKHR(
        *gpu.queue, reinterpret_cast<const VkPresentInfoKHR*>(&info));
    // Suboptimal is left alone: a change of size is seen by followWindow, and some drivers never stop saying
    // it.
    if (presented == VK_ERROR_OUT_OF_DATE_KHR)
        outdated = true;
    else if (presented != VK_SUCCESS && presented != VK_SUBOPTIMAL_KHR)
        vk::throwResultException(static_cast<vk::Result>(presented), "vkQueuePresentKHR");
    ++statistics.framesPresented;
}

WindowTarget::WindowTarget(Gpu& gpu, GLFWwindow* window, const std::function<void()>& setUp)
    : impl_(translatingErrors("setting up the window", [&] {
          if (!*gpu.impl().surface)
              throw std::invalid_argument("this Gpu was not made for a window");
          return std::make_unique<Impl>(gpu, window);
      })) {
    if (setUp)
        setUp();
    translatingErrors("uploading the font", [&] {
        runOnce(impl_->gpu, [](const vk::raii::CommandBuffer& commands) {
            ImGui_ImplVulkan_CreateFontsTexture(*commands);
        });
        ImGui_ImplVulkan_DestroyFontUploadObjects();
    });
}

WindowTarget::~WindowTarget() = default;

glm::ivec2 WindowTarget::size() const {
    const vk::Extent2D size = impl_->swapchain.extent();
    return {static_cast<int>(size.width), static_cast<int>(size.height)};
}

bool WindowTarget::beginFrame() {
    return translatingErrors("following the window", [&] {
        if (!impl_->followWindow())
            return false;
        ImGui_ImplVulkan_NewFrame();
        ImGui_ImplGlfw_NewFrame();
        ImGui::NewFrame();
        impl_->frameBegun = true;
        return true;
    });
}

void WindowTarget::endFrame(SceneRenderer* scene, const EyePlaces& where) {
    if (!impl_->frameBegun)
        return;
    impl_->frameBegun = false;
    ImGui::Render();
    translatingErrors("presenting a frame", [&] { impl_->present(scene, where); });
}

void WindowTarget::cancelFrame() {
    if (impl_->frameBegun)
        ImGui::EndFrame();
    impl_->frameBegun = false;
}

void WindowTarget::requestCapture() {
    impl_->captureWanted = true;
}

std::optional<PixelData> WindowTarget::takeCapture() {
    if (!impl_->captured)
        return std::nullopt;
    translatingErrors("reading the window", [&] { impl_->gpu.device.waitIdle(); });
    PixelData pixels;
    pixels.width = static_cast<int>(impl_->captureExtent.width);
    pixels.height = static_cast<int>(impl_->captureExtent.height);
    pixels.channels = 4;
    const std::byte* from = impl_->captureBuffer.mapped;
    const size_t count = size_t{4} * impl_->captureExtent.width * impl_->captureExtent.height;
    pixels.bytes.assign(from, from + count);
    for (size_t i = 0; i < count; i += 4) {
        if (impl_->swapchain.blueFirst())
            std::swap(pixels.bytes[i], pixels.bytes[i + 2]);
        pixels.bytes[i + 3] = std::byte{255};
    }
    impl_->captured = false;
    return pixels;
}

const WindowTarget::Statistics& WindowTarget::statistics() const {
    return impl_->statistics;
}

} // namespace touchstone
