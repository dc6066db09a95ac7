#pragma once
// What `run` and the window share of recording: the options, where files go, and what a person is told.

#include "haptics/recording/servo_recorder.h"
#include "workbench/options/commands.h"

#include <nlohmann/json.hpp>

#include <functional>
#include <string>
#include <vector>

namespace touchstone {

/// Main thread; the servo outlives it.
class RecordingController {
  public:
    /// Starts what the options ask for. `tell` gets every message for a person, and so does stderr. Throws
    /// Error where `--record` cannot be done; without a flight recorder it goes on and says so.
    RecordingController(ServoLoop& servo, const RecordingOptions& options, std::string command,
                        std::function<void(const std::string&)> tell = {});

    [[nodiscard]] ServoRecorder& recorder() { return recorder_; }
    [[nodiscard]] const ServoRecorder& recorder() const { return recorder_; }
    /// After each batch of records.
    void update();
    /// After the last record.
    void finish();

    /// Starts a recording in the state folder, or ends the one that runs (the window's button).
    void toggle();
    [[nodiscard]] bool failed() const { return recorder_.failed(); }
    [[nodiscard]] nlohmann::ordered_json json() const;

  private:
    void say(const std::string& message);
    void startFlightRecorder(const RecordingOptions& options);

    ServoRecorder recorder_;
    std::string command_;
    std::function<void(const std::string&)> tell_;
    std::vector<std::string> kept_, problems_;
};

} // namespace touchstone
