#include "workbench/screen/model_picture.h"

#include "workbench/screen/magnifier.h"

#include <utility>

namespace touchstone {

namespace {

constexpr double kMagnifierOverlayScale = 0.22; ///< scale of the overlays in it
constexpr int kSoftwareMagnifierPeriod = 3;     ///< frames between updates: the CPU transforms every vertex
                                                ///< for it again

} // namespace

EyePlaces ModelPicture::draw(const Frame& frame, SceneRenderer& renderer) {
    const ViewOptions& options = frame.options;
    const double aspect = static_cast<double>(frame.place.width) / std::max(frame.place.height, 1);
    View view = viewOf(frame.camera, frame.model.workspaceFromScene, aspect);
    view.mode = options.mode;
    view.allowedError = frame.allowedError;
    overlay_.clear();
    EyePlaces places{.main = frame.place, .magnifier = {}};
    TickLook look{.shown = frame.tickBelongs ? options.overlays
                                             : ShownOverlays{false, false, false, false, false, false}};
    const bool hasModel = frame.model.scene != nullptr && frame.model.haptic != nullptr;
    if (hasModel) {
        look.frictionCoefficient =
            frictionCoefficientAt(frame.tick, frame.settings, *frame.model.scene, *frame.model.haptic);
        drawTick(frame.tick, frame.settings, look, overlay_);
        if (look.shown.shadow)
            view.probe = probeShadow(frame.tick, frame.settings);
        colorMaterials(frame, renderer);
    }
    renderer.render(view, overlay_, frame.sceneSize.x, frame.sceneSize.y);
    if (hasModel && options.magnifier) {
        overlay_.clear();
        look.scale = kMagnifierOverlayScale;
        drawTick(frame.tick, frame.settings, look, overlay_);
        view.probe.radius *= kMagnifierOverlayScale;
        drawMagnifier(frame, view, renderer, places);
    }
    legend_.mode = options.mode;
    legend_.scale = renderer.falseColorScale();
    legend_.kinds = options.mode == ViewMode::Effects ? colors_.kinds : std::vector<EffectColors::Kind>{};
    const float margin = 14.0f * frame.scale;
    const glm::vec2 low(static_cast<float>(frame.place.x),
                        static_cast<float>(frame.place.y + frame.place.height));
    if (hasModel)
        drawViewLegend(legend_, low / frame.pixelsPerPoint + glm::vec2(margin, -margin), frame.scale);
    return places;
}

void ModelPicture::colorMaterials(const Frame& frame, SceneRenderer& renderer) {
    if (frame.options.mode != ViewMode::Effects || colored_ == frame.model.haptic)
        return;
    colored_ = frame.model.haptic;
    colors_ = effectColors(colored_->plan, frame.model.scene->materials.size());
    renderer.setMaterialColors(colors_.materials);
}

void ModelPicture::drawMagnifier(const Frame& frame, const View& main, SceneRenderer& renderer,
                                 EyePlaces& places) {
    places.magnifier = Magnifier::place(frame.place);
    const float size = static_cast<float>(places.magnifier.width) / frame.pixelsPerPoint;
    Magnifier::drawFrame(glm::vec2(places.magnifier.x, places.magnifier.y) / frame.pixelsPerPoint, size,
                         frame.scale);
    if (++magnifierAge_ < (frame.software ? kSoftwareMagnifierPeriod : 1))
        return;
    magnifierAge_ = 0;
    View near =
        viewOf(Magnifier::camera(frame.camera, frame.tick.output.proxy), frame.model.workspaceFromScene, 1.0);
    near.mode = main.mode;
    near.allowedError = main.allowedError;
    near.probe = main.probe;
    renderer.render(near, overlay_, places.magnifier.width, places.magnifier.height, Eye::Magnifier);
}

bool ModelPicture::save(WindowTarget& target, const Frame& frame) {
    if (std::exchange(frame.options.savePicture, false)) {
        const std::string name = frame.model.scene != nullptr
                                     ? std::filesystem::path(frame.model.scene->path).stem().string()
                                     : "";
        const std::string view(frame.options.mode == ViewMode::Shaded ? ""
                                                                      : viewModeName(frame.options.mode));
        controller_.request(target, frame.place, view.empty() ? name : name + "-" + view);
    }
    return controller_.update(target);
}

} // namespace touchstone
