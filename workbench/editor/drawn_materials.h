#pragma once

#include "renderer/scene_renderer.h"

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace touchstone {

/// True where a picture depends on Material::haptic: in views of haptic quantities, and where a plane cuts,
/// since what is felt as a field stays whole, and what is felt from outside only shows no inside.
[[nodiscard]] inline bool showsHaptics(ViewMode mode, const ScenePart& part) {
    return mode != ViewMode::Shaded || part.clip.has_value();
}

/// Updates the rendered scene after material edits. Rendering needs them only where it `showsHaptics`;
/// a worker prepares them, and the renderer uploads them in slices as for a new model. Main thread.
class DrawnMaterials {
  public:
    /// The renderer shows this scene.
    void shown(ScenePtr scene);
    /// The images of the shown scene have changed: update them whatever the view.
    void renew() { drawn_.reset(); }
    /// A new renderer without data.
    void takeDevice() {
        drawn_.reset();
        redrawn_.reset();
        programs_.reset();
    }
    /// Another model is being uploaded.
    void interrupt() { redrawn_.reset(); }
    /// Every frame in which no other model is uploaded. `needed`: showsHaptics. Throws a failure once per
    /// change.
    void update(SceneRenderer& renderer, const ScenePtr& scene, bool needed);
    /// Every frame after `update`: the programs of these materials, of one revision of the edits, come into
    /// the picture without another scene. Where the device compiles slowly (compileFor), a worker compiles
    /// new ones first, and those of before are shown until then.
    void showPrograms(SceneRenderer& renderer, std::span<const Material> materials, uint64_t revision);
    /// The name of a device as in GpuOptions; empty: the renderer compiles.
    void compileFor(std::string device) { device_ = std::move(device); }
    /// The revision whose programs the renderer shows.
    [[nodiscard]] uint64_t programs() const { return programs_ ? programs_->second : 0; }
    /// How often a scene of other materials has come into the picture.
    [[nodiscard]] uint64_t redraws() const { return redraws_; }

  private:
    /// Programs, one for each material, as of a revision of the edits of a scene of the renderer.
    struct Programs {
        std::pair<uint64_t, uint64_t> of; // number of the renderer's scene, revision
        std::vector<MaterialProgram> all;
    };
    [[nodiscard]] bool compiled(const std::vector<MaterialProgram>& programs) const;

    uint64_t redraws_ = 0;
    std::string device_;
    std::vector<std::shared_ptr<const SurfaceProgram>> compiled_; // of the scene that is shown
    Programs ahead_;                                              // being compiled
    std::future<void> compiling_;
    std::optional<std::pair<uint64_t, uint64_t>> programs_;       // Programs::of
    ScenePtr drawn_;                                              // the scene in the renderer
    std::future<std::shared_ptr<const PreparedScene>> preparing_; // of the edited materials
    ScenePtr redrawn_;                                            // being uploaded for them
};

} // namespace touchstone
