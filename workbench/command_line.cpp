#include "workbench/command_line.h"

#include "devices/workspace_map.h"
#include "haptics/servo/servo_loop.h"
#include "renderer/view.h"
#include "workbench/editor/haptic_fields.h"
#include "workbench/editor/presets.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <charconv>
#include <functional>
#include <iomanip>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

namespace {

constexpr int kMostPixels = 16384;

/// Every `--set`, for the end of the help.
std::string settingsHelp() {
    std::string text = "Settings for --set NAME=VALUE:\n";
    const HapticSettings defaults;
    for (const SettingInfo& info : settingInfos()) {
        std::string line = "  " + std::string(info.name) + "=" + settingValue(defaults, info.name);
        if (!info.unit.empty())
            line += " " + std::string(info.unit);
        line.resize(std::max<size_t>(line.size() + 2, 30), ' ');
        text += line + std::string(info.meaning) + "  [" + std::string(info.values) + "]\n";
    }
    return text;
}

/// Every `--plant`, for the end of the help.
std::string plantHelp() {
    std::ostringstream text;
    text << "Simulated device and hand for --plant NAME=VALUE (a Phantom Premium 1.5 in a light grip):\n";
    const PlantParameters defaults;
    for (const PlantInfo& info : plantInfos()) {
        std::ostringstream line;
        line << "  " << info.name << '=' << plantParameter(defaults, info.name) << ' ' << info.unit;
        text << std::left << std::setw(30) << line.str() << "  " << info.meaning << "  [" << info.least
             << " .. " << info.most << "]\n";
    }
    return text.str();
}

/// Every `--stroke`, for the end of the help.
std::string strokesHelp() {
    std::ostringstream text;
    text << "Strokes of the simulated hand for --stroke NAME (with their own speed and depth):\n";
    for (const StrokeInfo& info : strokeInfos()) {
        std::ostringstream line;
        line << "  " << std::left << std::setw(8) << info.name << info.speed << " m/s, " << 1e3 * info.depth
             << " mm";
        text << std::left << std::setw(30) << line.str() << "  " << info.meaning << '\n';
    }
    return text.str();
}

constexpr const char* kExitHelp = "Exit status: 0 done, 1 bad input or a missing facility, 2 wrong usage.\n";

/// "1280x720"
bool parseSize(const std::string& text, glm::ivec2& size) {
    const char* begin = text.data();
    const char* end = begin + text.size();
    glm::ivec2 parsed{0};
    const auto width = std::from_chars(begin, end, parsed.x);
    if (width.ec != std::errc{} || width.ptr == end || *width.ptr != 'x')
        return false;
    const auto height = std::from_chars(width.ptr + 1, end, parsed.y);
    if (height.ec != std::errc{} || height.ptr != end || std::min(parsed.x, parsed.y) < 1 ||
        std::max(parsed.x, parsed.y) > kMostPixels)
        return false;
    size = parsed;
    return true;
}

void addSize(CLI::App& app, glm::ivec2& size, const std::string& meaning) {
    app.add_option_function<std::string>(
           "--size",
           [&size](const std::string& text) {
               if (!parseSize(text, size))
                   throw CLI::ValidationError("--size", "'" + text +
                                                            "' is not a size; write WIDTHxHEIGHT, 1.." +
                                                            std::to_string(kMostPixels) + " pixels each");
           },
           meaning)
        ->type_name("WxH");
}

/// An option NAME=VALUE that may be given again; `assign` returns what is wrong.
CLI::Option* addAssignments(CLI::App& app, const std::string& option, const std::string& meaning,
                            std::function<std::string(std::string_view, std::string_view)> assign) {
    const auto take = [option, assign = std::move(assign)](const std::vector<std::string>& assignments) {
        for (const std::string& assignment : assignments) {
            const size_t equals = assignment.find('=');
            if (equals == std::string::npos)
                throw CLI::ValidationError(option, "'" + assignment + "' is not of the form NAME=VALUE");
            const std::string problem = assign(std::string_view(assignment).substr(0, equals),
                                               std::string_view(assignment).substr(equals + 1));
            if (!problem.empty())
                throw CLI::ValidationError(option, problem);
        }
    };
    return app.add_option_function<std::vector<std::string>>(option, take, meaning)
        ->type_name("NAME=VALUE")
        ->expected(1)
        ->take_all();
}

void addSettings(CLI::App& app, std::function<std::string(std::string_view, std::string_view)> assign) {
    addAssignments(app, "--set",
                   "Change a setting of the hand (listed at the end of --help); may be given again",
                   std::move(assign));
}

void addSettings(CLI::App& app, HapticSettings& settings) {
    addSettings(app, [&settings](std::string_view name, std::string_view value) {
        return setSetting(settings, name, value);
    });
}

CLI::Option* addPlant(CLI::App& app, PlantParameters& plant) {
    return addAssignments(app, "--plant",
                          "Change the simulated device or the hand that holds it (listed at the end of "
                          "--help); may be given again",
                          [&plant](std::string_view name, std::string_view value) {
                              return setPlantParameter(plant, name, value);
                          });
}

CLI::Option* addStroke(CLI::App& app, StrokeRequest& stroke, const std::string& meaning) {
    CLI::Option* name = app.add_option("--stroke", stroke.name, meaning)
                            ->type_name("NAME")
                            ->check([](const std::string& text) { return strokeProblem(text); });
    app.add_option("--stroke-speed", stroke.speed, "How fast it goes, at its fastest [the stroke's own]")
        ->type_name("M/S")
        ->check(CLI::Range(kSlowestStroke, kFastestStroke));
    app.add_option("--stroke-depth", stroke.depth, "How deep it presses [the stroke's own]")
        ->type_name("M")
        ->check(CLI::Range(kShallowestStroke, kDeepestStroke));
    return name;
}

void addZoom(CLI::App& app, double& zoom) {
    app.add_option(
           "--workspace-scale", zoom,
           "How far the hand goes in the model for each metre of the device, or of the simulated hand [1]")
        ->type_name("FACTOR")
        ->check(CLI::Range(kLeastZoom, kMostZoom));
}

void addRate(CLI::App& app, double& rate, const std::string& meaning) {
    app.add_option("--rate", rate, meaning)
        ->type_name("HZ")
        ->check(CLI::Range(kLeastServoRate, kMostServoRate));
}

void addGpu(CLI::App& app, std::string& gpu) {
    app.add_option("--gpu", gpu, "Vulkan device to use, by a part of its name")->type_name("NAME");
}

void addRecording(CLI::App& app, RecordingOptions& options) {
    app.add_option("--record", options.record, "Record for `touchstone replay`")->type_name("FILE");
    app.add_option_function<std::string>(
           "--flight-recorder",
           [&options](const std::string& folder) {
               options.flight = folder != "off";
               options.flightFolder = folder;
           },
           "Where the last seconds before a fault are kept, or off [~/.local/state/touchstone/flight]")
        ->type_name("DIR|off");
    app.add_option("--flight-seconds", options.flightSeconds, "How many seconds those are at least [10]")
        ->type_name("S")
        ->check(CLI::Range(1.0, 600.0));
}

CLI::Option* addScene(CLI::App& app, std::filesystem::path& scene) {
    return app.add_option("SCENE", scene, "glTF model: a .gltf or .glb file")->type_name("");
}

constexpr const char* kDeviceHelp =
    "What is held: %, auto (what is plugged in), udp[:PORT] (another program), /dev/hidrawN, a device "
    "file (.json) or a part of a name that `touchstone devices` lists";

void addDevice(CLI::App& app, const std::string& builtIn,
               const std::function<void(const std::string&)>& take) {
    std::string help = kDeviceHelp;
    help.replace(help.find('%'), 1, builtIn);
    app.add_option_function<std::string>("--device", take, help)->type_name("DEVICE");
}

void defineDevices(CLI::App& app, DevicesOptions& options) {
    CLI::Option* test =
        app.add_option("--test", options.test,
                       "Try one: how often it reports, how old samples are, where it is. As in --device")
            ->type_name("DEVICE");
    app.add_option("--seconds", options.seconds, "How long [3]")
        ->type_name("S")
        ->check(CLI::Range(0.1, 3600.0))
        ->needs(test);
    constexpr double kMostForce = 2.0; // N; a hand that holds the device loosely keeps it
    app.add_option(
           "--force", options.force,
           "Push this hard along each axis in turn; without it no force is ever sent. Hold the device!")
        ->type_name("N")
        ->check(CLI::Range(0.0, kMostForce))
        ->needs(test);
    app.add_option("--json", options.json, "Write the figures here")->type_name("FILE")->needs(test);
}

void defineWindow(CLI::App& app, WindowOptions& options) {
    addScene(app, options.scene)
        ->description("glTF model or recording (.tsrec) to open in a window; without it the doughnut");
    addSettings(app, [&options](std::string_view name, std::string_view value) {
        HapticSettings tried; // whether it is one; it goes over what the last run left
        options.settings.emplace_back(name, value);
        return setSetting(tried, name, value);
    });
    addRate(app, options.rateHz, "Servo rate [1000]");
    app.add_option_function<std::string>(
           "--hand", [&options](const std::string& hand) { options.simulatedHand = hand == "simulated"; },
           "Who moves the hand at first [mouse]")
        ->check(CLI::IsMember({"mouse", "simulated"}));
    addDevice(app, "mouse (the default), hand (the simulated one)", [&options](const std::string& device) {
        options.simulatedHand = device == "hand";
        options.device = device == "mouse" || device == "hand" ? "" : device;
    });
    app.add_flag("--sound", options.sound, "Let the force be heard from the start");
    addStroke(app, options.stroke, "How the simulated hand strokes (listed at the end of --help) [tour]");
    addZoom(app, options.zoom);
    addSize(app, options.size, "Size of the window [1280x800]");
    app.add_option("--status-json", options.statusJson,
                   "Keep this file up to date with what the window shows: servo, force, settings, widgets")
        ->type_name("FILE");
    addRecording(app, options.recording);
    addGpu(app, options.gpu);
}

void defineRun(CLI::App& app, RunOptions& options, bool& headless) {
    addScene(app, options.scene)->required();
    app.add_flag("--headless", headless, "No window (this is what `run` is for)")->required();
    app.add_option("--seconds", options.seconds, "How long [10]")
        ->type_name("S")
        ->check(CLI::Range(0.1, 86400.0));
    app.add_option("--json", options.json, "Write the figures here")->type_name("FILE");
    app.add_option("--screenshot", options.screenshot, "Write the last picture here, as PNG")
        ->type_name("FILE");
    app.add_option("--record-ticks", options.recordTicks, "Write every tick here, as CSV")->type_name("FILE");
    addRecording(app, options.recording);
    CLI::Option* open = app.add_flag("--open-loop", options.openLoop,
                                     "The hand follows its path whatever the force, as no hand can");
    CLI::Option* plant = addPlant(app, options.plant)->excludes(open);
    CLI::Option* stroke =
        addStroke(app, options.stroke, "How it strokes (listed at the end of --help) [tour]");
    addZoom(app, options.zoom);
    addDevice(app, "hand (the simulated one, the default)",
              [&options](const std::string& device) { options.device = device; });
    app.parse_complete_callback([&options, open, plant, stroke] {
        const bool real = !options.device.empty() && options.device != "hand";
        for (const CLI::Option* simulated : {open, plant, stroke})
            if (real && simulated->count() > 0)
                throw CLI::ValidationError(simulated->get_name(),
                                           "is of the simulated hand, and --device names another");
    });
    addSize(app, options.size, "Size of the picture [800x450]");
    addSettings(app, options.settings);
    addRate(app, options.rateHz, "Servo rate [1000]");
    addGpu(app, options.gpu);
}

void defineTouch(CLI::App& app, TouchOptions& options) {
    addScene(app, options.scene)->required();
    CLI::Option* path =
        app.add_option("--path", options.path, "Path of the hand: CSV with columns t,x,y,z (s, m)")
            ->type_name("HIP.csv");
    CLI::Option* stroke =
        addStroke(app, options.stroke, "In place of a path: a stroke (listed at the end of --help)")
            ->excludes(path);
    app.add_option("--seconds", options.seconds, "How long it strokes [once round]")
        ->type_name("S")
        ->check(CLI::Range(0.01, 86400.0))
        ->needs(stroke);
    for (const char* of : {"--stroke-speed", "--stroke-depth"})
        app.get_option(of)->needs(stroke);
    app.parse_complete_callback([path, stroke] {
        if (path->count() == 0 && stroke->count() == 0)
            throw CLI::RequiredError("--path or --stroke");
    });
    app.add_option("--out", options.out, "Every tick: CSV")->type_name("TICKS.csv")->required();
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
    addSettings(app, options.settings);
    addRate(app, options.rateHz,
            "Resample the path at this rate; without it one tick a row (1000 for a stroke)");
}

void defineReplay(CLI::App& app, ReplayOptions& options) {
    app.add_option("FILE", options.recording,
                   "A recording: of --record, of the window's button, or of the flight recorder")
        ->type_name("")
        ->required();
    app.add_option("--out", options.out, "Every tick as it came out now: CSV")->type_name("TICKS.csv");
    app.add_option("--json", options.json, "Write the answer here, as JSON")->type_name("FILE");
    app.add_option("--scene", options.scenes,
                   "Touch this model in place of the recorded one; may be given again for the next one")
        ->type_name("SCENE")
        ->expected(1)
        ->take_all();
}

void defineEdit(CLI::App& app, EditOptions& options) {
    addScene(app, options.scene)->required();
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
            return name == "shader" ? std::string() : hapticFieldProblem(name);
        });
    addAssignments(app, "--field", "Set a field (listed at the end of --help); may be given again",
                   [&options](std::string_view name, std::string_view value) {
                       options.fields.emplace_back(name, value);
                       return hapticFieldProblem(name);
                   });
    app.add_option("--out", options.out, "Save here; without it into the model's own file")
        ->type_name("FILE");
}

