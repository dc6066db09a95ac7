#include "workbench/options/command_options.h"

#include "haptics/servo/servo_loop.h"
#include "workbench/figures/ui_scale.h"
#include "workbench/options/number_range.h"
#include "workbench/options/shared_options.h"

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

namespace {

/// "friction=off texture=off", with blanks or commas between.
ComparedSettings comparedSettings(const std::string& text) {
    constexpr const char* kBetween = " ,\t\n";
    ComparedSettings compared{.text = text, .settings = {}};
    HapticSettings tried;
    for (size_t at = text.find_first_not_of(kBetween); at != std::string::npos;) {
        const size_t end = std::min(text.find_first_of(kBetween, at), text.size());
        const std::string assignment = text.substr(at, end - at);
        const size_t equals = assignment.find('=');
        if (equals == std::string::npos)
            throw CLI::ValidationError("--compare", "'" + assignment + "' is not of the form NAME=VALUE");
        const std::string name = assignment.substr(0, equals), value = assignment.substr(equals + 1);
        if (const std::string problem = setSetting(tried, name, value); !problem.empty())
            throw CLI::ValidationError("--compare", problem);
        compared.settings.emplace_back(name, value);
        at = text.find_first_not_of(kBetween, end);
    }
    if (compared.settings.empty())
        throw CLI::ValidationError("--compare", "no setting is named: 'NAME=VALUE ...'");
    return compared;
}

/// Each hand has a device of its own.
void requireApart(const std::vector<std::string>& devices) {
    if (devices.size() > kMaxHands)
        throw CLI::ValidationError("--device", "names " + std::to_string(devices.size()) +
                                                   " hands; one servo drives " + std::to_string(kMaxHands));
    for (auto device = devices.begin(); device != devices.end(); ++device)
        if (*device != "hand" && std::find(devices.begin(), device, *device) != device)
            throw CLI::ValidationError("--device", "names " + *device + " for two hands");
    const auto real = std::ranges::count_if(
        devices, [](const std::string& name) { return name != "hand" && name != "mouse"; });
    if (real > 1 && std::ranges::count(devices, "auto") > 0)
        throw CLI::ValidationError("--device", "auto cannot be combined with another device: name each");
}

/// --device of the window, once per hand: the first one's can be changed there.
void addWindowDevices(CLI::App& app, WindowOptions& options) {
    static constexpr const char* kFirst = "mouse (the default), hand (the simulated one)";
    addDevices(app, kFirst, [&options](const std::vector<std::string>& devices) {
        const std::string& first = devices.front();
        options.simulatedHand = first == "hand";
        options.device = first == "mouse" || first == "hand" ? "" : first;
        options.otherDevices.assign(devices.begin() + 1, devices.end());
        requireApart(devices);
        if (std::ranges::count(options.otherDevices, "mouse") > 0)
            throw CLI::ValidationError("--device", "names the mouse for a further hand; it can be the first");
    });
}

} // namespace

void defineDevices(CLI::App& app, DevicesOptions& options) {
    CLI::Option* test = app.add_option("--test", options.test,
                                       "Try one: how often it reports, how old samples are, where it is. A "
                                       "device as `run --device` takes, but for hand")
                            ->type_name("DEVICE");
    app.add_option("--seconds", options.seconds, "How long [3]")
        ->type_name("S")
        ->check(within(0.1, 3600.0))
        ->needs(test);
    constexpr double kMaxForce = 2.0; // N; a loosely held device stays in the hand
    app.add_option(
           "--force", options.force,
           "Push this hard along each axis in turn; without it no force is ever sent. Hold the device!")
        ->type_name("N")
        ->check(within(0.0, kMaxForce))
        ->needs(test);
    app.add_option("--json", options.json, "Write the figures here")->type_name("FILE")->needs(test);
}

