#pragma once
// Writes ticks to a file as they come; each is preceded by the data that it needs.

#include "haptics/recording/recording_file.h"
#include "haptics/servo/servo_loop.h"

#include <cstdint>
#include <filesystem>
#include <map>

namespace touchstone {

/// The recorded part of a tick. Computes its hashes; not for the servo thread.
[[nodiscard]] RecordedTick recordedTick(const TickRecord& record);

/// A tick with all data that it depends on.
struct TickToRecord {
    const RecordedTick& tick;
    const HapticSettings& settings;              ///< TickRecord::settings
    const SceneIdentity* scene = nullptr;        ///< TickRecord::scene; null: none
    const TouchCheckpoint* checkpoint = nullptr; ///< taken before this tick
    uint64_t lostBefore = 0;                     ///< ticks made since the last one whose records were lost
};

/// Writes a recording. Begins with the first tick that has a checkpoint; earlier ones are left out. Ticks are
/// buffered until `flush`, or for kBlock of them. One thread; every function throws Error that names the
/// file.
class RecordingWriter {
  public:
    RecordingWriter(std::filesystem::path path, RecordingOrigin origin, uint32_t sequence = 0);

    void add(const TickToRecord& tick);
    void note(uint64_t tick, std::string text);
    /// Passes all data to the system.
    void flush();
    /// End of the input. Without it a reader reports that the recording was cut off.
    void finish();

    [[nodiscard]] uint64_t ticks() const { return ticks_; }
    [[nodiscard]] const RecordingFile& file() const { return file_; }

  private:
    static constexpr size_t kBlock = 256;

    RecordingFile file_;
    RecordingOrigin origin_;
    RecordedTicks block_;
    uint64_t ticks_ = 0;
    std::map<uint32_t, bool> scenes_; // written
    uint32_t settings_ = 0;
    bool begun_ = false;
};

} // namespace touchstone
