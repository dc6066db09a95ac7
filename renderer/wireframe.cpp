// The edges of the drawn triangles, as a pass over the scene.

#include "renderer/scene_renderer_impl.h"

#include <algorithm>

namespace touchstone {

namespace {

/// Of lines of one pixel. In equilateral triangles with edges of e pixels 3.46 / e of the surface is line:
/// this leaves it a quarter darker at most, where 0.75 would paint triangles of few pixels black.
float opacityOf(double edge) {
    constexpr double kMax = 0.75, kMin = 0.05, kDarkening = 0.25;
    return static_cast<float>(std::clamp(kDarkening * edge / 3.46, kMin, kMax));
}

} // namespace

void SceneRenderer::Impl::drawWireframe(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet) {
    if (draws_.empty() || !gpu.lineTriangles)
        return;
    const vk::PipelineLayout layout = pipelines_.sceneLayout();
    bindMeshes(commands, ViewMode::Shaded);
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, layout, 0, frameSet, {});
    commands.setCullMode(vk::CullModeFlagBits::eNone); // what is seen of a back is drawn, too
    for (const DrawItem& item : draws_) {
        const int mesh = scene_->scene().instances[static_cast<size_t>(item.instance)].mesh;
        const PreparedMesh& prepared = scene_->mesh(mesh).mesh;
        if (prepared.strokes > 0 || item.sides == DrawItem::Sides::Far) // glass is there twice
            continue;
        commands.bindPipeline(vk::PipelineBindPoint::eGraphics,
                              pipelines_.wireframe((item.features & shared::kIsClipped) != 0));
        commands.setFrontFace(item.mirrored ? vk::FrontFace::eClockwise : vk::FrontFace::eCounterClockwise);
        shared::ObjectConstants constants = item.constants;
        constants.normalFromMesh[2].w = opacityOf(item.edge);
        commands.pushConstants<shared::ObjectConstants>(layout, kObjectStages, 0, constants);
        const bool reshaped = scene_->bindReshaped(commands, mesh, ViewMode::Shaded);
        commands.drawIndexed(item.indexCount, 1, item.firstIndex, prepared.firstVertex, 0);
        if (reshaped)
            bindMeshes(commands, ViewMode::Shaded);
        ++statistics.drawCalls;
    }
}

} // namespace touchstone
