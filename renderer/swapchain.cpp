#include "renderer/swapchain.h"

#include "engine/core/error.h"

#include <algorithm>

namespace touchstone {

vk::raii::RenderPass makeWindowPass(const Gpu::Impl& gpu, const WindowPass& pass) {
    using Stage = vk::PipelineStageFlagBits;
    using Access = vk::AccessFlagBits;
    const vk::AttachmentDescription attachment{.format = pass.format,
                                               .loadOp = pass.load,
                                               .storeOp = vk::AttachmentStoreOp::eStore,
                                               .stencilLoadOp = vk::AttachmentLoadOp::eDontCare,
                                               .stencilStoreOp = vk::AttachmentStoreOp::eDontCare,
                                               .initialLayout = pass.before,
                                               .finalLayout = pass.after};
    const vk::AttachmentReference color{0, vk::ImageLayout::eColorAttachmentOptimal};
    const vk::SubpassDescription subpass{.pipelineBindPoint = vk::PipelineBindPoint::eGraphics,
                                         .colorAttachmentCount = 1,
                                         .pColorAttachments = &color};
    // Before: the acquire semaphore, waited for at this stage, makes an image of the swapchain writable; a
    // preserved image was written by the previous pass and copied from. After: copies.
    const std::array dependencies{
        vk::SubpassDependency{.srcSubpass = VK_SUBPASS_EXTERNAL,
                              .dstSubpass = 0,
                              .srcStageMask = Stage::eColorAttachmentOutput | Stage::eTransfer,
                              .dstStageMask = Stage::eColorAttachmentOutput,
                              .srcAccessMask = Access::eColorAttachmentWrite,
                              .dstAccessMask = Access::eColorAttachmentRead | Access::eColorAttachmentWrite},
        vk::SubpassDependency{.srcSubpass = 0,
                              .dstSubpass = VK_SUBPASS_EXTERNAL,
                              .srcStageMask = Stage::eColorAttachmentOutput,
                              .dstStageMask = Stage::eTransfer | Stage::eBottomOfPipe,
                              .srcAccessMask = Access::eColorAttachmentWrite,
                              .dstAccessMask = Access::eTransferRead}};
    return {gpu.device, vk::RenderPassCreateInfo{.attachmentCount = 1,
                                                 .pAttachments = &attachment,
                                                 .subpassCount = 1,
                                                 .pSubpasses = &subpass,
                                                 .dependencyCount = dependencies.size(),
                                                 .pDependencies = dependencies.data()}};
}

Swapchain::Swapchain(const Gpu::Impl& gpu) : gpu_(gpu) {
    chooseFormat();
    renderPass_ = makeWindowPass(gpu_, {format_.format, vk::AttachmentLoadOp::eClear,
                                        vk::ImageLayout::eUndefined, vk::ImageLayout::ePresentSrcKHR});
}

void Swapchain::chooseFormat() {
    // The shader writes encoded bytes (see window.frag), so the format must not encode sRGB again.
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
    uint32_t count = std::max(2u, can.minImageCount) + 1;
    if (can.maxImageCount > 0)
        count = std::min(count, can.maxImageCount);
    copyable_ = static_cast<bool>(can.supportedUsageFlags & vk::ImageUsageFlagBits::eTransferSrc);
    fillable_ = static_cast<bool>(can.supportedUsageFlags & vk::ImageUsageFlagBits::eTransferDst);
    vk::ImageUsageFlags usage = vk::ImageUsageFlagBits::eColorAttachment;
    if (copyable_)
        usage |= vk::ImageUsageFlagBits::eTransferSrc;
    if (fillable_)
        usage |= vk::ImageUsageFlagBits::eTransferDst;
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
