#include "workbench/model/model.h"

#include "engine/import/volume_file/volume_edits.h"
#include "haptics/body/body_world.h"
#include "haptics/comparison/comparison_solver.h"
#include "haptics/scene/built_for.h"
#include "haptics/scene/scene_parts.h"
#include "haptics/world/world_state.h"

#include <cstdio>
#include <utility>

namespace touchstone {

Model loadModel(const std::filesystem::path& path, Fit fit, const LoadOptions& options) {
    constexpr double kReading = 0.25; // fraction of the time to load a million triangles on two cores
    const Progress whole(&options.progress, options.cancel);
    LoadOptions loading = options;
    loading.progress = [&](double fraction, const char* what) { whole.report(kReading * fraction, what); };
    Model model;
    model.scene = loadScene(path, loading);
    model.workspaceFromScene = workspaceFromScene(*model.scene, fit);
    model.haptic = compileHapticScene(*model.scene, model.workspaceFromScene,
                                      {.rays = false, .progress = whole.part(kReading, 1.0)});
    return model;
}

Model loadModelToTouch(const std::filesystem::path& path, Fit fit, StageClock* clock,
                       std::optional<double> iso, std::optional<std::string> animation, bool loose) {
    LoadOptions options;
    if (loose)
        options.edits = withLoose({});
    options.iso = iso;
    options.animation = std::move(animation);
    if (clock != nullptr)
        options.progress = [clock](double, const char* what) { clock->at(what); };
    options.images.visual = false;
    return loadModel(path, fit, options);
}

Model loadModelToSee(const std::filesystem::path& path, Fit fit, bool falseColor, std::optional<double> iso,
                     std::optional<std::string> animation) {
    LoadOptions options;
    options.iso = iso;
    options.animation = std::move(animation);
    options.images.haptic = falseColor;
    Model model;
    model.scene = loadScene(path, options);
    model.workspaceFromScene = workspaceFromScene(*model.scene, fit);
    return model;
}

void takePart(Model& model, const ScenePart& part) {
    model.part = part;
    if (model.haptic != nullptr && !part.whole())
        model.haptic = partOf(*model.haptic, *model.scene, part);
}

SceneIdentity identityOf(const Model& model, Fit fit) {
    SceneIdentity identity = identify(*model.haptic, *model.scene, fit);
    identity.part = model.part;
    return identity;
}

void prepareFor(const Model& model, const HapticSettings& settings) {
    for (const std::string& warning : settingWarnings(*model.haptic, settings))
        std::fprintf(stderr, "touchstone: warning: %s\n", warning.c_str());
    buildFor(*model.haptic, settings);
}

Bounds workspaceBounds(const Model& model) {
    Bounds bounds;
    if (model.scene->bounds.empty())
        return bounds;
    // Fitting does not rotate, so the box stays a box.
    bounds.include(model.workspaceFromScene.point(model.scene->bounds.low));
    bounds.include(model.workspaceFromScene.point(model.scene->bounds.high));
    return bounds;
}

void printWarnings(const Model& model) {
    const auto print = [&](const Warning& warning) {
        std::fprintf(stderr, "touchstone: warning: %s: %s: %s\n", model.scene->path.c_str(),
                     warning.place.c_str(), warning.message.c_str());
    };
    for (const Warning& warning : model.scene->warnings)
        print(warning);
    if (model.haptic != nullptr)
        for (const Warning& warning : model.haptic->warnings)
            print(warning);
    for (const Warning& warning : animationWarnings(*model.scene))
        print(warning);
    std::vector<Warning> ofBodies;
    if (model.haptic != nullptr && model.scene->physics != nullptr)
        (void)body::BodyWorld::make(*model.scene, *model.haptic, &ofBodies);
    for (const Warning& warning : ofBodies)
        print(warning);
}

} // namespace touchstone
