#pragma once

#include <filesystem>
#include <string>

namespace touchstone {

/// Pictures of models, kept from run to run in $XDG_CACHE_HOME/touchstone/thumbnails (~/.cache/…): one PNG
/// for what a file was, by its path, time and size, so a file that has changed has none. Any one thread.
class ThumbnailCache {
  public:
    /// The newest that are kept: some 12 kB each.
    static constexpr size_t kMax = 200;

    explicit ThumbnailCache(std::filesystem::path folder) : folder_(std::move(folder)) {}
    /// Where the system wants it.
    [[nodiscard]] static std::filesystem::path usualFolder();

    /// Where the picture of `model` is or is to be; empty where there is no such file.
    [[nodiscard]] std::filesystem::path pictureOf(const std::filesystem::path& model) const;
    /// Makes the folder and forgets the oldest pictures. False where nothing can be kept there.
    [[nodiscard]] bool makeRoom() const;
    /// Whether a file as large as pictures are can be written there now.
    [[nodiscard]] bool takes(const std::filesystem::path& picture) const;

  private:
    std::filesystem::path folder_;
};

} // namespace touchstone
