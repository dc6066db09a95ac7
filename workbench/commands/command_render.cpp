#include "engine/core/error.h"
#include "renderer/picture_file.h"
#include "renderer/scene_renderer.h"
#include "workbench/commands/render_camera.h"
#include "workbench/model/environment_light.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"
#include "workbench/options/gpu_options.h"
#include "workbench/screen/effect_colors.h"

#include <algorithm>
#include <cstdio>
#include <thread>

namespace touchstone {

namespace {

/// No servo needs a core here.
GpuOptions wholeMachine(const std::string& gpu) {
    GpuOptions options = gpuOptions(gpu);
    options.softwareThreads = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    return options;
}

ViewMode viewModeOf(const std::string& name) {
    const auto found = std::find(kViewModeNames.begin(), kViewModeNames.end(), name);
    return static_cast<ViewMode>(found - kViewModeNames.begin()); // the command line admits only these
}

} // namespace

int renderCommand(const RenderOptions& options) {
    const ViewMode mode = viewModeOf(options.view);
    // The plan belongs to the haptic scene.
    const Model model = mode == ViewMode::Effects
                            ? loadModel(options.scene, Fit::Workspace)
                            : loadModelToSee(options.scene, Fit::Workspace, mode != ViewMode::Shaded);
    printWarnings(model);
    const std::unique_ptr<Gpu> gpu = Gpu::headless(wholeMachine(options.gpu));
    SceneRenderer renderer(*gpu);
    lightWith(options.environment, renderer);
    renderer.setScene(model.scene);
    if (mode == ViewMode::Effects)
        renderer.setMaterialColors(effectColors(model.haptic->plan, model.scene->materials.size()).materials);

    View view = chosenView(options.camera, model, options.size);
    view.mode = mode;
    writePicture(options.out, renderStill(renderer, view, Overlay{}, options.size.x, options.size.y));
    std::printf("%d x %d pixels, written to %s\n", options.size.x, options.size.y, options.out.c_str());
    return 0;
}

} // namespace touchstone