void defineRender(CLI::App& app, RenderOptions& options) {
    addScene(app, options.scene)->required();
    app.add_option("--out", options.out, "The picture, as PNG")->type_name("FILE")->required();
    addSize(app, options.size, "Size of the picture [1280x720]");
    std::vector<std::string> views;
    for (const std::string_view name : kViewModeNames)
        views.emplace_back(name);
    app.add_option("--view", options.view, "What is shown: the look, or a map of what is felt [shaded]")
        ->type_name("NAME")
        ->check(CLI::IsMember(views));
    addGpu(app, options.gpu);
}

void defineInspect(CLI::App& app, InspectOptions& options) {
    addScene(app, options.scene)->required();
    app.add_option("--json", options.json, "Write the answer here, as JSON")->type_name("FILE");
}

void defineBench(CLI::App& app, BenchOptions& options) {
    app.add_option(
           "WHAT", options.what,
           "fast: the bounds of a tick in rays; growth: its time over the number of triangles; moving: "
           "a thousand objects that move, and objects that close on the hand; all without it")
        ->type_name("")
        ->check(CLI::IsMember({"fast", "growth", "moving"}));
    app.add_option("--json", options.json, "Write the figures here")->type_name("FILE");
    app.add_option("--largest", options.largestTriangles,
                   "Leave out what has more triangles [1000000]; 10000000 takes 2.5 GB and half a minute")
        ->type_name("N");
    app.add_option("--rounds", options.rounds, "Turns of 1000 ticks for each case [20]")
        ->type_name("N")
        ->check(CLI::Range(1, 10000));
    app.add_flag("--check", options.check, "Exit status 1 where a bound is missed");
}

