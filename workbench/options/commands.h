#pragma once
// The commands of the command line, one struct and one function each. The functions return the exit status
// and throw Error for bad input (status 1).

#include "devices/plant/plant_parameters.h"
#include "devices/stroke/stroke_library.h"
#include "engine/scene/scene_part.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/shape/field/sculpt/live_tool.h"
#include "renderer/camera.h"

#include <glm/glm.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

/// Recording options of `run` and the window.
struct RecordingOptions {
    std::filesystem::path record;       ///< from the start; empty: not requested
    bool flight = true;                 ///< with a flight recorder
    std::filesystem::path flightFolder; ///< empty: in the state folder
    double flightSeconds = 10.0;
};

/// touchstone [SCENE]
struct WindowOptions {
    std::filesystem::path scene; ///< empty: the default scene
    /// NAME and VALUE of settings (setSetting), in order, applied over those of the last run; valid ones.
    std::vector<std::pair<std::string, std::string>> settings;
    double rateHz = 1000.0;
    bool sound = false;         ///< start with sound, whatever the last run used
    bool simulatedHand = false; ///< start with the simulated hand instead of the mouse
    StrokeRequest stroke;       ///< of the simulated hand
    double zoom = 1.0;          ///< workspace metres for one metre of a device or the simulated hand
    std::string device;         ///< start with this device (devices/choice/device_choice.h); empty: none
    std::vector<std::string> otherDevices; ///< of the hands beside the first: devices, or "hand"
    std::optional<glm::ivec2> size;        ///< screen coordinates; none: that of the last run, or 1280x800
    float uiScale = 0.0f;             ///< beside the monitor's (figures/ui_scale.h); 0: that of the last run
    glm::ivec2 pictureSize{0};        ///< pixels of saved pictures; 0: as large as the window shows the model
    std::filesystem::path statusJson; ///< written after each picture if given
    RecordingOptions recording;
    std::filesystem::path
        environment;           ///< a panorama that lights the picture; empty: the closed-form surroundings
    std::string gpu;           ///< part of a Vulkan device's name
    std::optional<double> iso; ///< of a volume: the value at its surface; none: Volume::defaultIso
    std::optional<std::string> animation; ///< LoadOptions::animation
    PartNames part;                       ///< of the first model
    bool loose = false;                   ///< every object is a body (loosen)
};
int windowCommand(const WindowOptions& options);

/// The tool of the simulated hands.
struct SculptOptions {
    bool wanted = false;
    LiveTool tool;                            ///< without its objects
    std::string stamp;                        ///< an object of the scene
    std::vector<std::filesystem::path> files; ///< .glb and .vdb of the sculpted object, at the end
};

/// touchstone run SCENE
struct RunOptions {
    std::filesystem::path scene;
    HapticSettings settings;
    double rateHz = 1000.0;
    double seconds = 10.0;
    glm::ivec2 size{800, 450};
    /// The hands, kMaxHands at most: each a simulated one ("hand") or a device of
    /// devices/choice/device_choice.h.
    std::vector<std::string> devices{"hand"};
    std::filesystem::path json, screenshot;         ///< empty: not requested
    std::vector<std::filesystem::path> recordTicks; ///< one per hand, or fewer
    bool pad = false; ///< with the contact location on the finger's pad in recordTicks
    RecordingOptions recording;
    StrokeRequest stroke;              ///< of the simulated hands
    double zoom = 1.0;                 ///< workspace metres for one metre of the hands
    bool openLoop = false;             ///< the hand follows its path whatever the force
    PlantParameters plant;             ///< in the closed loop
    std::filesystem::path environment; ///< as in the window
    std::string gpu;
    std::optional<double> iso;            ///< of a volume: the value at its surface; none: Volume::defaultIso
    std::optional<std::string> animation; ///< LoadOptions::animation
    PartNames part;                       ///< what is seen and felt
    bool loose = false;                   ///< every object is a body (loosen)
    SculptOptions sculpt;
};
int runCommand(const RunOptions& options);

/// touchstone touch SCENE --path HIP.csv|--stroke NAME --out TICKS.csv
struct TouchOptions {
    std::filesystem::path scene, out;
    bool pad = false;             ///< with the contact location on the finger's pad in `out`
    std::filesystem::path path;   ///< empty: the stroke
    StrokeRequest stroke;         ///< instead of a path
    double seconds = 0.0;         ///< of the stroke; 0: one period
    std::filesystem::path json;   ///< empty: not requested
    std::filesystem::path record; ///< empty: not requested
    std::filesystem::path sound;  ///< WAV; empty: not requested
    Fit fit = Fit::None;
    HapticSettings settings;
    double rateHz = 0.0;       ///< 0: one tick per row of the path
    bool closedLoop = false;   ///< the path is the hand's intention; the hand is compliant and holds a device
    PlantParameters plant;     ///< in the closed loop
    std::optional<double> iso; ///< of a volume: the value at its surface; none: Volume::defaultIso
    std::optional<std::string> animation;        ///< LoadOptions::animation
    PartNames part;                              ///< what is felt
    bool loose = false;                          ///< every object is a body (loosen)
    std::filesystem::path sculpt;                ///< a journal; empty: nothing is sculpted
    std::vector<std::filesystem::path> sculpted; ///< .glb and .vdb of the sculpted object, at the end
    std::filesystem::path brushed; ///< the model with its persistent textures as touch left them; empty: not
};
int touchCommand(const TouchOptions& options);

