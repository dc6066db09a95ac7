#pragma once

#include "workbench/timeline/background_job.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace touchstone {

/// List entry of a recording.
struct RecordingFacts {
    std::filesystem::path file;
    std::string date;         ///< "2026-03-01 14:05", local time; the file's where the recording has none
    std::string model;        ///< "doughnut.glb"; empty: no model
    std::string madeBy;       ///< "window", "run", "touch", "flight recorder of window"
    std::string reason;       ///< why the flight recorder kept it: "the force was not finite"; else empty
    double seconds = 0.0;     ///< its length, from its ticks; of a truncated file, from its size
    bool wholeLength = false; ///< not truncated
    std::string problem;      ///< why it cannot be opened; empty: no problem
    std::filesystem::file_time_type changed;
    uint64_t bytes = 0;
};

/// Reads the first chunks and the last one; of what a flight recorder kept, all of them, for the reason. Any
/// thread; does not throw.
[[nodiscard]] RecordingFacts recordingFacts(const std::filesystem::path& file);

/// Recordings in `folders`, newest first, at most `most`; unchanged entries of `known` are not read again. A
/// missing folder is empty. Files that a flight recorder is writing (live-*) are skipped.
[[nodiscard]] std::vector<RecordingFacts> recordingsIn(const std::vector<std::filesystem::path>& folders,
                                                       const std::vector<RecordingFacts>& known, size_t most);

/// Updated on a worker while it is shown. Main thread.
class RecordingList {
  public:
    explicit RecordingList(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

    /// Every frame in which the list is shown. `now`: s, any steady clock.
    void update(double now);
    [[nodiscard]] const std::vector<RecordingFacts>& recordings() const { return recordings_; }
    [[nodiscard]] bool read() const { return read_; } ///< the list has been read once
    /// A file of the list has another name, or (empty) is deleted: shown at once, without reading.
    void moved(const std::filesystem::path& file, const std::filesystem::path& renamed);

  private:
    static constexpr double kRenewal = 2.0; // s
    static constexpr size_t kMax = 200;

    std::vector<std::filesystem::path> folders_;
    std::vector<RecordingFacts> recordings_;
    BackgroundJob<std::vector<RecordingFacts>> job_;
    double last_ = -kRenewal;
    bool read_ = false;
};

} // namespace touchstone
