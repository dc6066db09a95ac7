#pragma once
// Writes a recording to the disk chunk by chunk, each whole or not at all.

#include "haptics/recording/recording_format.h"

#include <cstdint>
#include <filesystem>
#include <span>

namespace touchstone {

/// A file of chunks. Every `append` passes its chunk to the system at once, so that it survives the process
/// however it ends (not a power failure: nothing waits for the disk). One thread; every function throws Error
/// that names the file.
class RecordingFile {
  public:
    /// Creates or overwrites the file, with its header. `sequence`: of the first chunk.
    explicit RecordingFile(std::filesystem::path path, uint32_t sequence = 0);
    ~RecordingFile();
    RecordingFile(const RecordingFile&) = delete;
    RecordingFile& operator=(const RecordingFile&) = delete;

    /// Where the disk is full or the file may not grow, the partial chunk is removed: the file ends with the
    /// last whole one.
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

/// The bytes of a chunk in the file.
[[nodiscard]] std::vector<std::byte> chunkOf(const RecordedItem& item, uint32_t sequence);

} // namespace touchstone
