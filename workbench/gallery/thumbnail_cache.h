#pragma once

#include <filesystem>
#include <string>

namespace touchstone {

/// Thumbnails of models, kept between runs in $XDG_CACHE_HOME/touchstone/thumbnails (~/.cache/…): one PNG
/// keyed by a file's path, time and size, so a changed file has none. Any one thread.
class ThumbnailCache {
  public:
    /// Number of thumbnails kept: some 12 kB each.
    static constexpr size_t kMax = 200;

    explicit ThumbnailCache(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// The system's default folder.
    [[nodiscard]] static std::filesystem::path usualFolder();

    /// Path of the thumbnail of `model`, existing or not; empty where the model does not exist.
    [[nodiscard]] std::filesystem::path pictureOf(const std::filesystem::path& model) const;
    /// Creates the folder and removes the oldest thumbnails. False where nothing can be stored.
    [[nodiscard]] bool makeRoom() const;
    /// Whether a file of a thumbnail's size can be written there now.
    [[nodiscard]] bool takes(const std::filesystem::path& picture) const;

  private:
    std::filesystem::path folder_;
};

} // namespace touchstone
