#include "renderer/scene_renderer.h"

#include "engine/core/error.h"
#include "renderer/scene_renderer_impl.h"

#include <glm/gtc/matrix_inverse.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>

namespace touchstone {

namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;
constexpr vk::ImageAspectFlags kColor = vk::ImageAspectFlagBits::eColor;
constexpr vk::ImageAspectFlags kDepth = vk::ImageAspectFlagBits::eDepth;

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

glm::vec4 unitOrZero(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0.0 ? glm::vec4(glm::vec3(v / length), 0.0f) : glm::vec4(0.0f);
}

void setSurroundings(const Surroundings& from, float exposure, shared::FrameUniforms& to) {
    const auto exposed = [exposure](const glm::vec3& radiance) {
        return glm::vec4(exposure * radiance, 0.0f);
    };
    const std::array<glm::dvec3, 9> irradiance = irradiancePolynomial(from);
    for (size_t i = 0; i < 4; ++i)
        to.irradiance[i] = exposed(glm::vec3(irradiance[i]));
    const auto grey = [&](size_t i) {
        return exposure * static_cast<float>((irradiance[i].x + irradiance[i].y + irradiance[i].z) / 3.0);
    };
    to.irradianceSquares = {grey(4), grey(5), grey(6), grey(7)};
    to.irradiance[0].w = grey(8);
    to.horizon = exposed(from.horizon);
    to.skyRise = exposed(from.zenith - from.horizon);
    to.rim = exposed(from.rim);
    to.floorFall = exposed(from.below - from.rim);
    for (size_t i = 0; i < from.lamps.size(); ++i) {
        const Lamp& lamp = from.lamps[i];
        to.lampAxis[i] = unitOrZero(lamp.towards);
        to.lampAxis[i].w = static_cast<float>(lamp.sharpness);
        to.lampRadiance[i] = exposed(lamp.radiance);
    }
}

/// Rows of the affine map and of its cofactor matrix, which takes normals also where the map is singular.
bool setConstants(const glm::dmat3& linear, const glm::dvec3& t, DrawItem& item) {
    // Columns of the cofactor matrix; det = dot of a column with its cofactor.
    glm::dmat3 cofactor(glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
                        glm::cross(linear[0], linear[1]));
    const double determinant = glm::dot(linear[0], cofactor[0]);
    double largest = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(cofactor[column][row]));
    if (!std::isfinite(largest) || !std::isfinite(glm::dot(t, t)))
        return false;
    item.mirrored = determinant < 0.0;
    const double scale = largest > 0.0 ? (item.mirrored ? -1.0 : 1.0) / largest : 0.0;
    for (int row = 0; row < 3; ++row) {
        const auto at = static_cast<size_t>(row);
        item.constants.eyeFromMesh[at] =
            glm::vec4(glm::dvec4(linear[0][row], linear[1][row], linear[2][row], t[row]));
        item.constants.normalFromMesh[at] = glm::vec4(
            glm::dvec4(cofactor[0][row] * scale, cofactor[1][row] * scale, cofactor[2][row] * scale, 0.0));
    }
    item.constants.normalFromMesh[0].w = item.mirrored ? -1.0f : 1.0f;
    return true;
}

void setViewport(const vk::raii::CommandBuffer& commands, vk::Extent2D extent) {
    // Negative height: clip space has y up, as the camera does. Core since Vulkan 1.1.
    const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
    commands.setViewport(
        0, vk::Viewport{.x = 0.0f, .y = height, .width = width, .height = -height, .maxDepth = 1.0f});
    commands.setScissor(0, vk::Rect2D{.extent = extent});
}

} // namespace

