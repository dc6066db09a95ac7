// Frames that are not shown, so that a driver compiles what later ones need.

#include "renderer/programmed_part.h"
#include "renderer/scene_renderer_impl.h"

#include <utility>

namespace touchstone {

namespace {

constexpr vk::Extent2D kWarmSize{16, 16};

} // namespace

void SceneRenderer::Impl::warmUp(const Cold& cold) {
    const GpuScene::DrawnMesh& drawn =
        coming_->mesh(coming_->scene().instances[static_cast<size_t>(cold.instance)].mesh);
    const bool kept = cold.kind == Cold::Kind::Kept;
    if (drawn.mesh.empty() || (kept && (!gpu.software || (drawn.features & shared::kIsBlended) != 0)))
        return;
    DrawItem item; // its constants are zero: all vertices map to the eye and no pixel is drawn
    item.instance = cold.instance;
    item.features = drawn.features | (kept ? 0u : shared::kHasProbeShadow) |
                    (environment_.source ? shared::kHasEnvironment : 0u);
    item.firstIndex = drawn.mesh.strokes > 0 ? 0 : drawn.mesh.levels.front().firstIndex;
    item.indexCount = drawn.mesh.strokes > 0 ? 1 : 3;
    draws_.assign(1, item);
    if (warm_.color.extent != kWarmSize)
        resizeSlot(gpu, kWarmSize, warm_);
    // An ordinary frame of the new scene.
    std::swap(scene_, coming_);
    try {
        if (kept)
            warmUpKept();
        else
            drawWarm({}, nullptr);
    } catch (...) { // the current scene stays
        std::swap(scene_, coming_);
        throw;
    }
    std::swap(scene_, coming_);
    draws_.clear();
}

void SceneRenderer::Impl::warmUpKept() {
    warmKept_.restart({.view = {}, .size = {kWarmSize.width, kWarmSize.height}});
    drawStep(warmKept_, draws_);
    SceneRenderer::Statistics ignored;
    waitFor(gpu, warmKept_.slot, ignored);
    statistics.pipelines = pipelines_.compiled();
}

void SceneRenderer::Impl::drawWarm(const Overlay& overlay, const KeptPicture* kept) {
    View view;
    view.probe.radius = 1.0;
    const OverlayDraw draw = layOut(overlay, glm::dvec3(0.0));
    writeUniforms(warm_, view, glm::dvec3(0.0), overlay, kWarmSize);
    writeOverlay(warm_, draw);
    record(warm_, view, overlay, draw, kept);
    submit(warm_);
    SceneRenderer::Statistics ignored;
    waitFor(gpu, warm_, ignored);
    statistics.pipelines = pipelines_.compiled();
}

void SceneRenderer::Impl::warmUpOverlays() {
    if (warm_.color.extent != kWarmSize)
        resizeSlot(gpu, kWarmSize, warm_);
    constexpr glm::dvec3 kFrom{0.0, 0.0, 0.5}, kTo{0.5, 0.5, 0.5};
    Overlay overlay;
    overlay.spheres.push_back({.centre = kFrom, .radius = 0.1});
    overlay.arrows.push_back({.from = kFrom, .to = kTo, .radius = 0.1});
    overlay.lines.push_back({.from = kFrom, .to = kTo});
    overlay.discs.push_back({.centre = kFrom, .radius = 0.1, .color = {1.0f, 1.0f, 1.0f, 0.5f}});
    draws_.clear();
    drawWarm(overlay, nullptr);
    warmUpKept();
    drawWarm({}, &warmKept_);
}

void compileAhead(const std::string& device, const Scene& scene,
                  const std::vector<MaterialProgram>& programs) noexcept {
    try {
        if (ScenePtr part = programmedPart(scene, programs))
            compileAhead(device, prepareScene(std::move(part), {.coarsest = 0}));
    } catch (...) { // then the window compiles
    }
}

void compileAhead(const std::string& device, const std::shared_ptr<const PreparedScene>& prepared) noexcept {
    try {
        const std::unique_ptr<Gpu> gpu =
            Gpu::headless({.device = device, .validation = false, .log = nullptr});
        SceneRenderer renderer(*gpu);
        renderer.beginScene(prepared);
        while (!renderer.continueScene(1.0)) {
        }
    } catch (...) { // then the window compiles
    }
}

} // namespace touchstone
