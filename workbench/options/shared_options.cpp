#include "workbench/options/shared_options.h"

#include "devices/device/workspace_map.h"
#include "haptics/servo/servo_loop.h"
#include "renderer/picture_file.h"
#include "renderer/scene_camera.h"
#include "workbench/options/number_range.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <functional>
#include <iomanip>
#include <optional>
#include <sstream>
#include <system_error>
#include <vector>

namespace touchstone {

namespace {

constexpr int kMaxSide = 16384, kMaxPixels = 1 << 26;
constexpr double kLeastFov = 1.0, kMostFov = 150.0; // degrees

constexpr const char* kDeviceHelp =
    "What is held: %, auto (what is plugged in), udp[:PORT] (another program), /dev/hidrawN, a device "
    "file (.json) or a part of a name that `touchstone devices` lists";

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
        std::max(parsed.x, parsed.y) > kMaxSide || parsed.x > kMaxPixels / parsed.y)
        return false;
    size = parsed;
    return true;
}

/// A finite number; empty: the text is none.
std::optional<double> numberOf(std::string_view text) {
    double number = 0.0;
    const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (problem != std::errc{} || end != text.data() + text.size() || !std::isfinite(number))
        return std::nullopt;
    return number;
}

/// X,Y,Z
CLI::Option* addVector(CLI::App& app, const std::string& option, std::optional<glm::dvec3>& vector,
                       const std::string& meaning) {
    return app
        .add_option_function<std::string>(
            option,
            [option, &vector](const std::string& text) {
                vector = vectorOf(text);
                if (!vector)
                    throw CLI::ValidationError(option,
                                               "'" + text + "' is no place or direction; write X,Y,Z");
            },
            meaning)
        ->type_name("X,Y,Z");
}

std::vector<std::string> sideNames() {
    std::vector<std::string> names{"default"};
    names.insert(names.end(), kSideNames.begin(), kSideNames.end());
    return names;
}

/// A line a field: NAME=DEFAULT UNIT, meaning, allowed values.
template <class S>
std::string fieldLines(std::span<const StructField<S>> fields) {
    std::string text;
    for (const StructField<S>& field : fields) {
        std::string line = "  " + std::string(field.name) + "=" + writtenValue(field, field.get(S{}));
        if (!field.unit.empty())
            line += " " + std::string(field.unit);
        line.resize(std::max<size_t>(line.size() + 2, 30), ' ');
        text += line + std::string(field.meaning) + "  [" + allowedValues(field) + "]\n";
    }
    return text;
}

} // namespace

std::optional<glm::dvec3> vectorOf(std::string_view text) {
    glm::dvec3 vector(0.0);
    for (int axis = 0; axis < 3; ++axis) {
        const size_t comma = text.find(',');
        const std::optional<double> number = numberOf(text.substr(0, comma));
        if (!number || (comma == std::string_view::npos) != (axis == 2))
            return std::nullopt;
        vector[axis] = *number;
        text.remove_prefix(axis < 2 ? comma + 1 : 0);
    }
    return vector;
}

std::string settingsHelp() {
    return "Settings for --set NAME=VALUE:\n" + fieldLines(settingFields());
}

std::string plantHelp() {
    return "Simulated device and hand for --plant NAME=VALUE (a Phantom Premium 1.5 in a light grip):\n" +
           fieldLines(plantFields());
}

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

namespace {

/// `set` takes the size that was parsed.
void addSizeOption(CLI::App& app, const std::string& option,
                   const std::function<void(const glm::ivec2&)>& set, const std::string& meaning) {
    app.add_option_function<std::string>(
           option,
           [option, set](const std::string& text) {
               glm::ivec2 size{0};
               if (!parseSize(text, size))
                   throw CLI::ValidationError(option, "'" + text +
                                                          "' is not a size; write WIDTHxHEIGHT, 1.." +
                                                          std::to_string(kMaxSide) + " pixels each and " +
                                                          std::to_string(kMaxPixels) + " in all at most");
               set(size);
           },
           meaning)
        ->type_name("WxH");
}

} // namespace