SceneRenderer::Impl::Impl(Gpu& owner) : gpu(owner.impl()), pipelines_(gpu), shapes_(makeShapeMeshes()) {
    const auto vertexBytes = std::as_bytes(std::span(shapes_.vertices));
    const auto indexBytes = std::as_bytes(std::span(shapes_.indices));
    using Usage = vk::BufferUsageFlagBits;
    shapeVertices_ =
        createBuffer(gpu, vertexBytes.size(), Usage::eVertexBuffer | Usage::eTransferDst, MemoryUse::Device);
    shapeIndices_ =
        createBuffer(gpu, indexBytes.size(), Usage::eIndexBuffer | Usage::eTransferDst, MemoryUse::Device);
    Uploader uploader(gpu);
    uploader.buffer(shapeVertices_, 0, vertexBytes);
    uploader.buffer(shapeIndices_, 0, indexBytes);
    for (FrameSlot& slot : slots_)
        createSlot(slot);
}

SceneRenderer::Impl::~Impl() {
    // A lost device cannot be waited for.
    try {
        gpu.device.waitIdle();
    } catch (const vk::SystemError&) {
    }
}

void SceneRenderer::Impl::createSlot(FrameSlot& slot) {
    vk::raii::CommandBuffers buffers(
        gpu.device, vk::CommandBufferAllocateInfo{.commandPool = *gpu.commandPool, .commandBufferCount = 1});
    slot.commands = std::move(buffers.front());
    slot.done = vk::raii::Fence(gpu.device, vk::FenceCreateInfo{.flags = vk::FenceCreateFlagBits::eSignaled});
    if (gpu.timestampBits > 0)
        slot.timestamps = vk::raii::QueryPool(
            gpu.device, vk::QueryPoolCreateInfo{.queryType = vk::QueryType::eTimestamp, .queryCount = 2});
    slot.uniforms = createBuffer(gpu, sizeof(shared::FrameUniforms), vk::BufferUsageFlagBits::eUniformBuffer,
                                 MemoryUse::Upload);
    const vk::DescriptorPoolSize size{vk::DescriptorType::eUniformBuffer, 1};
    slot.pool = vk::raii::DescriptorPool(
        gpu.device, vk::DescriptorPoolCreateInfo{.maxSets = 1, .poolSizeCount = 1, .pPoolSizes = &size});
    const vk::DescriptorSetLayout layout = pipelines_.frameSet();
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

void SceneRenderer::Impl::resize(FrameSlot& slot, vk::Extent2D extent) {
    if (slot.color.extent == extent)
        return;
    // The window may still be reading the old image in a submission of its own.
    gpu.device.waitIdle();
    if (last_ == &slot)
        last_ = nullptr;
    using Usage = vk::ImageUsageFlagBits;
    slot.colorBytes = nullptr;
    slot.color = GpuImage{};
    slot.depth = GpuImage{};
    slot.color = createImage(gpu, {.format = kSceneFormat,
                                   .extent = extent,
                                   .levels = 1,
                                   .usage = Usage::eColorAttachment | Usage::eSampled | Usage::eTransferSrc,
                                   .otherFormat = kSceneByteFormat});
    slot.colorBytes = createView(gpu, slot.color, kSceneByteFormat);
    slot.depth = createImage(
        gpu,
        {.format = kDepthFormat, .extent = extent, .levels = 1, .usage = Usage::eDepthStencilAttachment});
}

void SceneRenderer::Impl::setScene(ScenePtr scene) {
    gpu.device.waitIdle();
    scene_.reset();
    poses.clear();
    draws_.clear();
    statistics.triangles = 0;
    statistics.deviceBytes = 0;
    if (!scene)
        return;
    scene_ = std::make_unique<GpuScene>(gpu, pipelines_, scene);
    for (const Instance& instance : scene->instances)
        poses.push_back(instance.sceneFromMesh);
    statistics.triangles = scene->triangleCount();
    statistics.deviceBytes = scene_->deviceBytes();
}

void SceneRenderer::Impl::waitFor(FrameSlot& slot) {
    const auto start = std::chrono::steady_clock::now();
    while (gpu.device.waitForFences(*slot.done, true, UINT64_MAX) == vk::Result::eTimeout) {
    }
    statistics.waitSeconds = secondsSince(start);
    if (!slot.timed)
        return;
    const auto [result, ticks] = slot.timestamps.getResults<uint64_t>(
        0, 2, 2 * sizeof(uint64_t), sizeof(uint64_t), vk::QueryResultFlagBits::e64);
    if (result != vk::Result::eSuccess)
        return;
    const uint64_t mask = gpu.timestampBits >= 64 ? UINT64_MAX : (uint64_t{1} << gpu.timestampBits) - 1;
    statistics.gpuSeconds =
        1e-9 * gpu.limits.timestampPeriod * static_cast<double>((ticks[1] - ticks[0]) & mask);
}

void SceneRenderer::Impl::collectDraws(const View& view, const glm::dvec3& eye) {
    draws_.clear();
    if (!scene_)
        return;
    const Scene& scene = scene_->scene();
    const uint32_t light = (view.lights[1].irradiance != glm::vec3(0.0f) ? shared::kHasSecondLight : 0u) |
                           (view.probe.radius > 0.0 ? shared::kHasProbeShadow : 0u);
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const GpuScene::MeshRange& mesh = scene_->mesh(scene.instances[i].mesh);
        if (mesh.indexCount == 0)
            continue;
        const glm::dmat3 linear = view.workspaceFromScene.scale *
                                  (glm::mat3_cast(view.workspaceFromScene.rotation) * glm::dmat3(poses[i]));
        const glm::dvec3 origin =
            view.workspaceFromScene.point(glm::dvec3(poses[i] * glm::dvec4(mesh.centre, 1.0))) - eye;
        DrawItem item;
        item.instance = static_cast<int>(i);
        item.features = mesh.features | light;
        item.distance = glm::length(origin);
        if (setConstants(linear, origin, item))
            draws_.push_back(item);
    }
    // Few state changes for what is opaque; what is blended comes last, from the farthest.
    std::stable_sort(draws_.begin(), draws_.end(), [](const DrawItem& a, const DrawItem& b) {
        const bool blendedA = (a.features & shared::kIsBlended) != 0,
                   blendedB = (b.features & shared::kIsBlended) != 0;
        if (blendedA != blendedB)
            return blendedB;
        if (blendedA)
            return a.distance > b.distance;
        return a.features < b.features;
    });
}