void defineWindow(CLI::App& app, WindowOptions& options) {
    addScene(app, options.scene)
        ->description(
            "Model (glTF, OBJ, STL, PLY), volume (NRRD, MetaImage, NIfTI, OpenVDB) or recording (.tsrec) "
            "to open in a window; without it the board of effects");
    addIso(app, options.iso);
    addAnimation(app, options.animation);
    addLoose(app, options.loose);
    addSettings(app, [&options](std::string_view name, std::string_view value) {
        HapticSettings tried; // tests validity; applied over the settings of the last run
        options.settings.emplace_back(name, value);
        return setSetting(tried, name, value);
    });
    addRate(app, options.rateHz, "Servo rate [1000]");
    app.add_option_function<std::string>(
           "--hand", [&options](const std::string& hand) { options.simulatedHand = hand == "simulated"; },
           "Who moves the hand at first [mouse]")
        ->check(CLI::IsMember({"mouse", "simulated"}));
    addWindowDevices(app, options);
    app.add_flag("--sound", options.sound, "Let the force be heard from the start");
    addStroke(app, options.stroke, "How the simulated hand strokes (listed at the end of --help) [tour]");
    addZoom(app, options.zoom);
    addSize(app, "--size", options.size, "Size of the window [that of the last run; 1280x800]");
    addSize(app, "--picture-size", options.pictureSize,
            "Size of the pictures that F12 saves [as the window shows it]");
    app.add_option_function<std::string>(
           "--ui-scale",
           [&options](const std::string& text) {
               if (const std::string problem = readUiScale(text, options.uiScale); !problem.empty())
                   throw CLI::ValidationError("--ui-scale", problem);
           },
           "Size of type and widgets beside what the monitor asks for, 0.75 to 4 [the last run's, at first "
           "1]")
        ->type_name("FACTOR");
    app.add_option("--status-json", options.statusJson,
                   "Keep this file up to date with what the window shows: servo, force, settings, widgets")
        ->type_name("FILE");
    addPart(app, options.part);
    addRecording(app, options.recording);
    addEnvironment(app, options.environment);
    addGpu(app, options.gpu);
}

namespace {

void requireHands(const RunOptions& options) {
    const std::vector<std::string>& devices = options.devices;
    requireApart(devices);
    if (options.recordTicks.size() > devices.size())
        throw CLI::ValidationError("--record-ticks", "names " + std::to_string(options.recordTicks.size()) +
                                                         " files for " + std::to_string(devices.size()) +
                                                         (devices.size() == 1 ? " hand" : " hands"));
    std::set<std::filesystem::path> files;
    for (const std::filesystem::path& file : options.recordTicks)
        if (!files.insert(std::filesystem::absolute(file).lexically_normal()).second)
            throw CLI::ValidationError("--record-ticks", "names " + file.string() + " for two hands");
}

/// --sculpted, once per file.
CLI::Option* addSculpted(CLI::App& app, std::vector<std::filesystem::path>& files) {
    return app.add_option("--sculpted", files, "Write the sculpted object, at the end; may be given again")
        ->type_name("FILE.glb|vdb")
        ->expected(1)
        ->take_all()
        ->check([](const std::string& file) {
            const std::string ending = std::filesystem::path(file).extension().string();
            return ending == ".glb" || ending == ".vdb" ? std::string()
                                                        : file + " ends in neither .glb nor .vdb";
        });
}

/// --sculpt and what belongs to it.
void addSculpt(CLI::App& app, SculptOptions& options) {
    std::vector<std::string> names;
    for (const SculptToolInfo& info : sculptTools())
        names.emplace_back(info.name);
    CLI::Option* const sculpt =
        app.add_option_function<std::string>(
               "--sculpt",
               [&options](const std::string& name) {
                   options.wanted = true;
                   options.tool.tool = *sculptToolNamed(name);
               },
               "The hand holds this tool and sculpts what is felt as a field, wherever it strokes")
            ->type_name("TOOL")
            ->check(CLI::IsMember(names));
    app.add_option("--sculpt-radius", options.tool.radius, "Of the tool, workspace [0.005]")
        ->type_name("M")
        ->check(within(1e-6, 1.0))
        ->needs(sculpt);
    app.add_option("--sculpt-strength", options.tool.strength, "Above 0, at most 1 [1]")
        ->check(within(1e-3, 1.0))
        ->needs(sculpt);
    app.add_option("--sculpt-falloff", options.tool.falloff, "0..1: the soft part of the radius [0]")
        ->check(within(0.0, 1.0))
        ->needs(sculpt);
    app.add_option("--sculpt-resistance", options.tool.resistance,
                   "N for each m^3/s that the tool takes away [500000]")
        ->type_name("R")
        ->check(within(0.0, 1e9))
        ->needs(sculpt);
    app.add_option("--sculpt-stamp", options.stamp, "Object of the scene whose shape is stamped or imprinted")
        ->type_name("NAME")
        ->needs(sculpt);
    app.add_option_function<std::string>(
           "--sculpt-color",
           [&options](const std::string& text) {
               const std::optional<glm::dvec3> color = vectorOf(text);
               if (!color || glm::any(glm::lessThan(*color, glm::dvec3(0.0))) ||
                   glm::any(glm::greaterThan(*color, glm::dvec3(1.0))))
                   throw CLI::ValidationError("--sculpt-color",
                                              "'" + text + "' is no colour; write R,G,B, each 0 to 1");
               options.tool.color = glm::vec3(*color);
           },
           "Of paint, linear, 0 to 1 each [0.8,0.05,0.03]")
        ->type_name("R,G,B")
        ->needs(sculpt);
    addSculpted(app, options.files)->needs(sculpt);
}

} // namespace

