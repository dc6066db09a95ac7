#pragma once
// Two renderings of models under one stroke of a simulated hand: what differs in the force.

#include "experiment/plan/study_plan.h"
#include "experiment/stimulus/planar_stimulus.h"
#include "haptics/scene/haptic_scene.h"

#include <map>
#include <memory>

namespace touchstone::experiment {

/// Models of a study, each opened once, fitted into the workspace. One thread.
class ModelStore {
  public:
    struct Opened {
        ScenePtr scene;
        Similarity workspaceFromScene;
        std::shared_ptr<const HapticScene> haptic;
    };
    /// Throws Error.
    [[nodiscard]] const Opened& open(const std::filesystem::path& model);

  private:
    std::map<std::filesystem::path, Opened> opened_;
};

/// Compares a condition's models at a level. The hand goes to and fro over the middle of the reference, from
/// left to right as seen from above, `stroke.force` / 600 N/m below what is highest there, on one path for
/// both. Constant differences do not count, as for curves; there is no contact location. Throws Error where
/// the stroke meets nothing.
[[nodiscard]] StrokeDifference compareModels(const Condition& condition, double level, ModelStore& models,
                                             const Stroke& stroke = {});

} // namespace touchstone::experiment