void addSize(CLI::App& app, const std::string& option, glm::ivec2& size, const std::string& meaning) {
    addSizeOption(
        app, option, [&size](const glm::ivec2& given) { size = given; }, meaning);
}

void addSize(CLI::App& app, const std::string& option, std::optional<glm::ivec2>& size,
             const std::string& meaning) {
    addSizeOption(
        app, option, [&size](const glm::ivec2& given) { size = given; }, meaning);
}

CLI::Option* addPicture(CLI::App& app, const std::string& option, std::filesystem::path& file,
                        const std::string& meaning) {
    return app.add_option(option, file, meaning)->type_name("F.png|jpg")->check([](const std::string& name) {
        return pictureNameProblem(name);
    });
}

void addCamera(CLI::App& app, CameraOptions& camera) {
    CLI::Option* name =
        app.add_option("--camera", camera.name, "A camera of the file: its name, its node's, or its index")
            ->type_name("NAME");
    CLI::Option* from =
        app.add_option_function<std::string>(
               "--from",
               [&camera](const std::string& side) {
                   const auto* found = std::ranges::find(kSideNames, side);
                   camera.side = found != kSideNames.end()
                                     ? std::optional(static_cast<Side>(found - kSideNames.begin()))
                                     : std::nullopt;
               },
               "See all of the model from this side; default is the window's first view [default]")
            ->type_name("SIDE")
            ->check(CLI::IsMember(sideNames()));
    CLI::Option* position = addVector(app, "--camera-position", camera.position,
                                      "Where the camera stands, in the model's own metres and axes");
    addVector(app, "--look-at", camera.target, "What is in the middle of the picture [the model's centre]")
        ->needs(position);
    addVector(app, "--up", camera.up, "What is upwards in the picture [0,1,0]")->needs(position);
    CLI::Option* fov = app.add_option_function<std::string>(
                              "--fov",
                              [&camera](const std::string& text) {
                                  const std::optional<double> angle = numberOf(text);
                                  if (!angle || !(*angle >= kLeastFov && *angle <= kMostFov))
                                      throw CLI::ValidationError(
                                          "--fov", "'" + text + "' is no angle of view; give 1 to 150");
                                  camera.fov = angle;
                              },
                              "Vertical angle of view [35]")
                           ->type_name("DEG");
    CLI::Option* projection =
        app.add_option_function<std::string>(
               "--projection",
               [&camera](const std::string& kind) { camera.orthographic = kind == "orthographic"; },
               "Perspective, or parallel lines of sight that show as much at the target [perspective]")
            ->type_name("KIND")
            ->check(CLI::IsMember({"perspective", "orthographic"}));
    name->excludes(from)->excludes(position)->excludes(fov)->excludes(projection);
    from->excludes(position);
    app.parse_complete_callback([&camera] {
        if (!camera.target)
            return; // the model's centre, known later
        const std::string problem = sightProblem(
            *camera.position, *camera.target, camera.up.value_or(usualUp(*camera.position, *camera.target)));
        if (!problem.empty())
            throw CLI::ValidationError("--camera-position", problem);
    });
}

void addPart(CLI::App& app, PartNames& part) {
    const auto addNames = [&app](const char* option, std::vector<std::string>& names, const char* meaning) {
        app.add_option(option, names, meaning)->type_name("NAME")->expected(1)->take_all();
    };
    addNames("--hide", part.hide,
             "Neither draw nor touch this object and what is below it: the name of its node or mesh; may be "
             "given again");
    addNames("--isolate", part.isolate, "Draw and touch this object alone; may be given again");
    app.add_option_function<std::string>(
           "--clip",
           [&part](const std::string& text) {
               const size_t last = text.rfind(',');
               const std::optional<glm::dvec3> normal = vectorOf(std::string_view(text).substr(0, last));
               const std::optional<double> offset = last != std::string::npos
                                                        ? numberOf(std::string_view(text).substr(last + 1))
                                                        : std::nullopt;
               part.clip = normal && offset ? clipPlane(*normal, *offset) : std::nullopt;
               if (!part.clip)
                   throw CLI::ValidationError("--clip", "'" + text +
                                                            "' is no plane; write X,Y,Z,OFFSET with a "
                                                            "direction that is not zero");
           },
           "Neither draw nor touch what lies beyond a plane: its direction X,Y,Z, and how far along it the "
           "plane stands, in the model's own metres and axes")
        ->type_name("X,Y,Z,OFFSET");
}

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
                          "run --help); may be given again",
                          [&plant](std::string_view name, std::string_view value) {
                              return setPlantParameter(plant, name, value);
                          });
}

