#pragma once
// From ticks as they come to a file: what each of them needs stands before it.

#include "haptics/recording/recording_file.h"
#include "haptics/servo/servo_loop.h"

#include <cstdint>
#include <filesystem>
#include <map>

namespace touchstone {

/// What a recording keeps of a tick. Hashes it; not for the servo thread.
[[nodiscard]] RecordedTick recordedTick(const TickRecord& record);

/// A tick with all that it depends on.
struct TickToRecord {
    const RecordedTick& tick;
    const HapticSettings& settings;              ///< TickRecord::settings
    const SceneIdentity* scene = nullptr;        ///< TickRecord::scene; null: none
    const TouchCheckpoint* checkpoint = nullptr; ///< taken before this tick
    uint64_t lostBefore = 0; ///< ticks that were made since the last one and are not known
};

/// Writes a recording. Begins with the first tick that has a checkpoint; those before it are left out. Ticks
/// are kept back until `flush`, or for kBlock of them. One thread; everything throws Error that names the
/// file.
class RecordingWriter {
  public:
    RecordingWriter(std::filesystem::path path, RecordingOrigin origin, uint32_t sequence = 0);

    void add(const TickToRecord& tick);
    void note(uint64_t tick, std::string text);
    /// Everything so far is the system's.
    void flush();
    /// Nothing follows. Without it a reader says that the recording was cut off.
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
