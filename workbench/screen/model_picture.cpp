#include "workbench/screen/model_picture.h"

#include "engine/time/seconds_now.h"
#include "haptics/scene/shape_object.h"
#include "workbench/screen/axis_gizmo.h"
#include "workbench/screen/felt_edges.h"
#include "workbench/screen/ground_grid.h"
#include "workbench/screen/gui_pixels.h"
#include "workbench/screen/magnifier.h"

#include <imgui.h>

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

constexpr double kMagnifierOverlayScale = 0.22; ///< scale of the overlays in it
constexpr int kSoftwareMagnifierPeriod = 3;     ///< frames between updates: the CPU transforms every vertex
                                                ///< for it again
constexpr float kLegendMargin = 14.0f;          ///< layout units

void scaleLines(Overlay& overlay, double factor) {
    for (std::vector<Overlay::Line>* lines : {&overlay.lines, &overlay.grid})
        for (Overlay::Line& line : *lines)
            line.width *= static_cast<float>(factor);
}

/// Copies `inset` over `picture`.
void paste(const PixelData& inset, const PixelRect& place, PixelData& picture) {
    const auto row = static_cast<size_t>(4 * place.width);
    for (int y = 0; y < place.height; ++y)
        std::copy_n(inset.bytes.begin() + static_cast<ptrdiff_t>(row * static_cast<size_t>(y)), row,
                    picture.bytes.begin() +
                        4 * (static_cast<ptrdiff_t>(place.y + y) * picture.width + place.x));
}

} // namespace

ModelPicture::Setup ModelPicture::setUp(const Frame& frame, double aspect, SceneRenderer& renderer) {
    const ViewOptions& options = frame.options;
    Setup setup{.view = viewOf(frame.camera, frame.model.workspaceFromScene, aspect),
                .look = {.shown = frame.tickBelongs
                                      ? options.overlays
                                      : ShownOverlays{false, false, false, false, false, false}},
                .hasModel = frame.model.scene != nullptr && frame.model.haptic != nullptr};
    setup.view.mode = options.mode;
    setup.view.part = frame.model.part;
    setup.view.wireframe = options.wireframe;
    overlay_.clear();
    if (!setup.hasModel)
        return setup;
    if (setup.view.part.clip)
        setup.view.shells = shellsOf(*frame.model.haptic);
    setup.look.frictionCoefficient =
        frictionCoefficientAt(frame.tick, frame.settings, *frame.model.scene, *frame.model.haptic);
    drawHands(frame, setup.look);
    if (options.grid)
        GroundGrid(frame.model.scene->bounds).draw(frame.model.workspaceFromScene, 1.0f, overlay_);
    slice_.draw(frame.felt != nullptr ? frame.felt : frame.model.haptic, options.slice, 1.0f, overlay_);
    if (setup.look.shown.shadow)
        setup.view.probe = probeShadow(frame.tick, frame.settings);
    colorMaterials(frame, renderer);
    return setup;
}

/// The probe, force and contact of each hand.
void ModelPicture::drawHands(const Frame& frame, const TickLook& look) {
    drawTick(frame.tick, frame.settings, look, overlay_);
    for (const OtherHands::State& other : frame.others) {
        TickLook own = look;
        own.frictionCoefficient =
            frictionCoefficientAt(other.tick, frame.settings, *frame.model.scene, *frame.model.haptic);
        drawTick(other.tick, frame.settings, own, overlay_);
    }
}

View ModelPicture::magnified(const Frame& frame, Setup setup) {
    overlay_.clear();
    setup.look.scale = kMagnifierOverlayScale;
    drawHands(frame, setup.look);
    View near =
        viewOf(Magnifier::camera(frame.camera, frame.tick.output.proxy), frame.model.workspaceFromScene, 1.0);
    near.mode = setup.view.mode;
    near.part = setup.view.part;
    near.shells = setup.view.shells;
    near.wireframe = setup.view.wireframe;
    near.allowedError = setup.view.allowedError;
    near.probe = setup.view.probe;
    near.probe.radius *= kMagnifierOverlayScale;
    return near;
}

EyePlaces ModelPicture::draw(const Frame& frame, SceneRenderer& renderer) {
    Setup setup =
        setUp(frame, static_cast<double>(frame.place.width) / std::max(frame.place.height, 1), renderer);
    setup.view.allowedError =
        frame.options.wireframe ? 0.0 : frame.allowedError; // the edges of the model itself
    EyePlaces places{.main = frame.place, .magnifier = {}};
    drawMain(frame, setup.view, renderer);
    if (setup.hasModel && frame.options.magnifier)
        drawMagnifier(frame, setup, renderer, places);
    const float margin = kLegendMargin * frame.scale;
    const glm::vec2 low(static_cast<float>(frame.place.x),
                        static_cast<float>(frame.place.y + frame.place.height));
    if (setup.hasModel)
        drawLabels(frame, low / frame.pixelsPerPoint + glm::vec2(margin, -margin), frame.scale, renderer);
    return places;
}

void ModelPicture::drawMain(const Frame& frame, const View& view, SceneRenderer& renderer) {
    const PictureState before = drawn_.state;
    if (frame.keptSize.x > 0) {
        drawn_.state = renderer.renderKept(view, overlay_, frame.sceneSize, frame.keptSize);
    } else {
        drawn_.state = PictureState::Coarse;
        renderer.render(view, overlay_, frame.sceneSize.x, frame.sceneSize.y);
    }
    drawn_.frames = drawn_.state == before ? drawn_.frames + 1 : 1;
    drawn_.size = drawn_.state == PictureState::Kept ? frame.keptSize : frame.sceneSize;
    if (drawn_.state == PictureState::Coarse)
        changed_ = secondsNow();
    else if (drawn_.state == PictureState::Kept && before != PictureState::Kept)
        drawn_.refinedIn = secondsNow() - changed_;
}

