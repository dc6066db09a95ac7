#pragma once
// From the servo to its recordings: the one that was asked for and the flight recorder's.

#include "haptics/recording/flight_recorder.h"
#include "haptics/recording/recording_writer.h"
#include "haptics/servo/servo_loop.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace touchstone {

/// Takes every record that was popped from the servo, with what it refers to. The owner's thread of the
/// ServoLoop, which must outlive it. A recording that fails ends there, keeps what it has, and is told by
/// `takeProblem`; touch goes on.
class ServoRecorder {
  public:
    explicit ServoRecorder(ServoLoop& servo) : servo_(servo) {}

    /// What ServoLoop::offerScene's number stands for. Before its first record is taken.
    void sceneOffered(uint32_t number, SceneIdentity identity) { scenes_[number] = std::move(identity); }

    /// From the next tick on. Throws Error where the file cannot be made.
    void start(const std::filesystem::path& file, const std::string& command);
    void stop();
    [[nodiscard]] bool recording() const { return writer_.has_value(); }
    [[nodiscard]] bool failed() const { return failed_; } ///< a recording that was asked for ended early
    [[nodiscard]] double rateHz() const { return servo_.rateHz(); }
    [[nodiscard]] const std::filesystem::path& file() const { return file_; } ///< the last one
    [[nodiscard]] uint64_t ticks() const { return ticks_; }                   ///< recorded in it

    /// Throws Error where the folder cannot be used.
    void startFlightRecorder(FlightConfig config) { flight_.emplace(std::move(config)); }
    [[nodiscard]] const FlightRecorder* flightRecorder() const { return flight_ ? &*flight_ : nullptr; }
    [[nodiscard]] std::vector<KeptFlight> takeKept();

    void take(const TickRecord& record);
    /// After each batch: the system has all of it.
    void flush();
    /// After the last record.
    void finish();

    /// Why a recording ended early; empty: it did not. Told once.
    [[nodiscard]] std::string takeProblem() { return std::exchange(problem_, {}); }

  private:
    template <class Action>
    void guarded(const Action& action, bool flight);

    ServoLoop& servo_;
    std::map<uint32_t, SceneIdentity> scenes_;
    std::optional<RecordingWriter> writer_;
    std::optional<FlightRecorder> flight_;
    std::filesystem::path file_;
    uint64_t ticks_ = 0, nextStep_ = 0;
    std::string problem_;
    bool failed_ = false;
};

} // namespace touchstone
