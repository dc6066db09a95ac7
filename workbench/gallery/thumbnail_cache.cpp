#include "workbench/gallery/thumbnail_cache.h"

#include "engine/core/cache_folder.h"
#include "engine/core/checksum.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <vector>

namespace touchstone {

namespace {

constexpr int kVersion = 1; ///< version of the thumbnails' style: another one ignores older files

} // namespace

std::filesystem::path ThumbnailCache::usualFolder() {
    const auto variable = [](const char* name) {
        const char* value = std::getenv(name);
        return std::filesystem::path(value != nullptr ? value : "");
    };
    std::filesystem::path cache = std::filesystem::temp_directory_path();
    if (const std::filesystem::path asked = variable("XDG_CACHE_HOME"); asked.is_absolute())
        cache = asked;
    else if (const std::filesystem::path home = variable("HOME"); home.is_absolute())
        cache = home / ".cache";
    return cache / "touchstone" / "thumbnails";
}

std::filesystem::path ThumbnailCache::pictureOf(const std::filesystem::path& model) const {
    std::error_code error;
    const std::filesystem::path whole = std::filesystem::canonical(model, error);
    if (error || !std::filesystem::is_regular_file(whole, error))
        return {};
    const auto time = std::filesystem::last_write_time(whole, error);
    const uintmax_t size = std::filesystem::file_size(whole, error);
    if (error)
        return {};
    Hash64 hash;
    hash.add(kVersion);
    const std::string name = whole.string();
    hash.addBytes(std::as_bytes(std::span(name)));
    hash.add(time.time_since_epoch().count());
    hash.add(size);
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%016llx.png", static_cast<unsigned long long>(hash.value()));
    return folder_ / text.data();
}

bool ThumbnailCache::makeRoom() const {
    const auto kept = cachedFiles(folder_, ".png");
    if (!kept)
        return false;
    std::error_code error;
    for (size_t i = 0; i + kMax <= kept->size(); ++i) // and one place for the next
        std::filesystem::remove((*kept)[i].file, error);
    return true;
}

bool ThumbnailCache::takes(const std::filesystem::path& picture) const {
    std::filesystem::path trial = picture;
    trial += ".try";
    std::ofstream stream(trial, std::ios::binary);
    stream << std::string(size_t{64} << 10, ' ');
    stream.close();
    const bool written = !stream.fail();
    std::error_code error;
    std::filesystem::remove(trial, error);
    return written;
}

} // namespace touchstone
