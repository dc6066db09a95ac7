#pragma once

#include "workbench/timeline/background_job.h"

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace touchstone {

/// What a list says of a recording.
struct RecordingFacts {
    std::filesystem::path file;
    std::string date;         ///< "2026-03-01 14:05", local time; of the file where the recording says none
    std::string model;        ///< "doughnut.glb"; empty: none was touched
    std::string madeBy;       ///< "window", "run", "touch", "flight recorder of window"
    double seconds = 0.0;     ///< its length, from its ticks; where it was cut off, from its size
    bool wholeLength = false; ///< it ended as it should
    std::string problem;      ///< why it cannot be opened; empty: it can
    std::filesystem::file_time_type changed;
    uint64_t bytes = 0;
};

/// Reads the first chunks and the last one. Any thread; does not throw.
[[nodiscard]] RecordingFacts recordingFacts(const std::filesystem::path& file);

/// Those of `folders`, newest first, at most `most`; `known` are not read again where they have not changed.
/// A folder that is not there has none. What a flight recorder is writing (live-*) is left out.
[[nodiscard]] std::vector<RecordingFacts> recordingsIn(const std::vector<std::filesystem::path>& folders,
                                                       const std::vector<RecordingFacts>& known, size_t most);

/// Kept up to date on a worker while somebody looks. Main thread.
class RecordingList {
  public:
    explicit RecordingList(std::vector<std::filesystem::path> folders) : folders_(std::move(folders)) {}

    /// Once a frame while the list is shown. `now`: s, any steady clock.
    void update(double now);
    [[nodiscard]] const std::vector<RecordingFacts>& recordings() const { return recordings_; }
    [[nodiscard]] bool read() const { return read_; } ///< the list has been made once

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
