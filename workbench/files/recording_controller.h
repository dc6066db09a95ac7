#pragma once
// Shared by `run` and the window: options of recording, file locations, and messages.

#include "haptics/recording/servo_recorder.h"
#include "session/tick_subscriber.h"
#include "workbench/options/commands.h"

#include <nlohmann/json_fwd.hpp>

#include <functional>
#include <string>
#include <vector>

namespace touchstone {

/// Records the ticks of a session. Main thread; the servo outlives it.
class RecordingController final : public TickSubscriber {
  public:
    /// Starts the requested recordings. `tell` and stderr get every message for the user. Throws Error where
    /// `--record` fails; a failed flight recorder is only reported.
    RecordingController(ServoLoop& servo, const RecordingOptions& options, std::string command,
                        std::function<void(const std::string&)> tell = {});

    [[nodiscard]] ServoRecorder& recorder() { return recorder_; }
    [[nodiscard]] const ServoRecorder& recorder() const { return recorder_; }
    void sceneOffered(const OfferedScene& scene) override {
        recorder_.sceneOffered(scene.number, scene.identity);
    }
    void sceneSculpted(const SculptedScene& scene) override {
        recorder_.sceneSculpted(scene.number, scene.root, scene.hash, scene.entries);
    }
    void take(const TickRecord& record, const HapticSettings&) override { recorder_.take(record); }
    void flush(double) override { update(); }
    /// After the last record.
    void finish();

    /// Starts a recording in the state folder, or ends the running one (the window's button).
    void toggle();
    [[nodiscard]] bool failed() const { return recorder_.failed(); }
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    void update();
    void say(const std::string& message);
    void startFlightRecorder(const RecordingOptions& options);

    ServoRecorder recorder_;
    std::string command_;
    std::function<void(const std::string&)> tell_;
    std::vector<std::string> kept_, problems_;
};

} // namespace touchstone
