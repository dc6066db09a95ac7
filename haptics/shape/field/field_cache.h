#pragma once
// Fields of meshes kept on disk between runs, by the contents that they are built from.

#include "haptics/shape/field/field_grid.h"

#include <cstdint>
#include <filesystem>
#include <memory>

namespace touchstone {

/// One file for each field in a folder of our own. What cannot be read or written is as if it were not there:
/// a cache is no reason for a message. Two programs may share a folder: files appear as a whole. Any thread
/// but the servo's.
class FieldCache {
  public:
    static constexpr uint64_t kUsualBytes = 1'000'000'000;

    /// No more than `mostBytes` in all; 0: keeps nothing, finds nothing.
    FieldCache(std::filesystem::path folder, uint64_t mostBytes)
        : folder_(std::move(folder)), mostBytes_(mostBytes) {}

    /// $XDG_CACHE_HOME/touchstone/fields (~/.cache/…), and as many bytes as TOUCHSTONE_FIELD_CACHE_MB says,
    /// in millions.
    [[nodiscard]] static FieldCache usual();

    /// Null where there is none, and where the file is not the one that was written, bit for bit: that one is
    /// removed. `key`: Hash64 of all that the field depends on.
    [[nodiscard]] std::shared_ptr<const FieldGrid> find(uint64_t key) const;

    /// Makes room by removing what was not used for the longest time. Nothing where the field alone is larger
    /// than a quarter of all.
    void keep(uint64_t key, const FieldGrid& grid) const;

    [[nodiscard]] std::filesystem::path fileOf(uint64_t key) const;

  private:
    [[nodiscard]] bool makeRoom(uint64_t bytes) const;

    std::filesystem::path folder_;
    uint64_t mostBytes_;
};

} // namespace touchstone
