#pragma once

#include "engine/scene/scene.h"
#include "haptics/servo/servo_loop.h"
#include "study/live/live_error.h"
#include "workbench/editor/live_materials.h"
#include "workbench/files/recording_controller.h"
#include "workbench/hand/device_multiplexer.h"
#include "workbench/hand/held_device.h"
#include "workbench/hand/picker.h"
#include "workbench/hand/stroke_controller.h"
#include "workbench/model/background_build.h"
#include "workbench/model/model_loader.h"
#include "workbench/options/commands.h"
#include "workbench/readings/force_history.h"
#include "workbench/readings/servo_view.h"
#include "workbench/sound/sound_controller.h"
#include "workbench/timeline/playback_device.h"

#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace touchstone {

/// The window's touch: the hand in use, the servo, its recorder, sound and live error, and the model that
/// they share. Main thread; the servo runs the ticks.
class LiveTouch {
  public:
    /// `tell` receives messages about recordings for the user. Throws as RecordingController. The servo does
    /// not run until `start`.
    LiveTouch(const WindowOptions& options, std::function<void(const std::string&)> tell);
    /// Ends a running recording properly.
    ~LiveTouch();
    LiveTouch(const LiveTouch&) = delete;
    LiveTouch& operator=(const LiveTouch&) = delete;
    void start() { servo_.start(); }

    [[nodiscard]] bool hasModel() const { return shown_.model.scene != nullptr; }
    [[nodiscard]] const LoadedModel& shown() const { return shown_; } ///< empty before the first model
    /// Touches another model, with the limits of the current hand. `generated`: a procedural scene of ours,
    /// which can be regenerated anywhere.
    void show(LoadedModel loaded, bool generated);
    /// Continues with other materials of the same model; contact is kept where possible.
    void change(const MadeMaterials& made);
    /// True if touch was reset since the last call: a model was opened, its geometry was rebuilt, or another
    /// device limits it.
    [[nodiscard]] bool takeBuiltAgain() { return std::exchange(builtAgain_, false); }
    /// The model's file has been written with these edits.
    void saved(const std::filesystem::path& path, const FileStamp& stamp, std::string edits);

    /// Every frame: takes the servo's new ticks. `now`: s, any steady clock.
    void update(double now);
    /// Every frame: sends the settings for the next tick.
    void send(const HapticSettings& settings);
    /// Every frame: builds on a worker what the settings require. Throws an error of the worker once.
    void prepare(const HapticSettings& settings);
    /// Every frame: takes up the chosen device (HeldDevice). False where memory is too short for its limits;
    /// then `choice` is empty and nothing is held.
    [[nodiscard]] bool hold(std::string& choice);
    /// Every frame: lays the simulated hand's stroke at the hand's last position. `facing`: unit vector
    /// towards the eye, workspace.
    void layStroke(const StrokeRequest& stroke, const glm::dvec3& facing, bool simulated);

    /// Of the current or next hand.
    [[nodiscard]] DeviceLimits limits() const { return held_.limits(); }
    /// The first surface on a ray of the workspace now.
    [[nodiscard]] std::optional<PointedSurface> look(const Ray& ray, const HapticSettings& settings) {
        return picker_.look(ray, tick().time, settings);
    }
    [[nodiscard]] const TickRecord& tick() const { return servo_.snapshot(); } ///< the latest at `update`
    [[nodiscard]] ForceSwitch& forceSwitch() { return servo_.forceSwitch(); }
    /// CLOCK_MONOTONIC, s, at time 0 of the ticks.
    [[nodiscard]] double startedAt() const { return 1e-9 * static_cast<double>(servo_.startedNs()); }
    [[nodiscard]] double rateHz() const { return servo_.rateHz(); }
    [[nodiscard]] const ServoView& figures() const { return servoView_; }
    [[nodiscard]] const ForceHistory& forces() const { return forces_; }
    [[nodiscard]] DeviceMultiplexer& hand() { return hand_; }
    [[nodiscard]] DeviceMenu& devices() { return held_.menu(); }
    [[nodiscard]] PlaybackDevice& again() { return again_; }
    [[nodiscard]] SoundController& sound() { return sound_; }
    [[nodiscard]] RecordingController& recording() { return controller_; }
    [[nodiscard]] std::string strokeNotice() const { return strokes_.notice(); }

  private:
    [[nodiscard]] std::shared_ptr<HapticScene> limited(const HapticScene& scene) const;
    void offerScene(SceneSwap swap = SceneSwap::Anew);

    DeviceMultiplexer hand_;
    HeldDevice held_{hand_};
    PlaybackDevice again_{hand_};
    SoundController sound_{again_};
    ServoLoop servo_;
    RecordingController controller_;
    study::LiveError liveError_;
    ServoView servoView_;
    ForceHistory forces_;
    LoadedModel shown_;
    bool builtAgain_ = false;
    uint32_t offered_ = 0;               // number of the latest scene
    std::optional<HapticSettings> sent_; // to the servo
    BackgroundBuild build_;
    Picker picker_;
    StrokeController strokes_;
};

} // namespace touchstone
