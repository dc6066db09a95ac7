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

/// The touch of the window: the hand that is held, the servo, what records it, lets it be heard and compares
/// it with the most exact way, and the model that all of them have. Main thread; the ticks are the servo's
/// own.
class LiveTouch {
  public:
    /// `tell` gets what a person is to know of recordings. Errors as RecordingController. The servo stands
    /// still until `start`.
    LiveTouch(const WindowOptions& options, std::function<void(const std::string&)> tell);
    /// Ends what is recorded as it should.
    ~LiveTouch();
    LiveTouch(const LiveTouch&) = delete;
    LiveTouch& operator=(const LiveTouch&) = delete;
    void start() { servo_.start(); }

    [[nodiscard]] bool hasModel() const { return shown_.model.scene != nullptr; }
    [[nodiscard]] const LoadedModel& shown() const { return shown_; } ///< empty before the first model
    /// Touches another model, within the limits of the hand of now. `generated`: our own, made anew anywhere.
    void show(LoadedModel loaded, bool generated);
    /// Goes on with other materials of the same model; touch goes on where it may.
    void change(const MadeMaterials& made);
    /// Whether the touch of the model began again since the last call: it was opened, or its geometry was
    /// built again, or another device limits it.
    [[nodiscard]] bool takeBuiltAgain() { return std::exchange(builtAgain_, false); }
    /// The model's file has been written, with these edits in it.
    void saved(const std::filesystem::path& path, const FileStamp& stamp, std::string edits);

    /// In every frame: takes what the servo has made. `now`: s, any steady clock.
    void update(double now);
    /// In every frame: what holds from the next tick on.
    void send(const HapticSettings& settings);
    /// In every frame: builds on a worker what the settings call for. Throws what stopped that, once.
    void prepare(const HapticSettings& settings);
    /// In every frame: takes up the device that was chosen (HeldDevice). False where there is not enough
    /// memory for its limits; then `choice` is empty and nothing is held.
    [[nodiscard]] bool hold(std::string& choice);
    /// In every frame: lays the simulated hand's stroke where the hand was last. `facing`: unit vector
    /// towards the eye, workspace.
    void layStroke(const StrokeRequest& stroke, const glm::dvec3& facing, bool simulated);

    /// Of the hand that is held or will be next.
    [[nodiscard]] DeviceLimits limits() const { return held_.limits(); }
    /// What lies on a ray of the workspace now.
    [[nodiscard]] std::optional<PointedSurface> look(const Ray& ray, const HapticSettings& settings) {
        return picker_.look(ray, tick().time, settings);
    }
    [[nodiscard]] const TickRecord& tick() const { return servo_.snapshot(); } ///< the newest at `update`
    [[nodiscard]] ForceSwitch& forceSwitch() { return servo_.forceSwitch(); }
    /// CLOCK_MONOTONIC, s, at which the time of the ticks is 0.
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
    uint32_t offered_ = 0;               // number of the newest scene
    std::optional<HapticSettings> sent_; // to the servo
    BackgroundBuild build_;
    Picker picker_;
    StrokeController strokes_;
};

} // namespace touchstone
