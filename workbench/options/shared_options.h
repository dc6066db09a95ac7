#pragma once
// Options shared by several commands. All throw CLI::ValidationError during parsing for an invalid value;
// their targets outlive the parsing.

#include "workbench/options/commands.h"

#include <CLI/CLI.hpp>
#include <glm/glm.hpp>

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace touchstone {

/// "0.1,-2,3": three finite numbers; empty where the text is something else.
[[nodiscard]] std::optional<glm::dvec3> vectorOf(std::string_view text);

/// Help footers: all settings, parameters of the simulated device and hand, strokes, exit status.
[[nodiscard]] std::string settingsHelp();
[[nodiscard]] std::string plantHelp();
[[nodiscard]] std::string strokesHelp();
inline constexpr const char* kExitHelp =
    "Exit status: 0 done, 1 bad input or a missing facility, 2 wrong usage.\n";

/// A size, WxH pixels.
void addSize(CLI::App& app, const std::string& option, glm::ivec2& size, const std::string& meaning);
/// One that has no value where none is given.
void addSize(CLI::App& app, const std::string& option, std::optional<glm::ivec2>& size,
             const std::string& meaning);
/// A picture to write, with an ending that names its format.
CLI::Option* addPicture(CLI::App& app, const std::string& option, std::filesystem::path& file,
                        const std::string& meaning);
/// --camera, --from, --camera-position, --look-at, --up and --fov. Sets the app's parse_complete_callback.
void addCamera(CLI::App& app, CameraOptions& camera);
/// --hide, --isolate and --clip.
void addPart(CLI::App& app, PartNames& part);
/// A repeatable option NAME=VALUE; `assign` returns the problem.
CLI::Option* addAssignments(CLI::App& app, const std::string& option, const std::string& meaning,
                            std::function<std::string(std::string_view, std::string_view)> assign);
/// --set, repeatable.
void addSettings(CLI::App& app, std::function<std::string(std::string_view, std::string_view)> assign);
void addSettings(CLI::App& app, HapticSettings& settings);
/// --plant, --stroke with its speed and depth, --workspace-scale, --rate, --gpu, --record and related
/// options, SCENE.
CLI::Option* addPlant(CLI::App& app, PlantParameters& plant);
CLI::Option* addStroke(CLI::App& app, StrokeRequest& stroke, const std::string& meaning);
/// --seconds, and what else has no meaning without a stroke.
void addStrokeSeconds(CLI::App& app, double& seconds, CLI::Option* stroke);
void addZoom(CLI::App& app, double& zoom);
void addRate(CLI::App& app, double& rate, const std::string& meaning);
void addGpu(CLI::App& app, std::string& gpu);
void addEnvironment(CLI::App& app, std::filesystem::path& file);
void addRecording(CLI::App& app, RecordingOptions& options);
/// --iso, of volumes.
void addIso(CLI::App& app, std::optional<double>& iso);
/// --animation, of models that have some.
void addAnimation(CLI::App& app, std::optional<std::string>& animation);
/// --loose.
void addLoose(CLI::App& app, bool& loose);
CLI::Option* addScene(CLI::App& app, std::filesystem::path& scene);
/// --device, once per hand; `builtIn`: names accepted besides devices.
void addDevices(CLI::App& app, const std::string& builtIn,
                const std::function<void(const std::vector<std::string>&)>& take);

} // namespace touchstone