CLI::Option* addStroke(CLI::App& app, StrokeRequest& stroke, const std::string& meaning) {
    CLI::Option* name = app.add_option("--stroke", stroke.name, meaning)
                            ->type_name("NAME")
                            ->check([](const std::string& text) { return strokeProblem(text); });
    app.add_option("--stroke-speed", stroke.speed,
                   "How fast it goes on the surface, at its fastest [the stroke's own]")
        ->type_name("M/S")
        ->check(within(kSlowestStroke, kFastestStroke));
    app.add_option("--stroke-depth", stroke.depth, "How deep it presses [the stroke's own]")
        ->type_name("M")
        ->check(within(kShallowestStroke, kDeepestStroke));
    return name;
}

void addStrokeSeconds(CLI::App& app, double& seconds, CLI::Option* stroke) {
    app.add_option("--seconds", seconds, "How long it strokes [once round]")
        ->type_name("S")
        ->check(within(0.01, 86400.0))
        ->needs(stroke);
    for (const char* of : {"--stroke-speed", "--stroke-depth"})
        app.get_option(of)->needs(stroke);
}

void addZoom(CLI::App& app, double& zoom) {
    app.add_option(
           "--workspace-scale", zoom,
           "How far the hand goes in the model for each metre of the device, or of the simulated hand [1]")
        ->type_name("FACTOR")
        ->check(within(kMinZoom, kMaxZoom));
}

void addRate(CLI::App& app, double& rate, const std::string& meaning) {
    app.add_option("--rate", rate, meaning)->type_name("HZ")->check(within(kMinServoRate, kMaxServoRate));
}

void addGpu(CLI::App& app, std::string& gpu) {
    app.add_option("--gpu", gpu, "Vulkan device to use, by a part of its name")->type_name("NAME");
}

void addEnvironment(CLI::App& app, std::filesystem::path& file) {
    app.add_option("--environment", file, "Light the model with this panorama: OpenEXR or Radiance")
        ->type_name("F.exr|hdr");
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
        ->check(within(1.0, 600.0));
}

void addIso(CLI::App& app, std::optional<double>& iso) {
    app.add_option("--iso", iso,
                   "Of a volume: the value at its surface; inside are the higher ones [what the file states, "
                   "else Otsu's threshold]")
        ->type_name("VALUE");
}

void addAnimation(CLI::App& app, std::optional<std::string>& animation) {
    app.add_option("--animation", animation,
                   "The model's animation that plays: its name or number (`inspect` lists them) [the first "
                   "that moves something]")
        ->type_name("NAME");
}

void addLoose(CLI::App& app, bool& loose) {
    app.add_flag(
        "--loose", loose,
        "Every object of the model is a body without weight, which a hand moves and may take hold of "
        "(--set grasp=touch)");
}

CLI::Option* addScene(CLI::App& app, std::filesystem::path& scene) {
    return app
        .add_option(
            "SCENE", scene,
            "Model: a .gltf, .glb, .obj, .stl or .ply file; volume: .nrrd, .nhdr, .mhd, .mha, .nii, .nii.gz "
            "or .vdb")
        ->type_name("");
}

void addDevices(CLI::App& app, const std::string& builtIn,
                const std::function<void(const std::vector<std::string>&)>& take) {
    std::string help = kDeviceHelp;
    help.replace(help.find('%'), 1, builtIn);
    help += "; repeat the option for each further hand";
    app.add_option_function<std::vector<std::string>>("--device", take, help)
        ->type_name("DEVICE")
        ->expected(1)
        ->take_all();
}

} // namespace touchstone
