#pragma once

#include "renderer/window_target.h"
#include "workbench/model/model.h"
#include "workbench/screen/overlays.h"
#include "workbench/screen/picture_controller.h"
#include "workbench/screen/view_legend.h"

namespace touchstone {

/// The picture of the model with the overlays of the latest tick, legend and magnifier. Main thread.
class ModelPicture {
  public:
    /// Saved pictures go into `folder`.
    explicit ModelPicture(std::filesystem::path folder) : controller_(std::move(folder)) {}

    struct Frame {
        const Model& model; ///< its scene may be null
        const TickRecord& tick;
        bool tickBelongs = true; ///< to the model; otherwise nothing of it is drawn
        const HapticSettings& settings;
        const OrbitCamera& camera;
        ViewOptions& options;
        PixelRect place;             ///< of the framebuffer
        glm::ivec2 sceneSize{1};     ///< resolution of the scene image
        double allowedError = 0.0;   ///< of these, tolerance of simplified meshes
        float pixelsPerPoint = 1.0f; ///< framebuffer pixels per window coordinate
        float scale = 1.0f;          ///< window coordinates per layout unit
        bool software = false;       ///< software device
    };
    /// Draws into the renderer's images, and the legend into the current ImGui frame. Returns where the
    /// images belong.
    [[nodiscard]] EyePlaces draw(const Frame& frame, SceneRenderer& renderer);
    /// A new renderer.
    void takeDevice() { colored_.reset(); }

    /// After endFrame: saves the picture requested in `options`. True when `note` has changed.
    bool save(WindowTarget& target, const Frame& frame);
    [[nodiscard]] const SavedNote& note() const { return controller_.note(); }

  private:
    void colorMaterials(const Frame& frame, SceneRenderer& renderer);
    void drawMagnifier(const Frame& frame, const View& main, SceneRenderer& renderer, EyePlaces& places);

    PictureController controller_;
    Overlay overlay_;
    ViewLegend legend_;
    std::shared_ptr<const HapticScene> colored_; ///< the scene whose plan gave the colours
    EffectColors colors_;
    int magnifierAge_ = 0; ///< frames since it was drawn
};

} // namespace touchstone