/// touchstone replay FILE
/// Settings to compare a recording with: names and values, in order.
struct ComparedSettings {
    std::string text; ///< as typed
    std::vector<std::pair<std::string, std::string>> settings;
};
struct ReplayOptions {
    std::filesystem::path recording;
    std::filesystem::path out, json;           ///< empty: not requested
    std::vector<ComparedSettings> compare;     ///< each beside the recorded ones
    std::filesystem::path compareOut;          ///< CSV of forces and proxies; empty: not requested
    std::filesystem::path plot;                ///< figure, .svg or .png; empty: not requested
    std::vector<std::filesystem::path> scenes; ///< instead of the recorded ones, in their order
};
/// Status 1 where a tick differs or the file is damaged.
int replayCommand(const ReplayOptions& options);

/// touchstone edit SCENE
struct EditOptions {
    std::filesystem::path scene;
    std::filesystem::path out;          ///< empty: the scene's own file
    std::vector<std::string> materials; ///< names or indices, or "all"; empty: the only one
    std::string preset;                 ///< workbench/editor/presets.h; empty: none
    bool reset = false;                 ///< first removes everything that the file states
    std::vector<std::string> resetFields;
    std::vector<std::pair<std::string, std::string>> fields; ///< name and value, in order
};
int editCommand(const EditOptions& options);

/// Where `render` looks from: a camera of the file, one that is placed, or all of the model from a side.
struct CameraOptions {
    std::optional<std::string> name; ///< of the file's
    std::optional<Side> side;        ///< without one the window's first view
    /// Scene frame, m. A placed camera has a position; the target is the model's centre without one.
    std::optional<glm::dvec3> position, target, up;
    std::optional<double> fov; ///< degrees, vertical; of placed cameras and of sides
    bool orthographic = false; ///< of placed cameras and of sides: as large at the target as with `fov`
};

/// touchstone render SCENE --out F.png --size WxH
struct RenderOptions {
    double time = 0.0; ///< s, of the animation
    std::filesystem::path scene, out;
    glm::ivec2 size{1280, 720};
    std::string view = "shaded";
    CameraOptions camera;
    PartNames part; ///< what is drawn
    bool wireframe = false, grid = false;
    int sliceAxis = -1;   ///< 0, 1, 2: what is felt as a field, in a slice across it; -1: none
    double sliceAt = 0.5; ///< FieldSlice::at
    bool touched = false; ///< by `stroke`, before the picture
    StrokeRequest stroke;
    double seconds = 0.0;              ///< 0: once round
    std::filesystem::path environment; ///< as in the window
    std::string gpu;
    std::optional<double> iso;            ///< of a volume: the value at its surface; none: Volume::defaultIso
    std::optional<std::string> animation; ///< LoadOptions::animation
};
int renderCommand(const RenderOptions& options);

/// touchstone inspect SCENE
struct InspectOptions {
    std::filesystem::path scene;
    std::filesystem::path json;           ///< empty: not requested
    std::optional<double> iso;            ///< of a volume: the value at its surface; none: Volume::defaultIso
    std::optional<std::string> animation; ///< LoadOptions::animation
};
int inspectCommand(const InspectOptions& options);

/// touchstone simplify SCENE
struct SimplifyOptions {
    std::filesystem::path scene;
    double degrees = 0.0;      ///< between facets
    std::filesystem::path out; ///< .glb; empty: told alone
    std::optional<double> iso; ///< of a volume
};
int simplifyCommand(const SimplifyOptions& options);

/// touchstone bench [WHAT]
struct BenchOptions {
    std::string what;           ///< empty: all of it
    std::filesystem::path json; ///< empty: not requested
    size_t largestTriangles = 1'000'000;
    int rounds = 20;        ///< of 1000 ticks for each configuration
    bool check = false;     ///< status 1 where a bound is missed
    double seconds = 180.0; ///< protocol: of each run
    int runs = 3;           ///< protocol: of each object
};
int benchCommand(const BenchOptions& options);

/// touchstone study [NAME|FILE...] --out DIR
struct StudyCommandOptions {
    std::vector<std::string> what;      ///< shapes by name, files and folders; empty: every shape
    std::filesystem::path out;          ///< a folder
    std::vector<std::string> ablations; ///< empty: all
    int rounds = 0; ///< turns of each configuration; 0: enough for intervals of a few per cent
    bool quick = false;
    int finestVoxel = 0;       ///< of the voxel study: voxels on the diagonal; 0: 512, with `quick` 128
    bool list = false;         ///< list the ablations and shapes only
    int shard = 1, shards = 1; ///< every `shards`-th of the subjects, starting with the `shard`-th
    std::string commandLine;   ///< as typed, for the provenance
};
int studyCommand(const StudyCommandOptions& options);

/// touchstone study compare A.json B.json
struct StudyCompareOptions {
    std::filesystem::path first, second;
};
/// Status 1 where two configurations whose intervals do not overlap in the first study have changed places in
/// the second.
int studyCompare(const StudyCompareOptions& options);

/// touchstone study merge DIR... --out DIR
struct StudyMergeOptions {
    std::vector<std::filesystem::path> parts; ///< folders with a study.json, or such files
    std::filesystem::path out;                ///< a folder
};
/// Merges the shards of a study and plots the result.
int studyMerge(const StudyMergeOptions& options);

/// touchstone devices
struct DevicesOptions {
    std::string test; ///< the device to test, as in --device; empty: list all
    double seconds = 3.0;
    double force = 0.0;         ///< N, push force of the test; 0: no force is sent
    std::filesystem::path json; ///< empty: not requested
};
int devicesCommand(const DevicesOptions& options);

} // namespace touchstone
