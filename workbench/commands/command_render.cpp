#include "devices/stroke/stroke_library.h"
#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "haptics/scene/scene_programs.h"
#include "haptics/scene/shape_object.h"
#include "haptics/tick/stepped_hand.h"
#include "renderer/picture_file.h"
#include "renderer/scene_renderer.h"
#include "workbench/commands/render_camera.h"
#include "workbench/figures/texture_figures.h"
#include "workbench/model/animate.h"
#include "workbench/model/environment_light.h"
#include "workbench/model/model.h"
#include "workbench/model/shown_textures.h"
#include "workbench/options/commands.h"
#include "workbench/options/gpu_options.h"
#include "workbench/screen/effect_colors.h"
#include "workbench/screen/field_slice.h"
#include "workbench/screen/ground_grid.h"
#include "workbench/screen/gui_pixels.h"
#include "workbench/screen/overlays.h"
#include "workbench/sculpt/sculpted_surface.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <optional>
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

bool hasPersistentTexture(const Scene& scene) {
    return std::ranges::any_of(
        scene.materials, [](const Material& material) { return material.haptic.program.texture.width > 0; });
}

/// Something that is felt as a field has a texture that its mesh lacks.
bool hasFieldTexture(const Scene& scene) {
    return std::ranges::any_of(scene.materials, [](const Material& material) {
        return material.haptic.implicit && !material.haptic.fieldTexture.empty();
    });
}

/// Where a plane cuts a field it leaves a face, but on the shell of an open mesh; which it is, is known to
/// the hand.
bool hasField(const Scene& scene) {
    return std::ranges::any_of(scene.materials,
                               [](const Material& material) { return material.haptic.implicit; });
}

/// The hand where a stroke over the model ends, and what it has made of the textures.
struct Touched {
    Touched(const RenderOptions& options, Model& model) {
        HapticSettings settings;
        prepareFor(model, settings);
        const StrokePath stroke =
            layStroke(*sceneOf(model.scene, model.part), model.workspaceFromScene, options.stroke);
        const double seconds = options.seconds > 0.0 ? options.seconds : stroke.period();
        enterFloatMode();
        hand.emplace(*model.haptic, model.scene);
        record.settings = 0;
        const auto count = static_cast<uint64_t>(seconds * kRate);
        for (uint64_t tick = 0; tick <= count; ++tick) {
            const double time = static_cast<double>(tick) / kRate;
            record.sample = sampleAt(stroke.positionIn(time, animationTime(settings, time)));
            record.output = hand->tick(settings, record.sample, time, 1.0 / kRate);
        }
        look.frictionCoefficient = frictionCoefficientAt(record, settings, *model.scene, *model.haptic);
    }

    static constexpr double kRate = 1000.0; // Hz
    std::optional<SteppedHand> hand;
    TickRecord record; ///< of the last tick
    TickLook look;
};

/// Compiled for touch only where that is seen.
Model modelToDraw(const RenderOptions& options, ViewMode mode) {
    LoadOptions loading;
    loading.iso = options.iso;
    loading.animation = options.animation;
    // The plan belongs to the haptic scene.
    Model model = mode == ViewMode::Effects || options.touched || options.sliceAxis >= 0
                      ? loadModel(options.scene, Fit::Workspace, loading)
                      : loadModelToSee(options.scene, Fit::Workspace, mode != ViewMode::Shaded, options.iso,
                                       options.animation);
    if (model.haptic == nullptr && // what is felt of them is seen
        (hasPersistentTexture(*model.scene) || hasFieldTexture(*model.scene) ||
         (options.part.clip && hasField(*model.scene))))
        model = loadModel(options.scene, Fit::Workspace, loading);
    takePart(model, partNamed(*model.scene, options.part));
    printWarnings(model);
    return model;
}

/// `--slice`, into the overlay; returns its label.
std::string drawSlice(const RenderOptions& options, const Model& model, Overlay& overlay) {
    const FieldSlice slice{.axis = options.sliceAxis, .at = options.sliceAt};
    const SliceFigures figures = drawFieldSlice(*model.haptic, slice, 1.0f, overlay);
    if (figures.lines == 0)
        throw Error(options.scene.string(), "", "has nothing in this slice that is felt as a field",
                    "choose another --slice-at, or give a material the representation implicit "
                    "(touchstone edit)");
    std::printf("%s: %zu pieces of isolines, %zu arrows\n", figures.label(slice).c_str(), figures.lines,
                figures.arrows);
    return figures.label(slice);
}

/// In the lower left corner; empty: none.
void writeLabel(PixelData& picture, const std::string& label, const glm::ivec2& size) {
    if (label.empty())
        return;
    drawGui(picture, 1.0f, [&] {
        ImGui::GetBackgroundDrawList()->AddText(
            ImVec2(12.0f, static_cast<float>(size.y) - 12.0f - ImGui::GetTextLineHeight()),
            IM_COL32(235, 238, 242, 255), label.c_str());
    });
}

} // namespace

int renderCommand(const RenderOptions& options) {
    const ViewMode mode = viewModeOf(options.view);
    Model model = modelToDraw(options, mode);
    const std::unique_ptr<Gpu> gpu = Gpu::headless(wholeMachine(options.gpu));
    SceneRenderer renderer(*gpu);
    lightWith(options.environment, renderer);
    renderer.setScene(model.scene);
    if (model.haptic != nullptr)
        drawTexturedFields(*model.haptic, *model.scene, renderer);
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
    if (model.haptic != nullptr)
        view.shells = shellsOf(*model.haptic);
    view.wireframe = options.wireframe;
    Overlay overlay;
    if (options.grid)
        grid.draw(model.workspaceFromScene, 1.0f, overlay);
    std::string label;
    if (options.grid)
        label = grid.label();
    if (options.sliceAxis >= 0) {
        const std::string slice = drawSlice(options, model, overlay);
        label += (label.empty() ? "" : "; ") + slice;
    }
    poseAt(options.time, *model.scene, renderer);
    if (options.touched) {
        const Touched touched(options, model);
        drawTick(touched.record, {}, touched.look, overlay);
        view.probe = probeShadow(touched.record, {});
        ShownTextures().show(*model.haptic, touched.hand->world.textures().get(), renderer);
        printCoverage(*model.haptic, touched.hand->world.textures().get());
    } else if (model.haptic != nullptr) {
        ShownTextures().show(*model.haptic, persistentTextures(*model.haptic).get(), renderer);
    }
    PixelData picture = renderStill(renderer, view, overlay, options.size.x, options.size.y);
    writeLabel(picture, label, options.size);
    writePicture(options.out, picture);
    std::printf("%d x %d pixels, written to %s\n", options.size.x, options.size.y, options.out.c_str());
    return 0;
}

} // namespace touchstone
