#include "renderer/swapchain.h"

#include "engine/core/error.h"

#include <algorithm>

namespace touchstone {

Swapchain::Swapchain(const Gpu::Impl& gpu) : gpu_(gpu) {
    chooseFormat();
    makeRenderPass();
}

void Swapchain::chooseFormat() {
    // Bytes go out as they are (see window.frag), so the format must not encode sRGB once more.
    for (const vk::SurfaceFormatKHR& candidate : gpu_.physical.getSurfaceFormatsKHR(*gpu_.surface))
        if (candidate.colorSpace == vk::ColorSpaceKHR::eSrgbNonlinear &&
            (candidate.format == vk::Format::eB8G8R8A8Unorm ||
             candidate.format == vk::Format::eR8G8B8A8Unorm)) {
            format_ = candidate;
            return;
        }
    throw Error("Vulkan", "window", "the window takes no 8 bit RGBA pictures",
                "choose another device with TOUCHSTONE_GPU");
}

void Swapchain::makeRenderPass() {
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    const vk::AttachmentDescription attachment{.format = format_.format,
                                               .loadOp = vk::AttachmentLoadOp::eClear,
                                               .storeOp = vk::AttachmentStoreOp::eStore,
                                               .stencilLoadOp = vk::AttachmentLoadOp::eDontCare,
                                               .stencilStoreOp = vk::AttachmentStoreOp::eDontCare,
                                               .finalLayout = vk::ImageLayout::ePresentSrcKHR};
    const vk::AttachmentReference color{0, vk::ImageLayout::eColorAttachmentOptimal};
    const vk::SubpassDescription subpass{.pipelineBindPoint = vk::PipelineBindPoint::eGraphics,
                                         .colorAttachmentCount = 1,
                                         .pColorAttachments = &color};
    // The image may be written once the acquire semaphore, waited for at this stage, says so; and it may be
    // copied for a capture after the pass.
    const std::array dependencies{
        vk::SubpassDependency{.srcSubpass = VK_SUBPASS_EXTERNAL,
                              .dstSubpass = 0,
                              .srcStageMask = Stage::eColorAttachmentOutput,
                              .dstStageMask = Stage::eColorAttachmentOutput,
                              .dstAccessMask = Access::eColorAttachmentWrite},
        vk::SubpassDependency{.srcSubpass = 0,
                              .dstSubpass = VK_SUBPASS_EXTERNAL,
                              .srcStageMask = Stage::eColorAttachmentOutput,
                              .dstStageMask = Stage::eTransfer | Stage::eBottomOfPipe,
                              .srcAccessMask = Access::eColorAttachmentWrite,
                              .dstAccessMask = Access::eTransferRead}};
    renderPass_ =
        vk::raii::RenderPass(gpu_.device, vk::RenderPassCreateInfo{.attachmentCount = 1,
                                                                   .pAttachments = &attachment,
                                                                   .subpassCount = 1,
                                                                   .pSubpasses = &subpass,
                                                                   .dependencyCount = dependencies.size(),
                                                                   .pDependencies = dependencies.data()});
}

void Swapchain::destroy() {
    framebuffers_.clear();
    views_.clear();
    images_.clear();
    drawn_.clear();
    swapchain_ = nullptr;
    extent_ = vk::Extent2D{};
}

bool Swapchain::recreate(vk::Extent2D wanted) {
    const vk::SurfaceCapabilitiesKHR can = gpu_.physical.getSurfaceCapabilitiesKHR(*gpu_.surface);
    // A fixed current extent is the window's own; a swapchain of another size is an error there.
    if (can.currentExtent.width != UINT32_MAX)
        wanted = can.currentExtent;
    wanted.width = std::clamp(wanted.width, can.minImageExtent.width, can.maxImageExtent.width);
    wanted.height = std::clamp(wanted.height, can.minImageExtent.height, can.maxImageExtent.height);
    if (wanted.width == 0 || wanted.height == 0) {
        destroy();
        return false;
    }
    minImageCount_ = std::max(2u, can.minImageCount);
    uint32_t count = minImageCount_ + 1;
    if (can.maxImageCount > 0)
        count = std::min(count, can.maxImageCount);
    copyable_ = static_cast<bool>(can.supportedUsageFlags & vk::ImageUsageFlagBits::eTransferSrc);
    vk::ImageUsageFlags usage = vk::ImageUsageFlagBits::eColorAttachment;
    if (copyable_)
        usage |= vk::ImageUsageFlagBits::eTransferSrc;
    vk::raii::SwapchainKHR old = std::move(swapchain_);
    destroy();
    using Alpha = vk::CompositeAlphaFlagBitsKHR;
    swapchain_ = vk::raii::SwapchainKHR(
        gpu_.device, vk::SwapchainCreateInfoKHR{
                         .surface = *gpu_.surface,
                         .minImageCount = count,
                         .imageFormat = format_.format,
                         .imageColorSpace = format_.colorSpace,
                         .imageExtent = wanted,
                         .imageArrayLayers = 1,
                         .imageUsage = usage,
                         .preTransform = can.currentTransform,
                         .compositeAlpha = (can.supportedCompositeAlpha & Alpha::eOpaque) ? Alpha::eOpaque
                                                                                          : Alpha::eInherit,
                         .presentMode = vk::PresentModeKHR::eFifo,
                         .clipped = true,
                         .oldSwapchain = *old});
    old = nullptr;
    extent_ = wanted;
    for (const VkImage image : swapchain_.getImages()) {
        images_.emplace_back(image);
        views_.emplace_back(
            gpu_.device,
            vk::ImageViewCreateInfo{.image = images_.back(),
                                    .viewType = vk::ImageViewType::e2D,
                                    .format = format_.format,
                                    .subresourceRange = {vk::ImageAspectFlagBits::eColor, 0, 1, 0, 1}});
        const vk::ImageView view = *views_.back();
        framebuffers_.emplace_back(gpu_.device, vk::FramebufferCreateInfo{.renderPass = *renderPass_,
                                                                          .attachmentCount = 1,
                                                                          .pAttachments = &view,
                                                                          .width = wanted.width,
                                                                          .height = wanted.height,
                                                                          .layers = 1});
        drawn_.emplace_back(gpu_.device, vk::SemaphoreCreateInfo{});
    }
    return true;
}

} // namespace touchstone
