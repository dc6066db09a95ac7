#pragma once

#include "workbench/gallery/gallery_entry.h"
#include "workbench/gallery/thumbnail_maker.h"

#include <memory>
#include <span>
#include <vector>

namespace touchstone {

class WindowTarget;

/// What the gallery offers: our own scenes, then what was opened before, as many as the window has places for
/// pictures. Entry i has picture i. Main thread.
class Gallery {
  public:
    /// Once a frame. Looks at the files when it is opened, and anew when what was opened before changes;
    /// while it is closed nothing is drawn.
    void update(bool open, std::span<const std::filesystem::path> samples,
                std::span<const std::filesystem::path> recent, WindowTarget& target);
    [[nodiscard]] std::span<const GalleryEntry> entries() const { return entries_; }

  private:
    void fill(std::span<const std::filesystem::path> samples, std::span<const std::filesystem::path> recent);

    std::vector<GalleryEntry> entries_;
    std::vector<std::filesystem::path> recent_; // that entries_ were made of
    bool open_ = false;
    std::unique_ptr<ThumbnailMaker> maker_; // from the first time that it is opened
};

} // namespace touchstone
