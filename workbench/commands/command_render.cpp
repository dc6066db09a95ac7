#include "engine/core/error.h"
#include "renderer/picture_file.h"
#include "renderer/scene_renderer.h"
#include "workbench/commands/render_camera.h"
#include "workbench/model/animate.h"
#include "workbench/model/environment_light.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"
#include "workbench/options/gpu_options.h"
#include "workbench/screen/effect_colors.h"
#include "workbench/screen/ground_grid.h"
#include "workbench/screen/gui_pixels.h"

#include <imgui.h>

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
    LoadOptions loading;
    loading.iso = options.iso;
    loading.animation = options.animation;
    // The plan belongs to the haptic scene.
    Model model = mode == ViewMode::Effects
                      ? loadModel(options.scene, Fit::Workspace, loading)
                      : loadModelToSee(options.scene, Fit::Workspace, mode != ViewMode::Shaded, options.iso,
                                       options.animation);
    takePart(model, partNamed(*model.scene, options.part));
    printWarnings(model);
    const std::unique_ptr<Gpu> gpu = Gpu::headless(wholeMachine(options.gpu));
    SceneRenderer renderer(*gpu);
    lightWith(options.environment, renderer);
    renderer.setScene(model.scene);
    if (mode == ViewMode::Effects)
        renderer.setMaterialColors(effectColors(model.haptic->plan, model.scene->materials.size()).materials);

    const GroundGrid grid(model.scene->bounds);
    Bounds drawn = model.scene->bounds;
    if (options.grid && !grid.bounds.empty()) {
        drawn.include(grid.bounds.low);
        drawn.include(grid.bounds.high);
    }
    View view = chosenView(options.camera, model, options.size, drawn);
    view.mode = mode;
    view.part = model.part;
    view.wireframe = options.wireframe;
    Overlay overlay;
    if (options.grid)
        grid.draw(model.workspaceFromScene, 1.0f, overlay);
    poseAt(options.time, *model.scene, renderer);
    PixelData picture = renderStill(renderer, view, overlay, options.size.x, options.size.y);
    if (options.grid)
        drawGui(picture, 1.0f, [&] {
            ImGui::GetBackgroundDrawList()->AddText(
                ImVec2(12.0f, static_cast<float>(options.size.y) - 12.0f - ImGui::GetTextLineHeight()),
                IM_COL32(235, 238, 242, 255), grid.label().c_str());
        });
    writePicture(options.out, picture);
    std::printf("%d x %d pixels, written to %s\n", options.size.x, options.size.y, options.out.c_str());
    return 0;
}

} // namespace touchstone
