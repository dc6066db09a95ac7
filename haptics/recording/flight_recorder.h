#pragma once
// Records the last seconds continuously: on the disk at once, so that they outlive the process, and kept
// after a fault.

#include "haptics/recording/fault_watch.h"
#include "haptics/recording/recording_writer.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

struct FlightConfig {
    std::filesystem::path folder;          ///< created if missing
    double seconds = 10.0;                 ///< minimum length kept
    double afterwards = 1.0;               ///< s after a fault that its file contains
    double pause = 60.0;                   ///< s during which the same fault makes no second file
    size_t maxFiles = 20;                  ///< the oldest are deleted
    uint64_t maxBytes = uint64_t{1} << 28; ///< of all files together
    RecordingOrigin origin;
};

/// A recording that is kept.
struct KeptFlight {
    std::filesystem::path file;
    std::string why;
};

/// Writes the ticks into two files of `seconds` in turn, each a recording that begins with a checkpoint.
/// Every `flush` passes them to the system, so they survive a process that dies. After a fault both are
/// joined in a separate file. One thread; every function throws Error that names a file.
class FlightRecorder {
  public:
    /// Locks a session in the folder.
    explicit FlightRecorder(FlightConfig config);
    /// Ends the session; files that are not kept are deleted.
    ~FlightRecorder();
    FlightRecorder(const FlightRecorder&) = delete;
    FlightRecorder& operator=(const FlightRecorder&) = delete;

    void add(const TickToRecord& tick);
    /// Passes all data to the system; keeps a fault whose time has come.
    void flush();
    /// End of the input: pending faults are kept as they are.
    void finish();

    /// Recordings kept since the last call.
    [[nodiscard]] std::vector<KeptFlight> takeKept() { return std::exchange(kept_, {}); }
    /// Location of the last seconds if the process dies now.
    [[nodiscard]] const std::filesystem::path& session() const { return session_; }

    /// Keeps the files of sessions that did not end; the folder may be missing.
    [[nodiscard]] static std::vector<KeptFlight> recover(const FlightConfig& config);

  private:
    [[nodiscard]] std::filesystem::path segment(int index) const;
    void rotate();
    [[nodiscard]] std::optional<Fault> faultOf(const TickToRecord& tick);
    void keep();

    FlightConfig config_;
    std::filesystem::path session_; ///< without file extension
    int lock_ = -1;
    std::array<FaultWatch, kMaxHands> watches_;
    std::optional<RecordingWriter> writer_;
    int current_ = 0;
    bool previous_ = false; // the other segment holds the preceding ticks
    double recorded_ = 0.0; // s in the current segment
    double clock_ = 0.0;    // s, of all ticks
    std::optional<Fault> pending_;
    double due_ = 0.0;
    std::map<std::string, double> last_; // by fault: time of its last file
    std::vector<KeptFlight> kept_;
};

} // namespace touchstone
