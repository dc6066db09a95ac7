#pragma once
// The last seconds, always: on the disk while they happen, so that they outlive the process, and kept where
// something went wrong.

#include "haptics/recording/fault_watch.h"
#include "haptics/recording/recording_writer.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

struct FlightConfig {
    std::filesystem::path folder;          ///< made where it is not there
    double seconds = 10.0;                 ///< that are kept at least
    double afterwards = 1.0;               ///< s that follow a fault in its file
    double pause = 60.0;                   ///< s in which the same fault makes no second file
    size_t maxFiles = 20;                  ///< the oldest go
    uint64_t maxBytes = uint64_t{1} << 28; ///< of all files together
    RecordingOrigin origin;
};

/// A recording that is kept.
struct KeptFlight {
    std::filesystem::path file;
    std::string why;
};

/// Writes the ticks into two files of `seconds` in turn, each a recording that begins with a checkpoint; the
/// system has every `flush`, so a process that dies leaves them behind. With a fault both are joined in a
/// file of its own. One thread; everything throws Error that names a file.
class FlightRecorder {
  public:
    /// Locks a session in the folder.
    explicit FlightRecorder(FlightConfig config);
    /// Ends the session: what is not kept is removed.
    ~FlightRecorder();
    FlightRecorder(const FlightRecorder&) = delete;
    FlightRecorder& operator=(const FlightRecorder&) = delete;

    void add(const TickToRecord& tick);
    /// Everything so far is the system's; a fault whose time has come is kept.
    void flush();
    /// Nothing follows: faults are kept as they are.
    void finish();

    /// What was kept since the last call.
    [[nodiscard]] std::vector<KeptFlight> takeKept() { return std::exchange(kept_, {}); }
    /// Where the last seconds are if the process dies now.
    [[nodiscard]] const std::filesystem::path& session() const { return session_; }

    /// Keeps what sessions left that did not end; the folder may be missing.
    [[nodiscard]] static std::vector<KeptFlight> recover(const FlightConfig& config);

  private:
    [[nodiscard]] std::filesystem::path segment(int index) const;
    void rotate();
    void keep();

    FlightConfig config_;
    std::filesystem::path session_; ///< without ending
    int lock_ = -1;
    FaultWatch watch_;
    std::optional<RecordingWriter> writer_;
    int current_ = 0;
    bool previous_ = false; // the other segment holds what came before
    double recorded_ = 0.0; // s in the current segment
    double clock_ = 0.0;    // s, of all ticks
    std::optional<Fault> pending_;
    double due_ = 0.0;
    std::map<std::string, double> last_; // by fault: when it was kept
    std::vector<KeptFlight> kept_;
};

} // namespace touchstone
