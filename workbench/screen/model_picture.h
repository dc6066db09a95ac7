#pragma once

#include "renderer/window_target.h"
#include "workbench/model/model.h"
#include "workbench/screen/overlays.h"
#include "workbench/screen/picture_controller.h"
#include "workbench/screen/view_legend.h"

namespace touchstone {

/// The picture of the model and all that belongs on it: overlays of the newest tick, legend, magnifier. Main
/// thread.
class ModelPicture {
  public:
    /// Pictures that are saved go into `folder`.
    explicit ModelPicture(std::filesystem::path folder) : controller_(std::move(folder)) {}

    struct Frame {
        const Model& model; ///< its scene may be null
        const TickRecord& tick;
        bool tickBelongs = true; ///< to the model; else nothing of it is drawn
        const HapticSettings& settings;
        const OrbitCamera& camera;
        ViewOptions& options;
        PixelRect place;             ///< of the framebuffer
        glm::ivec2 sceneSize{1};     ///< pixels that are drawn for it
        double allowedError = 0.0;   ///< of these, by which simplified meshes may differ
        float pixelsPerPoint = 1.0f; ///< framebuffer pixels for one window coordinate
        float scale = 1.0f;          ///< window coordinates for one unit of the layout
        bool software = false;       ///< the device computes on the CPU
    };
    /// Draws into the renderer's images, and the legend into the ImGui frame at hand. Returns where the
    /// images belong.
    [[nodiscard]] EyePlaces draw(const Frame& frame, SceneRenderer& renderer);
    /// Another renderer draws from now on.
    void takeDevice() { colored_.reset(); }

    /// After endFrame: keeps the picture that `options` asked for. True when there is news in `message`.
    bool save(WindowTarget& target, const Frame& frame);
    [[nodiscard]] const std::string& message() const { return controller_.message(); }

  private:
    void colorMaterials(const Frame& frame, SceneRenderer& renderer);
    void drawMagnifier(const Frame& frame, const View& main, SceneRenderer& renderer, EyePlaces& places);

    PictureController controller_;
    Overlay overlay_;
    ViewLegend legend_;
    std::shared_ptr<const HapticScene> colored_; ///< the scene whose plan the colours show
    EffectColors colors_;
    int magnifierAge_ = 0; ///< frames since it was drawn
};

} // namespace touchstone
