#include "renderer/scene_renderer.h"

#include "engine/core/error.h"
#include "renderer/scene_renderer_impl.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <set>
#include <stdexcept>
#include <utility>

namespace touchstone {

namespace {

using Stage = vk::PipelineStageFlagBits2;
using Access = vk::AccessFlagBits2;
using Layout = vk::ImageLayout;
constexpr vk::ImageAspectFlags kColor = vk::ImageAspectFlagBits::eColor;

} // namespace

SceneRenderer::Impl::Impl(Gpu& owner)
    : gpu(owner.impl()), pipelines_(gpu), shapes_(makeShapeMeshes()), kept_(gpu, pipelines_),
      warmKept_(gpu, pipelines_) {
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
    for (FrameRing* ring : {&rings_[0], &rings_[1], &rest_})
        for (FrameSlot& slot : ring->slots)
            createSlot(gpu, pipelines_.frameSet(), slot);
    createSlot(gpu, pipelines_.frameSet(), warm_);
    setEnvironment(nullptr);
}

std::vector<FrameSlot*> SceneRenderer::Impl::allSlots() {
    std::vector<FrameSlot*> slots{&warm_, &kept_.slot, &warmKept_.slot};
    for (FrameRing* ring : {&rings_[0], &rings_[1], &rest_})
        for (FrameSlot& slot : ring->slots)
            slots.push_back(&slot);
    return slots;
}

SceneRenderer::Impl::~Impl() {
    gpu.settle();
}

void SceneRenderer::Impl::clear() {
    gpu.settle();
    scene_.reset();
    coming_.reset();
    poses.clear();
    deformed_.clear();
    revisions_.clear();
    draws_.clear();
    keptDraws_.clear();
    ++content_;
    statistics.triangles = 0;
    statistics.deviceBytes = 0;
}

void SceneRenderer::Impl::beginScene(std::shared_ptr<const PreparedScene> prepared) {
    coming_.reset();
    coming_ = std::make_unique<GpuScene>(gpu, pipelines_, std::move(prepared));
    const Scene& scene = coming_->scene();
    std::set<std::pair<uint32_t, const SurfaceProgram*>> known;
    cold_.clear();
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const int mesh = scene.instances[i].mesh;
        const Material& material =
            scene.materials[static_cast<size_t>(scene.meshes[static_cast<size_t>(mesh)].material)];
        if (known.insert({coming_->mesh(mesh).features, material.haptic.program.compiled.get()}).second)
            for (const Cold::Kind kind : {Cold::Kind::Kept, Cold::Kind::Frame}) // from the back
                cold_.push_back({static_cast<int>(i), kind});
    }
}

bool SceneRenderer::Impl::continueScene(double seconds) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end =
        Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    while (!coming_->uploadNext())
        if (Clock::now() >= end)
            return false;
    // Drivers compile shaders at their first draw; one at a time does not delay a frame for long.
    while (!cold_.empty()) {
        warmUp(cold_.back());
        cold_.pop_back();
        if (Clock::now() >= end)
            return false;
    }
    std::unique_ptr<GpuScene> ready = std::move(coming_);
    clear();
    scene_ = std::move(ready);
    pipelines_.keepPrograms(scene_->programs().all());
    for (const Instance& instance : scene_->scene().instances)
        poses.push_back(instance.sceneFromMesh);
    revisions_.assign(poses.size(), 0);
    statistics.triangles = scene_->scene().triangleCount();
    statistics.deviceBytes = scene_->deviceBytes();
    static std::atomic<uint64_t> scenes{0}; // also of renderers that a lost device has taken away
    sceneNumber = ++scenes;
    return true;
}

void SceneRenderer::Impl::setMeshVertices(int mesh, const DrawnVertices& vertices) {
    if (!scene_)
        return;
    deformed_.set(*scene_, mesh, vertices);
    const std::vector<Instance>& instances = scene_->scene().instances;
    for (size_t i = 0; i < revisions_.size(); ++i)
        if (instances[i].mesh == mesh)
            revisions_[i] = deformed_.revision(mesh);
}

void SceneRenderer::Impl::reshape(int mesh, const ReshapedMesh& reshaped) {
    if (!scene_ || mesh < 0 || static_cast<size_t>(mesh) >= scene_->scene().meshes.size())
        return;
    scene_->reshape(mesh, reshaped);
    ++content_;
}