void defineRun(CLI::App& app, RunOptions& options) {
    addScene(app, options.scene)->required();
    addIso(app, options.iso);
    addAnimation(app, options.animation);
    addLoose(app, options.loose);
    app.add_flag_function(
        "--headless", [](int64_t) {}, "Accepted for older scripts: `run` never opens a window");
    app.add_option("--seconds", options.seconds, "How long [10]")
        ->type_name("S")
        ->check(within(0.1, 86400.0));
    app.add_option("--json", options.json, "Write the figures here")->type_name("FILE");
    addPicture(app, "--screenshot", options.screenshot, "Write the last picture here: PNG or JPEG");
    app.add_option("--record-ticks", options.recordTicks,
                   "Write every tick here, as CSV; repeat the option for each further hand")
        ->type_name("FILE")
        ->expected(1)
        ->take_all();
    app.add_flag("--pad", options.pad, "With two more columns: where a finger's pad touches")
        ->needs("--record-ticks");
    addRecording(app, options.recording);
    addSculpt(app, options.sculpt);
    CLI::Option* open = app.add_flag("--open-loop", options.openLoop,
                                     "The hand follows its path whatever the force, as no hand can");
    CLI::Option* plant = addPlant(app, options.plant)->excludes(open);
    CLI::Option* stroke =
        addStroke(app, options.stroke, "How it strokes (listed at the end of --help) [tour]");
    addZoom(app, options.zoom);
    addDevices(app, "hand (the simulated one, the default)",
               [&options](const std::vector<std::string>& devices) { options.devices = devices; });
    app.parse_complete_callback([&options, open, plant, stroke] {
        requireHands(options);
        const bool simulates = std::ranges::count(options.devices, "hand") > 0;
        for (const CLI::Option* simulated : {open, plant, stroke})
            if (!simulates && simulated->count() > 0)
                throw CLI::ValidationError(simulated->get_name(),
                                           "is of the simulated hand, and --device names another");
    });
    addSize(app, "--size", options.size, "Size of the picture [800x450]");
    addSettings(app, options.settings);
    addRate(app, options.rateHz, "Servo rate [1000]");
    addPart(app, options.part);
    addEnvironment(app, options.environment);
    addGpu(app, options.gpu);
}

