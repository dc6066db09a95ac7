#include "renderer/window_canvas.h"

#include "renderer/swapchain.h"

namespace touchstone {

namespace {

using Layout = vk::ImageLayout;
using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;

} // namespace

WindowCanvas::WindowCanvas(const Gpu::Impl& gpu, vk::Format format)
    : gpu_(gpu), format_(format),
      clearing_(makeWindowPass(
          gpu, {format, vk::AttachmentLoadOp::eClear, Layout::eUndefined, Layout::eTransferSrcOptimal})),
      keeping_(makeWindowPass(gpu, {format, vk::AttachmentLoadOp::eLoad, Layout::eTransferSrcOptimal,
                                    Layout::eTransferSrcOptimal})) {}

void WindowCanvas::resize(vk::Extent2D extent) {
    painted_ = false;
    framebuffer_ = nullptr;
    image_ = GpuImage{};
    image_ = createImage(
        gpu_, {.format = format_,
               .extent = extent,
               .usage = vk::ImageUsageFlagBits::eColorAttachment | vk::ImageUsageFlagBits::eTransferSrc});
    const vk::ImageView view = *image_.view;
    framebuffer_ = vk::raii::Framebuffer(gpu_.device, vk::FramebufferCreateInfo{.renderPass = *clearing_,
                                                                                .attachmentCount = 1,
                                                                                .pAttachments = &view,
                                                                                .width = extent.width,
                                                                                .height = extent.height,
                                                                                .layers = 1});
}

void WindowCanvas::begin(const vk::raii::CommandBuffer& commands, const vk::ClearValue& clear) {
    commands.beginRenderPass(vk::RenderPassBeginInfo{.renderPass = *clearing_,
                                                     .framebuffer = *framebuffer_,
                                                     .renderArea = {.extent = image_.extent},
                                                     .clearValueCount = 1,
                                                     .pClearValues = &clear},
                             vk::SubpassContents::eInline);
    painted_ = true;
}

void WindowCanvas::beginWithin(const vk::raii::CommandBuffer& commands, const vk::Rect2D& area) const {
    commands.beginRenderPass(
        vk::RenderPassBeginInfo{.renderPass = *keeping_, .framebuffer = *framebuffer_, .renderArea = area},
        vk::SubpassContents::eInline);
}

void WindowCanvas::copyTo(const vk::raii::CommandBuffer& commands, vk::Image target) const {
    const vk::ImageAspectFlags color = vk::ImageAspectFlagBits::eColor;
    transition(commands, target, color, Layout::eUndefined, Layout::eTransferDstOptimal, Stage::eCopy,
               Access::eNone, Stage::eCopy, Access::eTransferWrite);
    commands.copyImage(*image_.image, Layout::eTransferSrcOptimal, target, Layout::eTransferDstOptimal,
                       vk::ImageCopy{.srcSubresource = {color, 0, 0, 1},
                                     .dstSubresource = {color, 0, 0, 1},
                                     .extent = {image_.extent.width, image_.extent.height, 1}});
    transition(commands, target, color, Layout::eTransferDstOptimal, Layout::ePresentSrcKHR, Stage::eCopy,
               Access::eTransferWrite, Stage::eNone, Access::eNone);
}

} // namespace touchstone
