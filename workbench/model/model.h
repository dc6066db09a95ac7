#pragma once
// A model for both rendering and haptics.

#include "engine/load/scene_loader.h"
#include "engine/scene/scene_part.h"
#include "engine/time/stage_clock.h"
#include "haptics/recording/scene_identity.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace touchstone {

struct Model {
    ScenePtr scene;
    std::shared_ptr<const HapticScene> haptic; ///< null for a model to see only
    Similarity workspaceFromScene;
    ScenePart part; ///< what is seen and felt; `haptic` has no more, `scene` is the whole
};

/// Loads and compiles, without the ray structure (HapticScene::buildRays). Any thread; throws
/// Error, and Cancelled.
[[nodiscard]] Model loadModel(const std::filesystem::path& path, Fit fit, const LoadOptions& options = {});
/// For haptics only: does not decode what only rendering needs. `clock` may be null; `iso` and `animation`:
/// those of LoadOptions; `loose`: every object is a body (loosen).
[[nodiscard]] Model loadModelToTouch(const std::filesystem::path& path, Fit fit, StageClock* clock = nullptr,
                                     std::optional<double> iso = {},
                                     std::optional<std::string> animation = {}, bool loose = false);
/// For rendering only; `falseColor`: with the data for false colours.
[[nodiscard]] Model loadModelToSee(const std::filesystem::path& path, Fit fit, bool falseColor,
                                   std::optional<double> iso = {}, std::optional<std::string> animation = {});

/// Leaves a part of a whole model. Any thread; throws Error.
void takePart(Model& model, const ScenePart& part);
/// For recordings. Reads the file again.
[[nodiscard]] SceneIdentity identityOf(const Model& model, Fit fit);

/// Builds what these settings need beyond the plan, before the first tick, and prints on stderr what is not
/// available.
void prepareFor(const Model& model, const HapticSettings& settings);

/// The scene's bounds in the workspace (rest pose).
[[nodiscard]] Bounds workspaceBounds(const Model& model);

/// Prints every warning of the model on stderr, one per line.
void printWarnings(const Model& model);

} // namespace touchstone
