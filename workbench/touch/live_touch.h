#pragma once

#include "engine/scene/scene.h"
#include "haptics/body/joint_settings.h"
#include "renderer/scene_renderer.h"
#include "session/session.h"
#include "workbench/editor/live_materials.h"
#include "workbench/files/recording_controller.h"
#include "workbench/hand/device_menu.h"
#include "workbench/hand/device_multiplexer.h"
#include "workbench/hand/other_hands.h"
#include "workbench/hand/picker.h"
#include "workbench/hand/stroke_controller.h"
#include "workbench/model/background_build.h"
#include "workbench/model/dented_meshes.h"
#include "workbench/model/felt_part.h"
#include "workbench/model/model_loader.h"
#include "workbench/model/shown_soft_bodies.h"
#include "workbench/model/shown_textures.h"
#include "workbench/options/commands.h"
#include "workbench/readings/failing_program.h"
#include "workbench/readings/window_readings.h"
#include "workbench/sculpt/sculpt_controller.h"
#include "workbench/sound/sound_controller.h"
#include "workbench/timeline/playback_device.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace touchstone {

/// The window's session: the hand in use, recordings, readings and sound, and the model that they share. Main
/// thread; the servo runs the ticks.
class LiveTouch {
  public:
    /// `tell` receives messages about recordings for the user. Throws as RecordingController. The servo does
    /// not run until `start`.
    LiveTouch(const WindowOptions& options, std::function<void(const std::string&)> tell);
    /// Ends a running recording properly.
    ~LiveTouch();
    LiveTouch(const LiveTouch&) = delete;
    LiveTouch& operator=(const LiveTouch&) = delete;
    void start() { session_.start(); }

    [[nodiscard]] bool hasModel() const { return shown_.model.scene != nullptr; }
    [[nodiscard]] const LoadedModel& shown() const { return shown_; } ///< empty before the first model
    /// Touches another model. `generated`: a procedural scene of ours, which can be regenerated anywhere.
    void show(LoadedModel loaded, bool generated);
    /// Continues with other materials of the same model; contact is kept where possible.
    void change(const MadeMaterials& made);
    /// The servo touches the materials of the last `change`.
    [[nodiscard]] bool feelsWhole() const { return felt_ == whole_.haptic && session_.touching(); }
    /// The open model with all its parts, for what changes it; `shown` has the part that is seen and felt.
    [[nodiscard]] const Model& whole() const { return whole_; }
    /// Every frame: the part of the model that is to be seen and felt. It is compiled on a worker, and comes
    /// into effect in `update`. Touch continues, unless what it holds on to goes, or what comes back meets or
    /// encloses the hand: then nothing is felt before the hand is clear of it. Throws Error of the worker
    /// once.
    void showPart(const ScenePart& part);
    /// True if touch was reset since the last call: a model was opened, or its geometry was rebuilt.
    [[nodiscard]] bool takeBuiltAgain() { return std::exchange(builtAgain_, false); }
    /// The model's file has been written with these edits.
    void saved(const std::filesystem::path& path, const FileStamp& stamp, std::string edits);

    /// Every frame: takes the servo's new ticks. `now`: s, any steady clock.
    void update(double now);
    /// Every frame: sends the settings for the next tick.
    void send(const HapticSettings& settings) { session_.set(settings); }
    /// Every frame: what the hand moved of the scene's controls sets `settings` (TOUCHSTONE_joint).
    void operate(HapticSettings& settings);
    /// Every frame: builds on a worker what the settings require. Throws an error of the worker once.
    void prepare(const HapticSettings& settings);
    /// Every frame: takes up the chosen device. `choice` becomes the actual choice: empty where it cannot be
    /// opened.
    void hold(std::string& choice);
    /// Every frame: lays the simulated hand's stroke at the hand's last position. `facing`: unit vector
    /// towards the eye, workspace.
    void layStroke(const StrokeRequest& stroke, const glm::dvec3& facing, bool simulated);

    /// The first surface on a ray of the workspace now.
    [[nodiscard]] std::optional<PointedSurface> look(const Ray& ray, const HapticSettings& settings) {
        return picker_.look(ray, animationTime(settings, tick().time), settings, tick().sample.limits);
    }
    /// Draws what moves where it is at `time` (s, of the servo); bodies where they are now, or where a
    /// recording of this model has them; objects where a caller moved them in that recording.
    void pose(double time, SceneRenderer& renderer, std::span<const body::Pose> recorded = {},
              std::span<const DrivenPose> moved = {});
    /// The scene has bodies; they go back to where the file puts them, and touch begins anew.
    [[nodiscard]] bool hasBodies() const { return hasModel() && shown_.model.scene->physics != nullptr; }
    void resetBodies() { offerScene(SceneSwap::Anew, false); }
    /// The node (Scene::nodes) of that surface; -1: there is none.
    [[nodiscard]] int nodeAt(const Ray& ray);
    [[nodiscard]] const TickRecord& tick() const { return session_.tick(); } ///< the latest at `update`
    [[nodiscard]] ForceSwitch& forceSwitch() { return session_.forceSwitch(); }
    /// CLOCK_MONOTONIC, s, at time 0 of the ticks.
    [[nodiscard]] double startedAt() const {
        return 1e-9 * static_cast<double>(session_.servo().startedNs());
    }
    [[nodiscard]] double rateHz() const { return session_.servo().rateHz(); }
    [[nodiscard]] const ServoView& figures() const { return readings_.servo(); }
    [[nodiscard]] const ForceHistory& forces() const { return readings_.forces(); }
    [[nodiscard]] const FailingProgram& failing() const { return failing_; }
    [[nodiscard]] DeviceMultiplexer& hand() { return hand_; }
    [[nodiscard]] OtherHands& otherHands() { return others_; }
    /// What the contact location display of the device in use shows, m; none without one.
    [[nodiscard]] std::optional<glm::dvec2> padShown() const {
        return tick().pad.limits.reach > 0.0 ? std::optional(tick().pad.location) : std::nullopt;
    }
    [[nodiscard]] DeviceMenu& devices() { return menu_; }
    [[nodiscard]] PlaybackDevice& again() { return again_; }
    [[nodiscard]] SoundController& sound() { return sound_; }
    [[nodiscard]] SculptController& sculpt() { return sculpt_; }
    [[nodiscard]] RecordingController& recording() { return controller_; }
    [[nodiscard]] std::string strokeNotice() const { return strokes_.notice(); }

  private:
    void takePart(const FeltPart& made);
    void offerScene(SceneSwap swap, bool another);
    void offerPath(const std::shared_ptr<const StrokePath>& path);
    [[nodiscard]] std::vector<DevicePort> ports();

    OtherHands others_;
    DeviceMultiplexer hand_;
    DeviceMenu menu_;
    PlaybackDevice again_{hand_};
    SoundController sound_{again_};
    Session session_;
    RecordingController controller_;
    WindowReadings readings_;
    FailingProgram failing_;
    LoadedModel shown_;
    Model whole_;
    std::shared_ptr<const HapticScene> felt_; // what the felt scene is a part of
    FeltPartBuild partBuild_;
    std::string wholeEdits_, partEdits_; // of whole_, and of the part that is being compiled
    bool builtAgain_ = false;
    bool drawnMoved_ = false; // objects are drawn where a caller moved them
    BackgroundBuild build_;
    Picker picker_;
    ShownTextures textures_;
    ShownSoftBodies soft_;
    DentedMeshes dented_;
    body::JointSettings controls_;
    SculptController sculpt_{session_, picker_};
    StrokeController strokes_;
};

} // namespace touchstone
