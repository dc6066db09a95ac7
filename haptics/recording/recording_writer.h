#pragma once
// Writes ticks to a file as they come; each is preceded by the data that it needs.

#include "haptics/recording/recording_file.h"
#include "haptics/servo/servo_loop.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>

namespace touchstone {

/// The recorded part of a tick. Computes its hashes; not for the servo thread.
[[nodiscard]] RecordedTick recordedTick(const TickRecord& record);

/// The same tick of another hand than hand 0.
struct HandToRecord {
    uint32_t hand = 0;
    RecordedTick tick;
    std::optional<TouchCheckpoint> checkpoint; ///< taken before this tick
};

/// A scene that was sculpted, with all that was made since its root.
struct SculptToRecord {
    uint32_t root = 0;
    uint64_t hash = 0;
    std::span<const SculptEntry> journal;
};

/// A tick with all data that it depends on.
struct TickToRecord {
    const RecordedTick& tick;
    const HapticSettings& settings;              ///< TickRecord::settings
    const SceneIdentity* scene = nullptr;        ///< TickRecord::root; null: none
    const TouchCheckpoint* checkpoint = nullptr; ///< of hand 0, taken before this tick
    bool whole = true;                           ///< TickRecord::whole, where there is a checkpoint
    uint64_t lostBefore = 0;                     ///< ticks made since the last one whose records were lost
    std::span<const HandToRecord> others{};      ///< the other hands
    const SculptToRecord* sculpt = nullptr;      ///< where TickRecord::scene is not its root
    uint32_t toolNumber = 0;                     ///< TickRecord::tool
    LiveTool tool{};
    const std::vector<std::byte>* bodies = nullptr; ///< of a scene with bodies, at a checkpoint
    const PersistentTextures* textures = nullptr;   ///< of a scene with some: before this tick
    std::span<const BrushStroke> strokes{};         ///< what this tick changes of them
    const DrivenState* driven = nullptr;            ///< ServoLoop::drivenBefore
};

/// Writes a recording. Begins with the first tick that has a whole checkpoint; earlier ones are left out.
/// Ticks are buffered until `flush`, or for kBlock of them. One thread; every function throws Error that
/// names the file.
class RecordingWriter {
  public:
    RecordingWriter(std::filesystem::path path, RecordingOrigin origin, uint32_t sequence = 0);

    void add(const TickToRecord& tick);
    void note(uint64_t tick, std::string text);
    /// Passes all data to the system.
    void flush();
    /// End of the input. Without it a reader reports that the recording was cut off.
    void finish();

    [[nodiscard]] uint64_t ticks() const { return ticks_; } ///< of hand 0
    [[nodiscard]] const RecordingFile& file() const { return file_; }

  private:
    static constexpr size_t kBlock = 256;
    /// Checkpoints from one whole state of the textures to the next.
    static constexpr uint32_t kTexturesEvery = 32;
    void addSculpt(uint32_t scene, const SculptToRecord& sculpt);
    void addLocations(uint32_t hand, const RecordedTicks& block);
    void addTextures(const TickToRecord& tick, uint32_t root);

    RecordingFile file_;
    RecordingOrigin origin_;
    RecordedTicks block_;
    std::map<uint32_t, RecordedTicks> otherBlocks_; // by hand
    uint64_t ticks_ = 0;
    std::map<uint32_t, bool> scenes_; // written
    uint32_t settings_ = 0, tool_ = 0, sculpted_ = 0;
    std::map<uint32_t, size_t> journals_; // by root: entries written
    RecordedStrokes strokes_;             // of the ticks in `block_`
    uint32_t texturesOf_ = 0;             // scene of the last whole state of textures
    uint32_t texturesAge_ = 0;            // checkpoints since
    bool begun_ = false;
};

} // namespace touchstone
