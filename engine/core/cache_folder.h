#pragma once
// Folders whose oldest files go when there is no room.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace touchstone {

struct CachedFile {
    std::filesystem::file_time_type time;
    uint64_t bytes = 0;
    std::filesystem::path file;
};

/// The files of `folder` that end with `ending` (".png"), the oldest first; the folder is made where there is
/// none. What cannot be read is left out. Nothing where the folder cannot be made. Throws only where memory
/// ends.
[[nodiscard]] std::optional<std::vector<CachedFile>> cachedFiles(const std::filesystem::path& folder,
                                                                 const char* ending);

} // namespace touchstone