void SceneRenderer::Impl::writeUniforms(FrameSlot& slot, const View& view, const glm::dvec3& eye,
                                        const Overlay& overlay, vk::Extent2D extent) {
    shared::FrameUniforms uniforms{};
    const glm::dmat4 viewFromEye(glm::dmat3(view.viewFromWorkspace));
    uniforms.clipFromEye = glm::mat4(view.clipFromView * viewFromEye);
    uniforms.toLight0 = unitOrZero(view.lights[0].toLight);
    uniforms.toLight1 = unitOrZero(view.lights[1].toLight);
    const float exposure = view.exposure;
    uniforms.irradiance0 = glm::vec4(exposure * view.lights[0].irradiance, 0.0f);
    uniforms.irradiance1 = glm::vec4(exposure * view.lights[1].irradiance, 0.0f);
    setSurroundings(view.surroundings, exposure, uniforms);
    uniforms.probe = glm::vec4(
        glm::dvec4(view.probe.centre - eye, view.probe.radius > 0.0 ? 1.0 / view.probe.radius : 0.0));
    uniforms.backgroundTop = glm::vec4(view.background.top, 1.0f);
    uniforms.backgroundBottom = glm::vec4(view.background.bottom, 1.0f);
    uniforms.image = {static_cast<float>(extent.width), static_cast<float>(extent.height),
                      overlay.hiddenAlpha, 0.0f};
    uniforms.toViewer = unitOrZero(
        glm::dvec3(view.viewFromWorkspace[0].z, view.viewFromWorkspace[1].z, view.viewFromWorkspace[2].z));
    std::memcpy(slot.uniforms.mapped, &uniforms, sizeof uniforms);
}

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

