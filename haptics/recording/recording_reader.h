#pragma once
// A recording from the disk, whatever has happened to it since.

#include "haptics/recording/recording_format.h"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>

namespace touchstone {

/// Chunk by chunk; memory is bounded by the largest of them. One thread.
class RecordingReader {
  public:
    /// Throws Error where the file cannot be read, is no recording, or is of a version that this program does
    /// not read.
    explicit RecordingReader(const std::filesystem::path& path);

    struct Item {
        RecordedItem item;
        /// Before it something is missing or spoilt: what is known of the touch ends there.
        bool damageBefore = false;
        uint64_t offset = 0; ///< byte at which its chunk begins
    };
    /// The next whole chunk; nothing at the end of the file. Chunks of kinds that this version does not know
    /// are left out. Throws Error for a chunk that is whole and yet cannot be meant.
    [[nodiscard]] std::optional<Item> next();

    /// The next chunk to be read is the one at `offset`, which an Item of this file said.
    void goTo(uint64_t offset);
    [[nodiscard]] uint64_t size() const { return size_; } ///< bytes, when it was opened

    /// One sentence for each place that was skipped.
    [[nodiscard]] const std::vector<std::string>& damage() const { return damage_; }
    /// The file ends within a chunk, or without the chunk that says that it is whole: the program that wrote
    /// it was killed, or the disk was full.
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
    std::ifstream file_;
    uint64_t size_ = 0, at_ = 0;
    std::optional<uint32_t> nextSequence_;
    bool damaged_ = false, ended_ = false, cutOff_ = false;
    std::vector<std::string> damage_;
};

} // namespace touchstone
