#pragma once
// A recording on its way to the disk: chunk by chunk, each whole or not at all.

#include "haptics/recording/recording_format.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace touchstone {

/// A file of chunks. Every `append` hands its chunk to the system at once, so that what was appended outlives
/// the process, however it ends (not the machine's power: nothing waits for the disk). One thread; everything
/// throws Error that names the file.
class RecordingFile {
  public:
    /// Makes the file anew, with its header. `sequence`: of the first chunk.
    explicit RecordingFile(std::filesystem::path path, uint32_t sequence = 0);
    ~RecordingFile();
    RecordingFile(const RecordingFile&) = delete;
    RecordingFile& operator=(const RecordingFile&) = delete;

    /// Where the disk is full or the file may not grow, what there is of the chunk is taken back: the file
    /// ends with the last whole one.
    void append(const RecordedItem& item);

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] uint32_t nextSequence() const { return sequence_; }
    [[nodiscard]] uint64_t bytes() const { return bytes_; }

  private:
    void write(std::span<const std::byte> bytes);

    std::filesystem::path path_;
    int descriptor_ = -1;
    uint32_t sequence_;
    uint64_t bytes_ = 0;
};

/// A chunk as it stands in the file.
[[nodiscard]] std::vector<std::byte> chunkOf(const RecordedItem& item, uint32_t sequence);

} // namespace touchstone