void SceneRenderer::Impl::drawItem(const vk::raii::CommandBuffer& commands, const DrawItem& item,
                                   ViewMode mode) {
    const Scene& scene = scene_->scene();
    const int meshIndex = scene.instances[static_cast<size_t>(item.instance)].mesh;
    const int materialIndex = scene.meshes[static_cast<size_t>(meshIndex)].material;
    const GpuScene::MeshRange& mesh = scene_->mesh(meshIndex);
    const bool shaded = mode == ViewMode::Shaded;
    const vk::PipelineLayout layout = shaded ? pipelines_.sceneLayout() : pipelines_.falseColorLayout();
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, shaded
                                                                ? pipelines_.scene(item.features)
                                                                : pipelines_.falseColor(item.features, mode));
    commands.bindDescriptorSets(
        vk::PipelineBindPoint::eGraphics, layout, 1,
        shaded ? scene_->material(materialIndex) : scene_->falseColorMaterial(materialIndex), {});
    const bool bothSides = scene.materials[static_cast<size_t>(materialIndex)].doubleSided;
    // What shines through shows its far side first, then its near side.
    const bool twice = shaded && bothSides && (item.features & shared::kIsBlended) != 0;
    commands.setFrontFace(item.mirrored ? vk::FrontFace::eClockwise : vk::FrontFace::eCounterClockwise);
    commands.pushConstants<shared::ObjectConstants>(layout, vk::ShaderStageFlagBits::eVertex, 0,
                                                    item.constants);
    using Cull = vk::CullModeFlagBits;
    for (const Cull cull : {Cull::eFront, bothSides && !twice ? Cull::eNone : Cull::eBack}) {
        if (cull == Cull::eFront && !twice)
            continue;
        commands.setCullMode(cull);
        commands.drawIndexed(mesh.indexCount, 1, mesh.firstIndex, mesh.firstVertex, 0);
        ++statistics.drawCalls;
    }
}

void SceneRenderer::Impl::drawScene(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet,
                                    ViewMode mode) {
    bool backgroundDrawn = false;
    if (!draws_.empty()) {
        commands.bindIndexBuffer(scene_->indices(), 0, vk::IndexType::eUint32);
        commands.bindVertexBuffers(0, scene_->vertices(), vk::DeviceSize{0});
        if (mode != ViewMode::Shaded)
            commands.bindVertexBuffers(1, scene_->scalars(), vk::DeviceSize{0});
        const vk::PipelineLayout layout =
            mode == ViewMode::Shaded ? pipelines_.sceneLayout() : pipelines_.falseColorLayout();
        commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 0, frameSet, {});
        for (const DrawItem& item : draws_) {
            // Behind everything opaque, but before what lets it shine through.
            if (mode == ViewMode::Shaded && (item.features & shared::kIsBlended) != 0 && !backgroundDrawn) {
                drawBackground(commands, frameSet);
                commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 0, frameSet, {});
                backgroundDrawn = true;
            }
            drawItem(commands, item, mode);
        }
    }
    if (!backgroundDrawn)
        drawBackground(commands, frameSet);
}

void SceneRenderer::Impl::drawBackground(const vk::raii::CommandBuffer& commands,
                                         vk::DescriptorSet frameSet) {
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.background());
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, pipelines_.overlayLayout(), 0, frameSet,
                                {});
    commands.setCullMode(vk::CullModeFlagBits::eNone);
    commands.setFrontFace(vk::FrontFace::eCounterClockwise);
    commands.draw(3, 1, 0, 0);
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
            commands.setCullMode(batch.shape == Shape::Disc ? vk::CullModeFlagBits::eNone
                                                            : vk::CullModeFlagBits::eBack);
            const ShapeMeshes::Range& range = shapes_.ranges[static_cast<size_t>(batch.shape)];
            commands.drawIndexed(range.indexCount, batch.count, range.firstIndex, 0, batch.first);
            ++statistics.drawCalls;
        }
    };
    const auto drawLines = [&](OverlayPass pass) {
        if (draw.lines.empty())
            return;
        commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.lines(pass));
        commands.bindVertexBuffers(0, *slot.overlay.buffer, linesAt);
        commands.setCullMode(vk::CullModeFlagBits::eNone);
        commands.draw(4, static_cast<uint32_t>(draw.lines.size()), 0, 0);
        ++statistics.drawCalls;
    };
    // First what the scene hides, against the scene's depth alone; then the items among themselves.
    if (showHidden) {
        drawBatches(OverlayPass::Hidden);
        drawLines(OverlayPass::Hidden);
    }
    drawBatches(OverlayPass::Opaque);
    drawLines(OverlayPass::Translucent);
    drawBatches(OverlayPass::Translucent);
}