void ModelPicture::drawLabels(const Frame& frame, const glm::vec2& low, float scale,
                              const SceneRenderer& renderer) const {
    drawViewLegend(legendOf(frame, renderer), low, scale);
    std::string label = slice_.label();
    if (frame.options.grid)
        label = GroundGrid(frame.model.scene->bounds).label() + (label.empty() ? "" : "; ") + label;
    if (label.empty())
        return;
    constexpr float kBeside = 250.0f; // layout units: right of the legend
    const ImVec2 size = ImGui::CalcTextSize(label.c_str());
    const float pad = 5.0f * scale;
    const ImVec2 at(low.x + (frame.options.mode == ViewMode::Shaded ? 0.0f : kBeside * scale) + pad,
                    low.y - size.y - pad);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled(ImVec2(at.x - pad, at.y - pad), ImVec2(at.x + size.x + pad, at.y + size.y + pad),
                       IM_COL32(18, 20, 23, 200), 5.0f * scale);
    draw.AddText(at, IM_COL32(220, 224, 228, 255), label.c_str());
}

ViewLegend ModelPicture::legendOf(const Frame& frame, const SceneRenderer& renderer) const {
    return {.mode = frame.options.mode,
            .scale = renderer.falseColorScale(),
            .kinds = frame.options.mode == ViewMode::Effects      ? colors_.kinds
                     : frame.options.mode == ViewMode::Perception ? felt_
                                                                  : std::vector<EffectColors::Kind>{}};
}

void ModelPicture::colorMaterials(const Frame& frame, SceneRenderer& renderer) {
    if (frame.options.mode == ViewMode::Perception && counted_ != frame.model.haptic) {
        counted_ = frame.model.haptic;
        felt_ = feltColors(*counted_);
    }
    if (frame.options.mode != ViewMode::Effects || colored_ == frame.model.haptic)
        return;
    colored_ = frame.model.haptic;
    colors_ = effectColors(colored_->plan, frame.model.scene->materials.size());
    renderer.setMaterialColors(colors_.materials);
}

void ModelPicture::drawMagnifier(const Frame& frame, const Setup& setup, SceneRenderer& renderer,
                                 EyePlaces& places) {
    places.magnifier = Magnifier::place(frame.place);
    const float size = static_cast<float>(places.magnifier.width) / frame.pixelsPerPoint;
    Magnifier::drawFrame(glm::vec2(places.magnifier.x, places.magnifier.y) / frame.pixelsPerPoint, size,
                         frame.scale);
    if (++magnifierAge_ < (frame.software ? kSoftwareMagnifierPeriod : 1))
        return;
    magnifierAge_ = 0;
    const View near = magnified(frame, setup);
    renderer.render(near, overlay_, places.magnifier.width, places.magnifier.height, Eye::Magnifier);
}

PixelData ModelPicture::drawAnew(const Frame& frame, const glm::ivec2& size, SceneRenderer& renderer) {
    // Pixels of the picture for one of the window's.
    const double enlarged = std::min(static_cast<double>(size.x) / frame.place.width,
                                     static_cast<double>(size.y) / frame.place.height);
    Setup setup = setUp(frame, static_cast<double>(size.x) / size.y, renderer);
    setup.view.pixelScale = static_cast<float>(enlarged);
    scaleLines(overlay_, enlarged);
    PixelData picture = renderStill(renderer, setup.view, overlay_, size.x, size.y);
    if (!setup.hasModel)
        return picture;
    const PixelRect inset = Magnifier::place({0, 0, size.x, size.y});
    // In a picture of a few pixels there is no room for the smallest magnifier.
    const bool magnifier = frame.options.magnifier && inset.x >= 0 && inset.y + inset.height <= size.y;
    if (magnifier) {
        View near = magnified(frame, setup);
        near.pixelScale = setup.view.pixelScale;
        scaleLines(overlay_, enlarged);
        paste(renderStill(renderer, near, overlay_, inset.width, inset.height), inset, picture);
    }
    const auto scale = static_cast<float>(enlarged) * frame.scale * frame.pixelsPerPoint;
    const float margin = kLegendMargin * scale;
    drawGui(picture, scale, [&] {
        if (magnifier)
            Magnifier::drawFrame(glm::vec2(inset.x, inset.y), static_cast<float>(inset.width), scale);
        drawLabels(frame, {margin, static_cast<float>(size.y) - margin}, scale, renderer);
        if (frame.options.axes)
            paintAxes(frame.camera, {static_cast<float>(size.x), 0.0f}, scale);
    });
    return picture;
}

bool ModelPicture::save(const Frame& frame, SceneRenderer& renderer) {
    if (std::exchange(frame.options.savePicture, false)) {
        const std::string view(frame.options.mode == ViewMode::Shaded ? ""
                                                                      : viewModeName(frame.options.mode));
        const glm::ivec2 chosen = frame.options.pictureSize,
                         size = chosen.x > 0 ? chosen : glm::ivec2(frame.place.width, frame.place.height);
        controller_.save(view.empty() ? frame.name : frame.name + "-" + view,
                         [&] { return drawAnew(frame, size, renderer); });
    }
    return controller_.update();
}

} // namespace touchstone
