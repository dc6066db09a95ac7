// Options of the commands that change, draw and describe a model.

#include "renderer/view.h"
#include "workbench/editor/haptic_fields.h"
#include "workbench/editor/presets.h"
#include "workbench/options/command_options.h"
#include "workbench/options/number_range.h"
#include "workbench/options/shared_options.h"

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

void defineEdit(CLI::App& app, EditOptions& options) {
    addScene(app, options.scene)
        ->required()
        ->description(
            "Model: a .gltf, .glb, .obj, .stl or .ply file (a volume has no place for what is felt)");
    app.add_option("--material", options.materials,
                   "Which one: its name, its index in the file, or all; may be given again. Not needed where "
                   "the file has only one")
        ->type_name("NAME")
        ->expected(1)
        ->take_all();
    std::vector<std::string> presets;
    for (const MaterialPreset& preset : materialPresets())
        presets.emplace_back(preset.name);
    app.add_option("--preset", options.preset, "Numbers to begin with; maps stay as they are")
        ->type_name("NAME")
        ->check(CLI::IsMember(presets));
    app.add_flag("--reset", options.reset, "First take out all that the file says of how it feels");
    app.add_option("--reset-field", options.resetFields, "Take out one field; may be given again")
        ->type_name("NAME")
        ->expected(1)
        ->take_all()
        ->check([](const std::string& name) {
            return name == "shader" || name.starts_with("shader.") || name == "textureMapping"
                       ? std::string()
                       : hapticFieldProblem(name);
        });
    addAssignments(app, "--field", "Set a field (listed at the end of edit --help); may be given again",
                   [&options](std::string_view name, std::string_view value) {
                       options.fields.emplace_back(name, value);
                       return hapticValueProblem(name, value);
                   });
    app.add_option("--out", options.out,
                   "Save here; without it into the model's own file, where that is glTF: OBJ, STL and PLY "
                   "need a new .glb")
        ->type_name("FILE");
}

void defineRender(CLI::App& app, RenderOptions& options) {
    addScene(app, options.scene)->required();
    addIso(app, options.iso);
    addAnimation(app, options.animation);
    addPicture(app, "--out", options.out, "The picture: PNG or JPEG")->required();
    app.add_option("--time", options.time, "Of the scene's animation, s [0]")->type_name("S");
    addSize(app, "--size", options.size, "Size of the picture [1280x720]");
    std::vector<std::string> views;
    for (const std::string_view name : kViewModeNames)
        views.emplace_back(name);
    app.add_option("--view", options.view, "What is shown: the look, or a map of what is felt [shaded]")
        ->type_name("NAME")
        ->check(CLI::IsMember(views));
    app.add_flag("--wireframe", options.wireframe, "Draw the edges of the triangles over the surface");
    app.add_flag("--grid", options.grid, "Draw a grid on the ground; its spacing stands in the picture");
    CLI::Option* const slice =
        app.add_option_function<std::string>(
               "--slice", [&options](const std::string& axis) { options.sliceAxis = axis[0] - 'x'; },
               "Draw what is felt as a field in a slice across this axis of the scene: isolines of the "
               "distance and arrows along the gradient")
            ->type_name("AXIS")
            ->check(CLI::IsMember({"x", "y", "z"}));
    app.add_option("--slice-at", options.sliceAt, "Its place, from one end of the field to the other [0.5]")
        ->type_name("0..1")
        ->check(within(0.0, 1.0))
        ->needs(slice);
    CLI::Option* stroke =
        addStroke(app, options.stroke,
                  "Touch the model before, at 1000 Hz, by a stroke (listed at the end of touch "
                  "--help): shows the hand where it ends, and what it has worn off");
    addStrokeSeconds(app, options.seconds, stroke);
    stroke->each([&options](const std::string&) { options.touched = true; });
    addCamera(app, options.camera);
    addPart(app, options.part);
    addEnvironment(app, options.environment);
    addGpu(app, options.gpu);
}

void defineInspect(CLI::App& app, InspectOptions& options) {
    addScene(app, options.scene)->required();
    addIso(app, options.iso);
    addAnimation(app, options.animation);
    app.add_option("--json", options.json, "Write the answer here, as JSON")->type_name("FILE");
}

void defineSimplify(CLI::App& app, SimplifyOptions& options) {
    addScene(app, options.scene)->required();
    addIso(app, options.iso);
    app.add_option("--threshold", options.degrees,
                   "Nine smooth edges of ten are to stay within this angle between facets, degrees; [004] "
                   "found 0.2 to 14.8 for one cylinder (inspect)")
        ->type_name("DEG")
        ->required()
        ->check(within(0.01, 90.0));
    app.add_option("--out", options.out,
                   "Write the model here, as GLB: the static pose's triangles with the names of their "
                   "materials; without it the figures alone")
        ->type_name("FILE")
        ->check([](const std::string& file) {
            return std::filesystem::path(file).extension() == ".glb" ? std::string()
                                                                     : file + " does not end in .glb";
        });
}

} // namespace touchstone