void SceneRenderer::Impl::record(FrameSlot& slot, const View& view, const Overlay& overlay,
                                 const OverlayDraw& draw) {
    const vk::raii::CommandBuffer& commands = slot.commands;
    commands.reset();
    commands.begin({.flags = vk::CommandBufferUsageFlagBits::eOneTimeSubmit});
    slot.timed = *slot.timestamps != vk::QueryPool{};
    if (slot.timed) {
        commands.resetQueryPool(*slot.timestamps, 0, 2);
        commands.writeTimestamp2(Stage::eTopOfPipe, *slot.timestamps, 0);
    }
    // Earlier readers of this image are the window's fragment shader and copies.
    transition(commands, *slot.color.image, kColor, Layout::eUndefined, Layout::eColorAttachmentOptimal,
               Stage::eFragmentShader | Stage::eCopy | Stage::eColorAttachmentOutput,
               Access::eColorAttachmentWrite, Stage::eColorAttachmentOutput,
               Access::eColorAttachmentWrite | Access::eColorAttachmentRead);
    transition(commands, *slot.depth.image, kDepth, Layout::eUndefined,
               Layout::eDepthStencilAttachmentOptimal, Stage::eLateFragmentTests,
               Access::eDepthStencilAttachmentWrite, Stage::eEarlyFragmentTests,
               Access::eDepthStencilAttachmentRead | Access::eDepthStencilAttachmentWrite);
    // The background covers every pixel, so nothing is loaded or cleared but depth.
    const vk::RenderingAttachmentInfo color{.imageView = *slot.color.view,
                                            .imageLayout = Layout::eColorAttachmentOptimal,
                                            .loadOp = vk::AttachmentLoadOp::eDontCare,
                                            .storeOp = vk::AttachmentStoreOp::eStore};
    const vk::RenderingAttachmentInfo depth{.imageView = *slot.depth.view,
                                            .imageLayout = Layout::eDepthStencilAttachmentOptimal,
                                            .loadOp = vk::AttachmentLoadOp::eClear,
                                            .storeOp = vk::AttachmentStoreOp::eDontCare,
                                            .clearValue = vk::ClearDepthStencilValue{.depth = 1.0f}};
    commands.beginRendering(vk::RenderingInfo{.renderArea = {.extent = slot.color.extent},
                                              .layerCount = 1,
                                              .colorAttachmentCount = 1,
                                              .pColorAttachments = &color,
                                              .pDepthAttachment = &depth});
    setViewport(commands, slot.color.extent);
    drawScene(commands, slot.frameSet, view.mode);
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

void SceneRenderer::Impl::render(const View& view, const Overlay& overlay, int width, int height) {
    const int largest =
        static_cast<int>(std::min({gpu.limits.maxImageDimension2D, gpu.limits.maxFramebufferWidth,
                                   gpu.limits.maxFramebufferHeight, 16384u}));
    const vk::Extent2D extent{static_cast<uint32_t>(std::clamp(width, 1, largest)),
                              static_cast<uint32_t>(std::clamp(height, 1, largest))};
    FrameSlot& slot = slots_[next_];
    waitFor(slot);
    resize(slot, extent);
    if (scene_ && view.mode != ViewMode::Shaded && !scene_->falseColorReady(view.mode)) {
        gpu.device.waitIdle();
        scene_->prepareFalseColor(view.mode);
    }
    const glm::dmat3 viewAxes(view.viewFromWorkspace);
    const glm::dvec3 eye = -(glm::inverse(viewAxes) * glm::dvec3(view.viewFromWorkspace[3]));
    statistics.drawCalls = 0;
    collectDraws(view, eye);
    const OverlayDraw draw = layOut(overlay, eye);
    writeUniforms(slot, view, eye, overlay, extent);
    writeOverlay(slot, draw);
    record(slot, view, overlay, draw);
    gpu.device.resetFences(*slot.done);
    const vk::CommandBufferSubmitInfo submitted{.commandBuffer = *slot.commands};
    gpu.queue.submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted},
                      *slot.done);
    last_ = &slot;
    next_ = (next_ + 1) % slots_.size();
    statistics.pipelines = pipelines_.compiled();
}

