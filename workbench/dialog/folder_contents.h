#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace touchstone {

struct FolderEntry {
    std::string name;
    bool folder = false;
    uint64_t bytes = 0; ///< of a file
    bool operator==(const FolderEntry&) const = default;
};

/// What is in a folder: folders first, then by name without regard to case.
struct FolderContents {
    static constexpr size_t kMax = 20'000; ///< entries read

    std::filesystem::path folder;
    std::vector<FolderEntry> entries;
    std::string problem;  ///< why it cannot be read; empty: it can
    bool complete = true; ///< false: it has more than kMax
};

/// Reads a folder until `cancelled`. Entries that are neither folders nor regular files (or links to them)
/// are left out. Any thread; does not throw.
[[nodiscard]] FolderContents readFolder(const std::filesystem::path& folder,
                                        const std::atomic<bool>& cancelled);

} // namespace touchstone
