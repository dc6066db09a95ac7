#pragma once
// Reads a recording from the disk, damaged or not.

#include "haptics/recording/recording_format.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace touchstone {

/// Reads chunk by chunk; memory is bounded by the largest of them. One thread.
class RecordingReader {
  public:
    /// Throws Error where the file cannot be read, is no recording, or has an unsupported version.
    explicit RecordingReader(const std::filesystem::path& path);

    struct Item {
        RecordedItem item;
        /// Data before it is missing or damaged: the state of the touch is unknown from there.
        bool damageBefore = false;
        uint64_t offset = 0; ///< byte at which its chunk begins
    };
    /// The next whole chunk; empty at the end of the file. Chunks of kinds unknown to this version are
    /// skipped. Throws Error for a whole chunk with invalid contents.
    [[nodiscard]] std::optional<Item> next();

    /// Continues at the chunk at `offset`, taken from an Item of this file.
    void goTo(uint64_t offset);
    [[nodiscard]] uint64_t size() const { return size_; } ///< bytes, when opened

    /// One sentence for each place that was skipped.
    [[nodiscard]] const std::vector<std::string>& damage() const { return damage_; }
    /// The file ends within a chunk, or without the end chunk: the program that wrote it was killed, or the
    /// disk was full.
    [[nodiscard]] bool cutOff() const { return cutOff_; }

  private:
    struct Chunk {
        size_t name = 0;
        uint32_t sequence = 0;
        std::vector<std::byte> payload;
    };
    enum class Found { Whole, Spoilt, End, Short };
    Found read(uint64_t at, Chunk& chunk, uint64_t& end);
    [[nodiscard]] std::optional<uint64_t> findSync(uint64_t from);
    bool bytesAt(uint64_t at, std::span<std::byte> out);
    void spoilt(std::string what);

    std::string path_;
    uint32_t format_ = 0;
    std::ifstream file_;
    uint64_t size_ = 0, at_ = 0;
    std::optional<uint32_t> nextSequence_;
    bool damaged_ = false, ended_ = false, cutOff_ = false;
    std::vector<std::string> damage_;
};

} // namespace touchstone
