#pragma once

#include "renderer/scene_renderer.h"
#include "session/session.h"
#include "workbench/hand/picker.h"
#include "workbench/model/model.h"
#include "workbench/sculpt/sculpt_choice.h"
#include "workbench/sculpt/sculpted_surface.h"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace touchstone {

/// What the tool shelf shows.
struct SculptStatus {
    bool possible = false; ///< something of the model is felt as a field
    std::vector<std::string> stamps;
    SculptFigures figures;
    std::string notice; ///< what was saved, or why it was not
};

/// Sculpts in the window: the tool for the servo, the sculpted fields for the pointer and the eye. Main
/// thread.
class SculptController final : public TickSubscriber {
  public:
    SculptController(Session& session, Picker& picker) : session_(session), picker_(picker) {}

    /// The model that is touched; `another`: nothing of it is sculpted.
    void show(const Model& model, bool another);
    void sceneSculpted(const SculptedScene& scene) override;
    void take(const TickRecord& record, const HapticSettings&) override;
    /// Every frame; handles what was asked for. `live`: the hand's own ticks are felt, not a recording.
    void update(SculptChoice& choice, bool live);
    /// Every frame: what was sculpted since into the picture.
    void draw(SceneRenderer& renderer);
    /// Writes the field that was sculpted last, or the first one: .glb or .vdb.
    void saveAs(const std::filesystem::path& file);
    [[nodiscard]] SculptStatus status() const;
    /// What is felt, with the sculpted fields; null without a model.
    [[nodiscard]] const std::shared_ptr<const HapticScene>& felt() const { return felt_; }
    [[nodiscard]] bool possible() const { return object_ >= 0; }

  private:
    [[nodiscard]] int stampNamed(const std::string& name) const;

    Session& session_;
    Picker& picker_;
    std::shared_ptr<const HapticScene> felt_; // with the sculpted fields
    ScenePtr drawn_;
    int object_ = -1; // the field that is sculpted where the hand touches none: that touched last
    bool sculpted_ = false;
    SculptedSurface surface_;
    std::string notice_;
};

} // namespace touchstone
