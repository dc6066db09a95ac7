// The commands of one frame: scene and overlay.

#include "renderer/scene_renderer_impl.h"

#include <cstring>

namespace touchstone {

namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;
constexpr vk::ImageAspectFlags kColor = vk::ImageAspectFlagBits::eColor;
constexpr vk::ImageAspectFlags kDepth = vk::ImageAspectFlagBits::eDepth;

} // namespace

void SceneRenderer::Impl::writeOverlay(FrameSlot& slot, const OverlayDraw& draw) {
    const auto shapes = std::as_bytes(std::span(draw.shapes)), lines = std::as_bytes(std::span(draw.lines));
    if (slot.overlay.size < shapes.size() + lines.size())
        slot.overlay = createBuffer(gpu, 2 * (shapes.size() + lines.size()),
                                    vk::BufferUsageFlagBits::eVertexBuffer, MemoryUse::Upload);
    if (!shapes.empty())
        std::memcpy(slot.overlay.mapped, shapes.data(), shapes.size());
    if (!lines.empty())
        std::memcpy(slot.overlay.mapped + shapes.size(), lines.data(), lines.size());
}

void SceneRenderer::Impl::drawOverlay(const vk::raii::CommandBuffer& commands, const FrameSlot& slot,
                                      const OverlayDraw& draw, bool showHidden) {
    const vk::DeviceSize linesAt = draw.shapes.size() * sizeof(ShapeInstance);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, pipelines_.overlayLayout(), 0,
                                slot.frameSet, {});
    commands.setFrontFace(vk::FrontFace::eCounterClockwise);
    const auto drawBatches = [&](OverlayPass pass) {
        if (draw.batches.empty())
            return;
        commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.shapes(pass));
        commands.bindIndexBuffer(*shapeIndices_.buffer, 0, vk::IndexType::eUint16);
        commands.bindVertexBuffers(0, {*shapeVertices_.buffer, *slot.overlay.buffer}, {0, 0});
        for (const OverlayDraw::Batch& batch : draw.batches) {
            if (pass != OverlayPass::Hidden && batch.translucent != (pass == OverlayPass::Translucent))
                continue;
            commands.setCullMode(batch.shape == OverlayShape::Disc ? vk::CullModeFlagBits::eNone
                                                                   : vk::CullModeFlagBits::eBack);
            const ShapeMeshes::Range& range = shapes_.ranges[static_cast<size_t>(batch.shape)];
            commands.drawIndexed(range.indexCount, batch.count, range.firstIndex, 0, batch.first);
            ++statistics.drawCalls;
        }
    };
    const auto drawLines = [&](OverlayPass pass) {
        const auto count =
            pass == OverlayPass::Hidden ? draw.shownHidden : static_cast<uint32_t>(draw.lines.size());
        if (count == 0)
            return;
        commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.lines(pass));
        commands.bindVertexBuffers(0, *slot.overlay.buffer, linesAt);
        commands.setCullMode(vk::CullModeFlagBits::eNone);
        commands.draw(4, count, 0, 0);
        ++statistics.drawCalls;
    };
    // First the hidden parts, against the scene's depth alone; then the items among themselves.
    if (showHidden) {
        drawBatches(OverlayPass::Hidden);
        drawLines(OverlayPass::Hidden);
    }
    drawBatches(OverlayPass::Opaque);
    drawLines(OverlayPass::Translucent);
    drawBatches(OverlayPass::Translucent);
}

void SceneRenderer::Impl::beginFresh(const FrameSlot& slot) const {
    const vk::raii::CommandBuffer& commands = slot.commands;
    // Earlier readers of this image are the window's fragment shader and copies.
    transition(commands, *slot.color.image, kColor, Layout::eUndefined, Layout::eColorAttachmentOptimal,
               Stage::eFragmentShader | Stage::eCopy | Stage::eColorAttachmentOutput,
               Access::eColorAttachmentWrite, Stage::eColorAttachmentOutput,
               Access::eColorAttachmentWrite | Access::eColorAttachmentRead);
    transition(commands, *slot.depth.image, kDepth, Layout::eUndefined,
               Layout::eDepthStencilAttachmentOptimal, Stage::eLateFragmentTests,
               Access::eDepthStencilAttachmentWrite, Stage::eEarlyFragmentTests,
               Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite);
}

void SceneRenderer::Impl::record(FrameSlot& slot, const View& view, const Overlay& overlay,
                                 const OverlayDraw& draw, const KeptPicture* kept) {
    const vk::raii::CommandBuffer& commands = slot.commands;
    beginCommands(slot);
    if (scene_)
        deformed_.record(gpu, commands, slot.deformed, scene_->vertices());
    if (kept != nullptr)
        kept->copyTo(commands, slot);
    else
        beginFresh(slot);
    // The background covers every pixel of a fresh frame, so nothing is loaded or cleared but depth.
    using Load = vk::AttachmentLoadOp;
    const vk::RenderingAttachmentInfo color{.imageView = *slot.color.view,
                                            .imageLayout = Layout::eColorAttachmentOptimal,
                                            .loadOp = kept != nullptr ? Load::eLoad : Load::eDontCare,
                                            .storeOp = vk::AttachmentStoreOp::eStore};
    const vk::RenderingAttachmentInfo depth{.imageView = *slot.depth.view,
                                            .imageLayout = Layout::eDepthStencilAttachmentOptimal,
                                            .loadOp = kept != nullptr ? Load::eLoad : Load::eClear,
                                            .storeOp = vk::AttachmentStoreOp::eDontCare,
                                            .clearValue = vk::ClearDepthStencilValue{.depth = 1.0f}};
    commands.beginRendering(vk::RenderingInfo{.renderArea = {.extent = slot.color.extent},
                                              .layerCount = 1,
                                              .colorAttachmentCount = 1,
                                              .pColorAttachments = &color,
                                              .pDepthAttachment = &depth});
    setViewport(commands, slot.color.extent);
    if (kept != nullptr)
        castShadow(slot, view, *kept);
    drawScene(commands, slot.frameSet, view.mode, kept != nullptr);
    if (view.wireframe)
        drawWireframe(commands, slot.frameSet);
    if (!overlay.empty())
        drawOverlay(commands, slot, draw, overlay.hiddenAlpha > 0.0f);
    commands.endRendering();
    transition(commands, *slot.color.image, kColor, Layout::eColorAttachmentOptimal,
               Layout::eShaderReadOnlyOptimal, Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite,
               Stage::eFragmentShader | Stage::eCopy, Access::eShaderSampledRead | Access::eTransferRead);
    if (slot.timed)
        commands.writeTimestamp2(Stage::eAllCommands, *slot.timestamps, 1);
    commands.end();
}

} // namespace touchstone