/// "2/8"
void parseShard(const std::string& text, StudyCommandOptions& options) {
    const size_t slash = text.find('/');
    int shard = 0, shards = 0;
    const auto whole = [](std::string_view part, int& number) {
        const auto read = std::from_chars(part.data(), part.data() + part.size(), number);
        return read.ec == std::errc{} && read.ptr == part.data() + part.size();
    };
    if (slash == std::string::npos || !whole(std::string_view(text).substr(0, slash), shard) ||
        !whole(std::string_view(text).substr(slash + 1), shards) || shard < 1 || shard > shards)
        throw CLI::ValidationError("--shard", "'" + text + "' is no share; write I/N, I from 1 to N");
    options.shard = shard;
    options.shards = shards;
}

void defineStudy(CLI::App& app, StudyCommandOptions& options) {
    app.add_option(
           "WHAT", options.what,
           "Shapes (plane, relief, sphere, cylinder, torus, waves, wedge), glTF files, folders of them "
           "and `rate`, the servo's; without any, every shape and the rate")
        ->type_name("");
    app.add_option("--out", options.out, "Folder for study.csv, study.json and plots/")->type_name("DIR");
    app.add_option("--ladder", options.ladders, "Climb this ladder alone (see --list); may be given again")
        ->type_name("NAME")
        ->expected(1)
        ->take_all();
    app.add_option("--rounds", options.rounds, "Turns that every rung takes [150]")
        ->type_name("N")
        ->check(CLI::Range(2, 10000));
    app.add_flag("--quick", options.quick, "A rougher answer in less time");
    app.add_flag("--list", options.list, "Print the ladders and shapes");
    app.add_option_function<std::string>(
           "--shard", [&options](const std::string& text) { parseShard(text, options); },
           "Study every N-th of what is asked for only, from the I-th, and leave plots to `study merge`: for "
           "GNU parallel and job arrays")
        ->type_name("I/N");
    app.parse_complete_callback([&app, &options] {
        if (options.out.empty() && !options.list && app.get_subcommands().empty())
            throw CLI::RequiredError("--out");
    });
}

