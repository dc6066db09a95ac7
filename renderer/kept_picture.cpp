#include "renderer/kept_picture.h"

namespace touchstone {

namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;
constexpr vk::ImageAspectFlags kColor = vk::ImageAspectFlagBits::eColor;
constexpr vk::ImageAspectFlags kDepth = vk::ImageAspectFlagBits::eDepth;
constexpr double kStepSeconds = 0.010; ///< beside the coarse picture, within a frame of a thirtieth
constexpr Access kColorAccess = Access::eColorAttachmentWrite;
constexpr vk::PipelineStageFlags2 kDepthStages = Stage::eEarlyFragmentTests | Stage::eLateFragmentTests;
constexpr vk::AccessFlags2 kDepthAccess =
    Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite;

} // namespace

KeptPicture::KeptPicture(const Gpu::Impl& gpu, const Pipelines& pipelines) : gpu_(gpu), step_(kStepSeconds) {
    createSlot(gpu, pipelines.frameSet(), slot);
    sampler_ = vk::raii::Sampler(gpu.device, vk::SamplerCreateInfo{}); // texels are fetched
    const vk::DescriptorPoolSize size{vk::DescriptorType::eCombinedImageSampler, 1 + kLightImages};
    pool_ = vk::raii::DescriptorPool(
        gpu.device, vk::DescriptorPoolCreateInfo{.maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size});
    const vk::DescriptorSetLayout layout = pipelines.keptSet();
    set_ = (*gpu.device)
               .allocateDescriptorSets(vk::DescriptorSetAllocateInfo{.descriptorPool = *pool_,
                                                                     .descriptorSetCount = 1,
                                                                     .pSetLayouts = &layout},
                                       *gpu.device.getDispatcher())
               .front();
}

void KeptPicture::restart(const PictureKey& key) {
    key_ = key;
    begun_ = complete_ = programs_ = false;
    place = {};
}

void KeptPicture::expectPrograms() {
    programs_ = true;
    step_ = StepSize(kStepSeconds); // what other pictures took says nothing of this one
}

bool KeptPicture::idle() {
    if (slot.done.getStatus() != vk::Result::eSuccess)
        return false;
    if (lastWork_ > 0.0 && slot.timed)
        step_.done(secondsBetween(gpu_, slot.timestamps).value_or(0.0), lastWork_);
    lastWork_ = 0.0;
    return true;
}

void KeptPicture::makeImages() {
    if (slot.color.extent != extent())
        resizeSlot(gpu_, extent(), slot); // waits for the device
    else if (!keepsLight() || lights_.back().extent == extent())
        return;
    else
        gpu_.device.waitIdle();
    lights_ = {};
    if (!keepsLight())
        return;
    using Usage = vk::ImageUsageFlagBits;
    std::array<vk::DescriptorImageInfo, 1 + kLightImages> images;
    images[0] = {*sampler_, *slot.depth.view, Layout::eShaderReadOnlyOptimal};
    for (size_t i = 0; i < lights_.size(); ++i) {
        lights_[i] = createImage(
            gpu_,
            {.format = kLightFormat, .extent = extent(), .usage = Usage::eColorAttachment | Usage::eSampled});
        images[1 + i] = {*sampler_, *lights_[i].view, Layout::eShaderReadOnlyOptimal};
    }
    gpu_.device.updateDescriptorSets(
        vk::WriteDescriptorSet{.dstSet = set_,
                               .descriptorCount = images.size(),
                               .descriptorType = vk::DescriptorType::eCombinedImageSampler,
                               .pImageInfo = images.data()},
        {});
}

void KeptPicture::beginStep() {
    makeImages();
    const vk::raii::CommandBuffer& commands = slot.commands;
    beginCommands(slot);
    // The first step discards what earlier frames may still read; a later one goes on with the last.
    const Layout color = begun_ ? Layout::eColorAttachmentOptimal : Layout::eUndefined;
    const auto attach = [&](vk::Image image) {
        transition(commands, image, kColor, color, Layout::eColorAttachmentOptimal,
                   Stage::eColorAttachmentOutput | Stage::eCopy | Stage::eFragmentShader, kColorAccess,
                   Stage::eColorAttachmentOutput, kColorAccess | Access::eColorAttachmentRead);
    };
    attach(*slot.color.image);
    transition(commands, *slot.depth.image, kDepth,
               begun_ ? Layout::eDepthStencilAttachmentOptimal : Layout::eUndefined,
               Layout::eDepthStencilAttachmentOptimal, kDepthStages | Stage::eCopy | Stage::eFragmentShader,
               Access::eDepthStencilAttachmentWrite, kDepthStages, kDepthAccess);
    // The background covers every pixel at last: only depth is cleared.
    const vk::AttachmentLoadOp load = begun_ ? vk::AttachmentLoadOp::eLoad : vk::AttachmentLoadOp::eDontCare;
    std::array<vk::RenderingAttachmentInfo, 1 + kLightImages> colors;
    colors[0].imageView = *slot.color.view;
    for (size_t i = 0; keepsLight() && i < lights_.size(); ++i) {
        attach(*lights_[i].image);
        colors[1 + i].imageView = *lights_[i].view;
    }
    for (vk::RenderingAttachmentInfo& each : colors) {
        each.imageLayout = Layout::eColorAttachmentOptimal;
        each.loadOp = load;
        each.storeOp = vk::AttachmentStoreOp::eStore;
    }
    const vk::RenderingAttachmentInfo depth{.imageView = *slot.depth.view,
                                            .imageLayout = Layout::eDepthStencilAttachmentOptimal,
                                            .loadOp = begun_ ? vk::AttachmentLoadOp::eLoad
                                                             : vk::AttachmentLoadOp::eClear,
                                            .storeOp = vk::AttachmentStoreOp::eStore,
                                            .clearValue = vk::ClearDepthStencilValue{.depth = 1.0f}};
    commands.beginRendering(
        vk::RenderingInfo{.renderArea = {.extent = slot.color.extent},
                          .layerCount = 1,
                          .colorAttachmentCount = keepsLight() ? static_cast<uint32_t>(colors.size()) : 1u,
                          .pColorAttachments = colors.data(),
                          .pDepthAttachment = &depth});
    setViewport(commands, slot.color.extent);
    begun_ = true;
}

