#pragma once

#include "renderer/window_target.h"
#include "workbench/hand/other_hands.h"
#include "workbench/model/model.h"
#include "workbench/screen/field_slice.h"
#include "workbench/screen/overlays.h"
#include "workbench/screen/picture_controller.h"
#include "workbench/screen/view_legend.h"

#include <span>
#include <string>

namespace touchstone {

/// The picture of the model with the overlays of the latest tick, legend and magnifier. Main thread.
class ModelPicture {
  public:
    /// Saved pictures go into `folder`.
    explicit ModelPicture(std::filesystem::path folder) : controller_(std::move(folder)) {}

    struct Frame {
        const Model& model; ///< its scene may be null
        std::string name;   ///< of a saved picture, without its ending
        const TickRecord& tick;
        std::span<const OtherHands::State> others; ///< the hands beside that of `tick`
        std::shared_ptr<const HapticScene> felt;   ///< with the sculpted fields; null as the model's
        bool tickBelongs = true;                   ///< to the model; otherwise nothing of it is drawn
        const HapticSettings& settings;
        const OrbitCamera& camera;
        ViewOptions& options;
        PixelRect place;             ///< of the framebuffer
        glm::ivec2 sceneSize{1};     ///< resolution of the scene image while something changes
        glm::ivec2 keptSize{0};      ///< and once it rests, of the kept one; 0: none is kept
        double allowedError = 0.0;   ///< of these, tolerance of simplified meshes
        float pixelsPerPoint = 1.0f; ///< framebuffer pixels per window coordinate
        float scale = 1.0f;          ///< window coordinates per layout unit
        bool software = false;       ///< software device
    };
    /// Draws into the renderer's images, and the legend into the current ImGui frame. Returns where the
    /// images belong.
    [[nodiscard]] EyePlaces draw(const Frame& frame, SceneRenderer& renderer);
    /// What `draw` drew last: its resolution, and whether over a kept picture.
    struct Drawn {
        PictureState state = PictureState::Coarse;
        int frames = 0; ///< in this state, with that one
        glm::ivec2 size{0};
        double refinedIn = 0.0; ///< s from the last change to the kept picture, when there was one last
    };
    [[nodiscard]] const Drawn& drawn() const { return drawn_; }
    /// A new renderer.
    void takeDevice() { colored_.reset(); }

    /// After endFrame: draws the picture requested in `options` anew, in its own size, with overlays,
    /// magnifier and legend in proportion, and saves it. The caller waits for the drawing: 0.1 s for a small
    /// picture, seconds for a large one where the CPU draws. True when `note` has changed.
    bool save(const Frame& frame, SceneRenderer& renderer);
    [[nodiscard]] const SavedNote& note() const { return controller_.note(); }

  private:
    /// What is drawn of a frame besides its size.
    struct Setup {
        View view;
        TickLook look;
        bool hasModel = false;
    };
    /// Fills overlay_, too.
    [[nodiscard]] Setup setUp(const Frame& frame, double aspect, SceneRenderer& renderer);
    void drawHands(const Frame& frame, const TickLook& look);
    /// The magnifier's, of the main one's; fills overlay_, too.
    [[nodiscard]] View magnified(const Frame& frame, Setup setup);
    /// Grid's label and legend; in a saved picture the axes, too. `low`: lower left corner, `high`: upper
    /// right.
    void drawLabels(const Frame& frame, const glm::vec2& low, float scale,
                    const SceneRenderer& renderer) const;
    void colorMaterials(const Frame& frame, SceneRenderer& renderer);
    void drawMagnifier(const Frame& frame, const Setup& setup, SceneRenderer& renderer, EyePlaces& places);
    /// The legend of what `renderer` drew last.
    [[nodiscard]] ViewLegend legendOf(const Frame& frame, const SceneRenderer& renderer) const;
    [[nodiscard]] PixelData drawAnew(const Frame& frame, const glm::ivec2& size, SceneRenderer& renderer);

    void drawMain(const Frame& frame, const View& view, SceneRenderer& renderer);

    PictureController controller_;
    Drawn drawn_;
    double changed_ = 0.0; ///< time of the last change of what is kept, s
    Overlay overlay_;
    std::shared_ptr<const HapticScene> colored_; ///< the scene whose plan gave the colours
    EffectColors colors_;
    std::shared_ptr<const HapticScene> counted_; ///< the scene whose edges are in the legend
    std::vector<EffectColors::Kind> felt_;
    FieldSliceView slice_;
    int magnifierAge_ = 0; ///< frames since it was drawn
};

} // namespace touchstone