void SceneRenderer::Impl::setMaterialColors(std::vector<glm::vec3> colors) {
    if (colors == materialColors_)
        return;
    materialColors_ = std::move(colors);
    ++content_;
    if (scene_) {
        gpu.device.waitIdle();
        scene_->forgetFalseColor();
    }
}

void SceneRenderer::Impl::setPrograms(const std::vector<MaterialProgram>& programs) {
    if (programs.size() != (scene_ ? scene_->scene().materials.size() : 0))
        throw std::invalid_argument("setPrograms wants one program for each material of the scene");
    if (!scene_ || programs == scene_->programs().all())
        return;
    gpu.device.waitIdle();
    scene_->setPrograms(programs);
    pipelines_.keepPrograms(programs);
    ++content_;
}

void SceneRenderer::Impl::setEnvironment(std::shared_ptr<const Environment> environment) {
    GpuEnvironment fresh = uploadEnvironment(gpu, std::move(environment));
    gpu.device.waitIdle();
    environment_ = std::move(fresh);
    ++content_;
    for (FrameSlot* slot : allSlots())
        touchstone::setEnvironment(gpu, environment_, *slot);
}

vk::Extent2D SceneRenderer::Impl::allowedExtent(int width, int height) const {
    const int largest =
        static_cast<int>(std::min({gpu.limits.maxImageDimension2D, gpu.limits.maxFramebufferWidth,
                                   gpu.limits.maxFramebufferHeight, 16384u}));
    return {static_cast<uint32_t>(std::clamp(width, 1, largest)),
            static_cast<uint32_t>(std::clamp(height, 1, largest))};
}

void SceneRenderer::Impl::submit(const FrameSlot& slot) const {
    gpu.device.resetFences(*slot.done);
    const vk::CommandBufferSubmitInfo submitted{.commandBuffer = *slot.commands};
    gpu.queue.submit2(vk::SubmitInfo2{.commandBufferInfoCount = 1, .pCommandBufferInfos = &submitted},
                      *slot.done);
}

void SceneRenderer::Impl::render(const View& view, const Overlay& overlay, int width, int height, Eye which) {
    drawFrame(rings_[static_cast<size_t>(which)], view, overlay, allowedExtent(width, height), which,
              nullptr);
}

void SceneRenderer::Impl::drawFrame(FrameRing& ring, const View& view, const Overlay& overlay,
                                    vk::Extent2D extent, Eye which, const KeptPicture* kept) {
    FrameSlot& slot = ring.slots[ring.next];
    const FrameSlot*& last = last_[static_cast<size_t>(which)];
    waitFor(gpu, slot, statistics);
    if (slot.color.extent != extent) {
        if (last == &slot)
            last = nullptr;
        resizeSlot(gpu, extent, slot);
    }
    if (scene_ && view.mode != ViewMode::Shaded && !scene_->falseColorReady(view.mode)) {
        gpu.device.waitIdle();
        scene_->prepareFalseColor(view.mode, materialColors_);
    }
    const glm::dvec3 eye = eyeOf(view);
    statistics.drawCalls = statistics.drawnTriangles = 0;
    collectDraws(view, eye, extent, kept != nullptr ? Part::Live : Part::All, draws_);
    const OverlayDraw draw = layOut(overlay, eye);
    writeUniforms(slot, view, eye, overlay, extent);
    writeOverlay(slot, draw);
    record(slot, view, overlay, draw, kept);
    submit(slot);
    last = &slot;
    ring.next = (ring.next + 1) % ring.slots.size();
    statistics.pipelines = pipelines_.compiled();
}