void defineCompare(CLI::App& app, StudyCompareOptions& options) {
    app.add_option("A", options.first, "study.json of one run")->type_name("")->required();
    app.add_option("B", options.second, "study.json of another")->type_name("")->required();
}

void defineMerge(CLI::App& app, StudyMergeOptions& options) {
    app.add_option("PART", options.parts, "Folders that `study --shard` wrote (or study.json files)")
        ->type_name("")
        ->required();
    app.add_option("--out", options.out, "Folder for the whole study and its plots")
        ->type_name("DIR")
        ->required();
}

std::string asTyped(int argc, char** argv) {
    std::string text = "touchstone";
    for (int i = 1; i < argc; ++i)
        text += std::string(" ") + argv[i];
    return text;
}

} // namespace

std::optional<Command> parseCommandLine(int argc, char** argv, int& status) {
    CLI::App app{"Touchstone: open a glTF model, see it and touch it."};
    app.name("touchstone");
    app.set_version_flag("--version", TOUCHSTONE_VERSION, "Print the version");
    app.footer(settingsHelp() + "\n" + strokesHelp() + "\n" + kExitHelp);
    app.require_subcommand(0, 1);

    WindowOptions window;
    RunOptions run;
    TouchOptions touch;
    ReplayOptions replay;
    EditOptions edit;
    RenderOptions render;
    InspectOptions inspect;
    BenchOptions bench;
    StudyCommandOptions study;
    StudyCompareOptions compare;
    StudyMergeOptions merge;
    DevicesOptions devices;
    bool headless = false;
    defineWindow(app, window);
    CLI::App* runApp =
        app.add_subcommand("run", "The same loops without a window: simulated hand, real time");
    defineRun(*runApp, run, headless);
    CLI::App* touchApp = app.add_subcommand("touch", "Touch along a path, offline and deterministic");
    defineTouch(*touchApp, touch);
    CLI::App* replayApp =
        app.add_subcommand("replay", "Touch again what was recorded, and say whether the same comes out");
    defineReplay(*replayApp, replay);
    CLI::App* editApp =
        app.add_subcommand("edit", "Change what a model's materials feel like, and nothing else in its file");
    defineEdit(*editApp, edit);
    CLI::App* renderApp = app.add_subcommand("render", "Draw a picture of a model");
    defineRender(*renderApp, render);
    CLI::App* inspectApp =
        app.add_subcommand("inspect", "What a model is, what it would feel like, and its problems");
    defineInspect(*inspectApp, inspect);
    CLI::App* benchApp = app.add_subcommand("bench", "What a tick costs against Embree's floor");
    defineBench(*benchApp, bench);
    CLI::App* studyApp =
        app.add_subcommand("study", "What accuracy costs in time: errors and times of every way to touch");
    defineStudy(*studyApp, study);
    CLI::App* compareApp = studyApp->add_subcommand(
        "compare", "Whether rungs that one run tells apart keep their order in another");
    defineCompare(*compareApp, compare);
    CLI::App* mergeApp = studyApp->add_subcommand("merge", "One study of the parts that --shard made");
    defineMerge(*mergeApp, merge);
    CLI::App* devicesApp = app.add_subcommand("devices", "What is plugged in, and a trial of one device");
    defineDevices(*devicesApp, devices);

    status = 0;
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        for (CLI::App* command : {runApp, touchApp, replayApp, editApp, renderApp, inspectApp, benchApp,
                                  compareApp, mergeApp, studyApp, devicesApp})
            if (command->parsed()) {
                // A command without --set inherits the footer of the program.
                command->footer(command == runApp || command == touchApp
                                    ? settingsHelp() + "\n" + strokesHelp() + "\n" + plantHelp()
                                : command == editApp ? hapticFieldHelp()
                                                     : kExitHelp);
                std::cout << command->help();
                return std::nullopt;
            }
        std::cout << app.help("", CLI::AppFormatMode::All);
        return std::nullopt;
    } catch (const CLI::CallForVersion&) {
        std::cout << "touchstone " TOUCHSTONE_VERSION "\n";
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        std::cerr << "touchstone: " << error.what() << "\n  remedy: touchstone --help\n";
        status = 2;
        return std::nullopt;
    }
    if (runApp->parsed())
        return run;
    if (touchApp->parsed())
        return touch;
    if (replayApp->parsed())
        return replay;
    if (editApp->parsed())
        return edit;
    if (renderApp->parsed())
        return render;
    if (inspectApp->parsed())
        return inspect;
    if (benchApp->parsed())
        return bench;
    if (compareApp->parsed())
        return compare;
    if (mergeApp->parsed())
        return merge;
    if (studyApp->parsed()) {
        study.commandLine = asTyped(argc, argv);
        return study;
    }
    if (devicesApp->parsed())
        return devices;
    return window;
}

} // namespace touchstone
