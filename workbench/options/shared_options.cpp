#include "workbench/options/shared_options.h"

#include "devices/device/workspace_map.h"
#include "haptics/servo/servo_loop.h"

#include <algorithm>
#include <charconv>
#include <iomanip>
#include <sstream>
#include <vector>

namespace touchstone {

namespace {

constexpr int kMaxPixels = 16384;

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
        std::max(parsed.x, parsed.y) > kMaxPixels)
        return false;
    size = parsed;
    return true;
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

void addSize(CLI::App& app, glm::ivec2& size, const std::string& meaning) {
    app.add_option_function<std::string>(
           "--size",
           [&size](const std::string& text) {
               if (!parseSize(text, size))
                   throw CLI::ValidationError("--size", "'" + text +
                                                            "' is not a size; write WIDTHxHEIGHT, 1.." +
                                                            std::to_string(kMaxPixels) + " pixels each");
           },
           meaning)
        ->type_name("WxH");
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
                          "--help); may be given again",
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
        ->check(CLI::Range(kMinZoom, kMaxZoom));
}

void addRate(CLI::App& app, double& rate, const std::string& meaning) {
    app.add_option("--rate", rate, meaning)->type_name("HZ")->check(CLI::Range(kMinServoRate, kMaxServoRate));
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
        ->check(CLI::Range(1.0, 600.0));
}

CLI::Option* addScene(CLI::App& app, std::filesystem::path& scene) {
    return app.add_option("SCENE", scene, "glTF model: a .gltf or .glb file")->type_name("");
}

void addDevice(CLI::App& app, const std::string& builtIn,
               const std::function<void(const std::string&)>& take) {
    std::string help = kDeviceHelp;
    help.replace(help.find('%'), 1, builtIn);
    app.add_option_function<std::string>("--device", take, help)->type_name("DEVICE");
}

void addDevices(CLI::App& app, const std::string& builtIn, std::vector<std::string>& devices) {
    std::string help = kDeviceHelp;
    help.replace(help.find('%'), 1, builtIn);
    help += "; repeat the option for each further hand";
    app.add_option("--device", devices, help)->type_name("DEVICE")->expected(1)->take_all();
}

} // namespace touchstone
