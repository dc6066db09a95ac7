#pragma once
// A model as both eye and hand have it.

#include "engine/load/scene_loader.h"
#include "engine/time/stage_clock.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"

#include <filesystem>
#include <memory>

namespace touchstone {

struct Model {
    ScenePtr scene;
    std::shared_ptr<const HapticScene> haptic; ///< null where only the eye was asked for
    Similarity workspaceFromScene;
};

/// Loads and compiles for a device, without the rays (HapticScene::buildRays). Any thread; throws Error, and
/// Cancelled.
[[nodiscard]] Model loadModel(const std::filesystem::path& path, Fit fit, const DeviceLimits& limits,
                              const LoadOptions& options = {});
/// For who touches and draws nothing: what only the eye would need is not decoded.
/// `clock` may be null.
[[nodiscard]] Model loadModelToTouch(const std::filesystem::path& path, Fit fit, const DeviceLimits& limits,
                                     StageClock* clock = nullptr);
/// The eye's half only; `falseColor`: it wants to see what the hand would feel.
[[nodiscard]] Model loadModelToSee(const std::filesystem::path& path, Fit fit, bool falseColor);

/// Builds what these settings call for besides the plan, so that the first tick has it, and says on stderr
/// what they ask for that cannot be had.
void prepareFor(const Model& model, const HapticSettings& settings);

/// The scene's bounds as they stand in the workspace (rest pose).
[[nodiscard]] Bounds workspaceBounds(const Model& model);

/// Every warning of the model on stderr, one a line.
void printWarnings(const Model& model);

} // namespace touchstone