PixelData SceneRenderer::Impl::readPixels() {
    PixelData pixels;
    const FrameSlot* last = lastFrame(Eye::Main);
    if (last == nullptr)
        return pixels;
    const vk::Extent2D extent = last->color.extent;
    const size_t size = size_t{4} * extent.width * extent.height;
    const GpuBuffer target =
        createBuffer(gpu, size, vk::BufferUsageFlagBits::eTransferDst, MemoryUse::Readback);
    runOnce(gpu, [&](const vk::raii::CommandBuffer& commands) {
        transition(commands, *last->color.image, kColor, Layout::eShaderReadOnlyOptimal,
                   Layout::eTransferSrcOptimal, Stage::eColorAttachmentOutput, Access::eColorAttachmentWrite,
                   Stage::eCopy, Access::eTransferRead);
        commands.copyImageToBuffer(*last->color.image, Layout::eTransferSrcOptimal, *target.buffer,
                                   vk::BufferImageCopy{.imageSubresource = {kColor, 0, 0, 1},
                                                       .imageExtent = {extent.width, extent.height, 1}});
        transition(commands, *last->color.image, kColor, Layout::eTransferSrcOptimal,
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

void SceneRenderer::warmUp() {
    translatingErrors("compiling shaders", [&] { impl_->warmUpOverlays(); });
}

void SceneRenderer::setScene(ScenePtr scene) {
    if (!scene) {
        translatingErrors("emptying the scene", [&] { impl_->clear(); });
        return;
    }
    try {
        beginScene(prepareScene(std::move(scene), {.coarsest = 0}));
        impl_->compileLater();
        while (!continueScene(1.0)) {
        }
    } catch (const Error&) {
        impl_->clear();
        throw;
    }
}

void SceneRenderer::beginScene(std::shared_ptr<const PreparedScene> prepared) {
    try {
        translatingErrors("uploading the scene", [&] { impl_->beginScene(std::move(prepared)); });
    } catch (const Error&) {
        impl_->abandon();
        throw;
    }
}

bool SceneRenderer::continueScene(double seconds) {
    try {
        return translatingErrors("uploading the scene", [&] { return impl_->continueScene(seconds); });
    } catch (const Error&) {
        impl_->abandon();
        throw;
    }
}

void SceneRenderer::abandonScene() {
    impl_->abandon();
}

bool SceneRenderer::hasScene() const {
    return impl_->scene() != nullptr;
}

void SceneRenderer::setInstancePoses(std::span<const glm::dmat4> sceneFromMesh) {
    if (sceneFromMesh.size() != impl_->poses.size())
        throw std::invalid_argument("setInstancePoses wants one pose for each instance of the scene");
    impl_->poses.assign(sceneFromMesh.begin(), sceneFromMesh.end());
}

void SceneRenderer::setMeshVertices(int mesh, const DrawnVertices& vertices) {
    impl_->setMeshVertices(mesh, vertices);
}

void SceneRenderer::reshape(int mesh, const ReshapedMesh& reshaped) {
    impl_->reshape(mesh, reshaped);
}

uint64_t SceneRenderer::sceneNumber() const {
    return impl_->sceneNumber;
}

void SceneRenderer::setMaterialColors(std::vector<glm::vec3> colors) {
    translatingErrors("colouring materials", [&] { impl_->setMaterialColors(std::move(colors)); });
}

void SceneRenderer::setPrograms(const std::vector<MaterialProgram>& programs) {
    translatingErrors("showing programs", [&] { impl_->setPrograms(programs); });
}

void SceneRenderer::setTexels(const PersistentTexels& texels) {
    impl_->setTexels(texels);
}

std::string SceneRenderer::programProblem(const std::shared_ptr<const SurfaceProgram>& program) const {
    return impl_->programProblem(program);
}

void SceneRenderer::setEnvironment(std::shared_ptr<const Environment> environment) {
    translatingErrors("uploading the environment", [&] { impl_->setEnvironment(std::move(environment)); });
}

void SceneRenderer::render(const View& view, const Overlay& overlay, int width, int height, Eye eye) {
    translatingErrors("drawing the scene", [&] { impl_->render(view, overlay, width, height, eye); });
}

PictureState SceneRenderer::renderKept(const View& view, const Overlay& overlay, const glm::ivec2& coarse,
                                       const glm::ivec2& full) {
    return translatingErrors("drawing the scene",
                             [&] { return impl_->renderKept(view, overlay, coarse, full); });
}

PixelData SceneRenderer::readPixels() {
    return translatingErrors("reading the picture", [&] { return impl_->readPixels(); });
}

FalseColorScale SceneRenderer::falseColorScale() const {
    return impl_->falseColorScale();
}

const SceneRenderer::Statistics& SceneRenderer::statistics() const {
    return impl_->statistics;
}

} // namespace touchstone
