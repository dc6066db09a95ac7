#pragma once
// Passes the servo's records to its recordings: the requested one and the flight recorder's.

#include "haptics/recording/edited_scene.h"
#include "haptics/recording/flight_recorder.h"
#include "haptics/recording/recording_writer.h"
#include "haptics/servo/servo_loop.h"
#include "haptics/texture/texture_copy.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// Takes every record popped from the servo, with the data that it refers to. Runs on the owner thread of the
/// ServoLoop, which must outlive it. A recording that fails ends there and keeps its contents, and
/// `takeProblem` reports why; touch continues.
class ServoRecorder {
  public:
    explicit ServoRecorder(ServoLoop& servo) : servo_(servo) {}

    /// The scene for a number from ServoLoop::offerScene. Before its first record is taken.
    void sceneOffered(uint32_t number, SceneIdentity identity) { scenes_[number] = std::move(identity); }

    /// A scene that was sculpted, before its first record is taken: `entries` go on the journal of `root`.
    void sceneSculpted(uint32_t number, uint32_t root, uint64_t hash, std::span<const SculptEntry> entries);

    /// From the next tick on. Throws Error where the file cannot be created.
    void start(const std::filesystem::path& file, const std::string& command);
    void stop();
    [[nodiscard]] bool recording() const { return writer_.has_value(); }
    [[nodiscard]] bool failed() const { return failed_; } ///< a requested recording ended early
    [[nodiscard]] double rateHz() const { return servo_.rateHz(); }
    [[nodiscard]] const std::filesystem::path& file() const { return file_; } ///< the last one
    [[nodiscard]] uint64_t ticks() const { return ticks_; }                   ///< recorded in it

    /// Throws Error where the folder cannot be used.
    void startFlightRecorder(FlightConfig config) { flight_.emplace(std::move(config)); }
    [[nodiscard]] const FlightRecorder* flightRecorder() const { return flight_ ? &*flight_ : nullptr; }
    [[nodiscard]] std::vector<KeptFlight> takeKept();

    /// Those of one tick with that of hand 0 last, as the servo gives them.
    void take(const TickRecord& record);
    /// The persistent textures before the record that was taken last; null: the scene has none, or they have
    /// been lost since no record was taken for long.
    [[nodiscard]] const PersistentTextures* textures() const { return textures_.state(); }
    /// Scenes that are known: those that records to come may name.
    [[nodiscard]] size_t scenes() const { return scenes_.size() + journals_.size() + sculpted_.size(); }
    /// After each batch: passes all data to the system.
    void flush();
    /// After the last record.
    void finish();

    /// Why a recording ended early; empty: it did not. Reported once.
    [[nodiscard]] std::string takeProblem() { return std::exchange(problem_, {}); }

  private:
    template <class Action>
    void guarded(const Action& action, bool flight);
    void forgetBefore(const TickRecord& record);

    ServoLoop& servo_;
    std::map<uint32_t, SceneIdentity> scenes_;              // by root
    std::map<uint32_t, EditedScene> sculpted_;              // that a record may still name
    std::map<uint32_t, std::vector<SculptEntry>> journals_; // by root
    std::optional<RecordingWriter> writer_;
    std::optional<FlightRecorder> flight_;
    std::filesystem::path file_;
    uint64_t ticks_ = 0, nextStep_ = 0;
    std::vector<HandToRecord> others_; // of the next tick
    TextureCopy textures_;
    std::vector<std::byte> bodies_; // the state that was popped last
    uint64_t bodiesTick_ = 0, lastTick_ = 0;
    std::string problem_;
    bool failed_ = false;
};

} // namespace touchstone