PixelData SceneRenderer::Impl::readPixels() {
    PixelData pixels;
    if (last_ == nullptr)
        return pixels;
    const vk::Extent2D extent = last_->color.extent;
    const size_t size = size_t{4} * extent.width * extent.height;
    const GpuBuffer target =
        createBuffer(gpu, size, vk::BufferUsageFlagBits::eTransferDst, MemoryUse::Readback);
    runOnce(gpu, [&](const vk::raii::CommandBuffer& commands) {
        transition(commands, *last_->color.image, kColor, Layout::eShaderReadOnlyOptimal,
                   Layout::eTransferSrcOptimal, Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite,
                   Stage::eCopy, Access::eTransferRead);
        commands.copyImageToBuffer(*last_->color.image, Layout::eTransferSrcOptimal, *target.buffer,
                                   vk::BufferImageCopy{.imageSubresource = {kColor, 0, 0, 1},
                                                       .imageExtent = {extent.width, extent.height, 1}});
        transition(commands, *last_->color.image, kColor, Layout::eTransferSrcOptimal,
                   Layout::eShaderReadOnlyOptimal, Stage::eCopy, Access::eTransferRead,
                   Stage::eFragmentShader, Access::eShaderSampledRead);
        const vk::MemoryBarrier2 toHost{.srcStageMask = Stage::eCopy,
                                        .srcAccessMask = Access::eTransferWrite,
                                        .dstStageMask = Stage::eHost,
                                        .dstAccessMask = Access::eHostRead};
        commands.pipelineBarrier2(vk::DependencyInfo{.memoryBarrierCount = 1, .pMemoryBarriers = &toHost});
    });
    pixels.width = static_cast<int>(extent.width);
    pixels.height = static_cast<int>(extent.height);
    pixels.channels = 4;
    pixels.bytes.assign(target.mapped, target.mapped + size);
    return pixels;
}

SceneRenderer::SceneRenderer(Gpu& gpu)
    : impl_(translatingErrors("making the renderer", [&] { return std::make_unique<Impl>(gpu); })) {}
SceneRenderer::~SceneRenderer() = default;

void SceneRenderer::setScene(ScenePtr scene) {
    try {
        translatingErrors("uploading the scene", [&] { impl_->setScene(std::move(scene)); });
    } catch (const Error&) {
        impl_->setScene(nullptr);
        throw;
    }
}

void SceneRenderer::setInstancePoses(std::span<const glm::dmat4> sceneFromMesh) {
    if (sceneFromMesh.size() != impl_->poses.size())
        throw std::invalid_argument("setInstancePoses wants one pose for each instance of the scene");
    impl_->poses.assign(sceneFromMesh.begin(), sceneFromMesh.end());
}

void SceneRenderer::render(const View& view, const Overlay& overlay, int width, int height) {
    translatingErrors("drawing the scene", [&] { impl_->render(view, overlay, width, height); });
}

PixelData SceneRenderer::readPixels() {
    return translatingErrors("reading the picture", [&] { return impl_->readPixels(); });
}

const SceneRenderer::Statistics& SceneRenderer::statistics() const {
    return impl_->statistics;
}

} // namespace touchstone
