// Frames that are not shown, so that a driver compiles what later ones need.

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
            drawWarm(nullptr);
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
    draws_.clear(); // a frame over it, with the shadow
    drawWarm(&warmKept_);
    SceneRenderer::Statistics ignored;
    waitFor(gpu, warmKept_.slot, ignored);
}

void SceneRenderer::Impl::drawWarm(const KeptPicture* kept) {
    View view;
    view.probe.radius = 1.0;
    writeUniforms(warm_, view, glm::dvec3(0.0), Overlay{}, kWarmSize);
    record(warm_, view, Overlay{}, OverlayDraw{}, kept);
    submit(warm_);
    SceneRenderer::Statistics ignored;
    waitFor(gpu, warm_, ignored);
}

} // namespace touchstone
