#include "engine/core/cache_folder.h"

#include <algorithm>
#include <functional>
#include <system_error>

namespace touchstone {

std::optional<std::vector<CachedFile>> cachedFiles(const std::filesystem::path& folder, const char* ending) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        return std::nullopt;
    std::vector<CachedFile> files;
    std::filesystem::directory_iterator entry(folder, error);
    for (; !error && entry != std::filesystem::directory_iterator(); entry.increment(error)) {
        std::error_code unknown; // a folder, or removed meanwhile: not ours to count
        if (entry->path().extension() != ending || !entry->is_regular_file(unknown))
            continue;
        const auto time = entry->last_write_time(unknown);
        const uintmax_t size = unknown ? 0 : entry->file_size(unknown);
        if (!unknown)
            files.push_back({time, size, entry->path()});
    }
    std::ranges::sort(files, std::less<>{}, &CachedFile::time);
    return files;
}

} // namespace touchstone