void defineTouch(CLI::App& app, TouchOptions& options) {
    addScene(app, options.scene)->required();
    addIso(app, options.iso);
    addAnimation(app, options.animation);
    addLoose(app, options.loose);
    CLI::Option* path =
        app.add_option("--path", options.path, "Path of the hand: CSV with columns t,x,y,z (s, m)")
            ->type_name("HIP.csv");
    CLI::Option* stroke =
        addStroke(app, options.stroke, "In place of a path: a stroke (listed at the end of --help)")
            ->excludes(path);
    addStrokeSeconds(app, options.seconds, stroke);
    app.parse_complete_callback([path, stroke] {
        if (path->count() == 0 && stroke->count() == 0)
            throw CLI::RequiredError("--path or --stroke");
    });
    app.add_option("--out", options.out, "Every tick: CSV")->type_name("TICKS.csv")->required();
    app.add_flag("--pad", options.pad, "With two more columns in TICKS.csv: where a finger's pad touches");
    app.add_option("--json", options.json, "Write the figures here: step times, Embree's ray floor, contact")
        ->type_name("FILE");
    app.add_option_function<std::string>(
           "--fit",
           [&options](const std::string& fit) {
               options.fit = fit == "workspace" ? Fit::Workspace : Fit::None;
           },
           "Scene metres as workspace metres, or fitted to the device's workspace [none]")
        ->check(CLI::IsMember({"none", "workspace"}));
    CLI::Option* closed =
        app.add_flag("--closed-loop", options.closedLoop,
                     "The path is what the hand intends: it holds a simulated device, and both yield");
    addPlant(app, options.plant)->needs(closed);
    app.add_option("--record", options.record, "Record for `touchstone replay`")->type_name("FILE");
    app.add_option("--sound", options.sound, "Write how the force sounds, as WAV")->type_name("FILE.wav");
    CLI::Option* sculpt =
        app.add_option("--sculpt", options.sculpt,
                       "Sculpt what is felt as a field: strokes before touch begins, or at their times")
            ->type_name("JOURNAL.json");
    addSculpted(app, options.sculpted)->needs(sculpt);
    app.add_option("--brushed", options.brushed,
                   "Save the model with its persistent textures as touch leaves them, as .glb or .gltf")
        ->type_name("FILE");
    addSettings(app, options.settings);
    addRate(app, options.rateHz,
            "Resample the path at this rate; without it one tick a row (1000 for a stroke)");
    addPart(app, options.part);
}

void defineReplay(CLI::App& app, ReplayOptions& options) {
    app.add_option("FILE", options.recording,
                   "A recording: of --record, of the window's button, or of the flight recorder")
        ->type_name("")
        ->required();
    app.add_option("--out", options.out, "Every tick as it came out now: CSV")->type_name("TICKS.csv");
    app.add_option("--json", options.json, "Write the answer here, as JSON")->type_name("FILE");
    CLI::Option* const compare =
        app.add_option_function<std::vector<std::string>>(
               "--compare",
               [&options](const std::vector<std::string>& texts) {
                   for (const std::string& text : texts)
                       options.compare.push_back(comparedSettings(text));
               },
               "Also touch it again with these settings changed (listed at the end of touchstone --help), "
               "and tell what differs; may be given again, each is compared with the recorded ones")
            ->type_name("'NAME=VALUE ...'")
            ->expected(1)
            ->take_all();
    app.add_option("--compare-out", options.compareOut,
                   "Forces and proxies of every tick, as recorded and with each --compare: CSV")
        ->type_name("FILE.csv")
        ->needs(compare);
    app.add_option("--plot", options.plot,
                   "The force over time as a figure, as recorded and with each --compare: SVG, or PNG")
        ->type_name("FILE")
        ->check([](const std::string& text) {
            const std::string ending = std::filesystem::path(text).extension().string();
            return ending == ".svg" || ending == ".png" ? std::string()
                                                        : "'" + text + "' ends neither in .svg nor in .png";
        });
    app.add_option("--scene", options.scenes,
                   "Touch this model in place of the recorded one; may be given again for the next one")
        ->type_name("SCENE")
        ->expected(1)
        ->take_all();
}

} // namespace touchstone