void KeptPicture::endStep(double work, bool last) {
    const vk::raii::CommandBuffer& commands = slot.commands;
    commands.endRendering();
    if (last) {
        transition(commands, *slot.color.image, kColor, Layout::eColorAttachmentOptimal,
                   Layout::eTransferSrcOptimal, Stage::eColorAttachmentOutput, kColorAccess, Stage::eCopy,
                   Access::eTransferRead);
        transition(commands, *slot.depth.image, kDepth, Layout::eDepthStencilAttachmentOptimal,
                   Layout::eShaderReadOnlyOptimal, kDepthStages, Access::eDepthStencilAttachmentWrite,
                   Stage::eFragmentShader, Access::eShaderSampledRead);
        for (size_t i = 0; keepsLight() && i < lights_.size(); ++i)
            transition(commands, *lights_[i].image, kColor, Layout::eColorAttachmentOptimal,
                       Layout::eShaderReadOnlyOptimal, Stage::eColorAttachmentOutput, kColorAccess,
                       Stage::eFragmentShader, Access::eShaderSampledRead);
    }
    if (slot.timed)
        commands.writeTimestamp2(Stage::eAllCommands, *slot.timestamps, 1);
    commands.end();
    lastWork_ = work;
    complete_ = last;
}

void KeptPicture::copyTo(const vk::raii::CommandBuffer& commands, const FrameSlot& target) const {
    // Earlier readers of the target are the window's fragment shader and copies.
    transition(commands, *target.color.image, kColor, Layout::eUndefined, Layout::eTransferDstOptimal,
               Stage::eFragmentShader | Stage::eCopy | Stage::eColorAttachmentOutput, kColorAccess,
               Stage::eCopy, Access::eTransferWrite);
    transition(commands, *target.depth.image, kDepth, Layout::eUndefined, Layout::eTransferDstOptimal,
               kDepthStages, Access::eDepthStencilAttachmentWrite, Stage::eCopy, Access::eTransferWrite);
    const vk::Extent3D size{target.color.extent.width, target.color.extent.height, 1};
    commands.copyImage(
        *slot.color.image, Layout::eTransferSrcOptimal, *target.color.image, Layout::eTransferDstOptimal,
        vk::ImageCopy{
            .srcSubresource = {kColor, 0, 0, 1}, .dstSubresource = {kColor, 0, 0, 1}, .extent = size});
    // Depth is copied here and sampled by the shadow: it changes its layout for the copy.
    transition(commands, *slot.depth.image, kDepth, Layout::eShaderReadOnlyOptimal,
               Layout::eTransferSrcOptimal, Stage::eFragmentShader, Access::eShaderSampledRead, Stage::eCopy,
               Access::eTransferRead);
    commands.copyImage(
        *slot.depth.image, Layout::eTransferSrcOptimal, *target.depth.image, Layout::eTransferDstOptimal,
        vk::ImageCopy{
            .srcSubresource = {kDepth, 0, 0, 1}, .dstSubresource = {kDepth, 0, 0, 1}, .extent = size});
    transition(commands, *slot.depth.image, kDepth, Layout::eTransferSrcOptimal,
               Layout::eShaderReadOnlyOptimal, Stage::eCopy, Access::eTransferRead, Stage::eFragmentShader,
               Access::eShaderSampledRead);
    transition(commands, *target.color.image, kColor, Layout::eTransferDstOptimal,
               Layout::eColorAttachmentOptimal, Stage::eCopy, Access::eTransferWrite,
               Stage::eColorAttachmentOutput, kColorAccess | Access::eColorAttachmentRead);
    transition(commands, *target.depth.image, kDepth, Layout::eTransferDstOptimal,
               Layout::eDepthStencilAttachmentOptimal, Stage::eCopy, Access::eTransferWrite, kDepthStages,
               kDepthAccess);
}

} // namespace touchstone
