// Frames over a kept picture, and its steps.
//
// What is kept: every opaque object that rests, and the background (all that PictureKey compares).
// What is drawn in each frame over it: the probe's shadow, objects that move, whatever lets see through it
// (the shadow falls on it while it is blended), and the overlay.

#include "renderer/scene_renderer_impl.h"
#include "renderer/shadow_area.h"

#include <algorithm>

namespace touchstone {

namespace {

// In triangles: what else takes about as long on a CPU that draws.
constexpr double kDrawWork = 100.0; ///< of a draw call
constexpr double kPixelWork = 0.1;  ///< of a pixel of the background
/// Of each pixel of a band where a haptic program is drawn: a step begins with one such band, and more follow
/// as their time is known.
constexpr double kProgramPixelWork = 1.0;

} // namespace

void setViewport(const vk::raii::CommandBuffer& commands, vk::Extent2D extent) {
    const auto width = static_cast<float>(extent.width), height = static_cast<float>(extent.height);
    commands.setViewport(
        0, vk::Viewport{.x = 0.0f, .y = height, .width = width, .height = -height, .maxDepth = 1.0f});
    commands.setScissor(0, vk::Rect2D{.extent = extent});
}

PictureState SceneRenderer::Impl::renderKept(const View& view, const Overlay& overlay,
                                             const glm::ivec2& coarse, const glm::ivec2& full) {
    if (view.wireframe) { // edges are drawn over all of a frame
        render(view, overlay, full.x, full.y, Eye::Main);
        return PictureState::Coarse;
    }
    const vk::Extent2D extent = allowedExtent(full.x, full.y);
    PictureKey key =
        pictureKey(view, {static_cast<int>(extent.width), static_cast<int>(extent.height)}, content_);
    if (key.content != kept_.key().content)
        moving_.forget();
    const bool begins = moving_.update(poses, revisions_);
    if (begins || key != kept_.key()) {
        moving_.begin();
        kept_.restart(key);
        render(view, overlay, coarse.x, coarse.y, Eye::Main);
        return PictureState::Coarse;
    }
    if (kept_.complete()) {
        drawFrame(rest_, view, overlay, extent, Eye::Main, &kept_);
        return PictureState::Kept;
    }
    render(view, overlay, coarse.x, coarse.y, Eye::Main);
    advanceKept();
    return PictureState::Refining;
}

void SceneRenderer::Impl::advanceKept() {
    if (!kept_.idle())
        return;
    const View& view = kept_.key().view;
    if (!kept_.begun()) {
        collectDraws(view, eyeOf(view), kept_.extent(), Part::Resting, keptDraws_);
        if (std::ranges::any_of(keptDraws_,
                                [&](const DrawItem& item) { return showsProgram(item, view.mode); }))
            kept_.expectPrograms();
    }
    drawStep(kept_, keptDraws_);
}

void SceneRenderer::Impl::drawStep(KeptPicture& kept, const std::vector<DrawItem>& draws) {
    const View& view = kept.key().view;
    kept.beginStep();
    writeUniforms(kept.slot, view, eyeOf(view), Overlay{}, kept.extent());
    const double work = drawOn(kept, draws);
    kept.endStep(work, kept.place.band >= kept.bands());
    submit(kept.slot);
}

bool SceneRenderer::Impl::showsProgram(const DrawItem& item, ViewMode mode) const {
    const int mesh = scene_->scene().instances[static_cast<size_t>(item.instance)].mesh;
    const int material = scene_->scene().meshes[static_cast<size_t>(mesh)].material;
    return mode == ViewMode::Shaded && scene_->programs().of(material) != nullptr;
}

double SceneRenderer::Impl::drawOn(KeptPicture& kept, const std::vector<DrawItem>& draws) {
    const View& view = kept.key().view;
    const vk::raii::CommandBuffer& commands = kept.slot.commands;
    KeptPicture::Place& place = kept.place;
    double work = 0.0;
    for (; place.band < kept.bands(); ++place.band, place.item = 0) {
        const int top = place.band * kept.bandRows(),
                  bottom = std::min(top + kept.bandRows(), kept.key().size.y);
        commands.setScissor(0,
                            vk::Rect2D{.offset = {0, top},
                                       .extent = {kept.extent().width, static_cast<uint32_t>(bottom - top)}});
        if (work >= kept.stepWork())
            return work;
        // Rows from the top, clip space from below.
        const double rows = kept.key().size.y;
        const Frustum band(clipFromEye(view), {-1.0, 1.0 - 2.0 * bottom / rows},
                           {1.0, 1.0 - 2.0 * top / rows});
        bindScene(commands, kept.slot.frameSet, view.mode);
        for (; place.item < draws.size(); ++place.item, place.index = 0) {
            DrawItem item = draws[place.item];
            if (item.radius >= 0.0 && band.misses(item.centre, item.radius))
                continue;
            if (work >= kept.stepWork())
                return work;
            const uint32_t most = 3 * static_cast<uint32_t>(std::max(1.0, kept.stepWork() - work));
            const uint32_t left = item.indexCount - place.index;
            item.firstIndex += place.index;
            item.indexCount = std::min(left, most);
            drawItem(commands, item, view.mode, kept.keepsLight());
            work += kDrawWork + item.indexCount / 3.0;
            if (showsProgram(item, view.mode))
                work += kProgramPixelWork * static_cast<double>(kept.extent().width) * (bottom - top);
            if (item.indexCount < left) {
                place.index += item.indexCount;
                return work;
            }
        }
        drawBackground(commands, kept.slot.frameSet, kept.keepsLight());
        work += kPixelWork * static_cast<double>(kept.extent().width) * (bottom - top);
    }
    return work;
}

void SceneRenderer::Impl::castShadow(const FrameSlot& slot, const View& view, const KeptPicture& kept) {
    const PixelArea area = shadowArea(view, kept.key().size);
    if (!kept.keepsLight() || area.empty())
        return;
    const vk::raii::CommandBuffer& commands = slot.commands;
    const glm::ivec2 size = area.high - area.low;
    commands.setScissor(0,
                        vk::Rect2D{.offset = {area.low.x, area.low.y},
                                   .extent = {static_cast<uint32_t>(size.x), static_cast<uint32_t>(size.y)}});
    commands.bindPipeline(vk::PipelineBindPoint::eGraphics, pipelines_.keptShadow());
    commands.bindDescriptorSets(vk::PipelineBindPoint::eGraphics, pipelines_.keptLayout(), 0,
                                {slot.frameSet, kept.lightSet()}, {});
    commands.setCullMode(vk::CullModeFlagBits::eNone);
    commands.setFrontFace(vk::FrontFace::eCounterClockwise);
    commands.draw(3, 1, 0, 0);
    commands.setScissor(0, vk::Rect2D{.extent = kept.extent()});
    ++statistics.drawCalls;
}

} // namespace touchstone
