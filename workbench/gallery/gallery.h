#pragma once

#include "workbench/gallery/gallery_entry.h"
#include "workbench/gallery/thumbnail_maker.h"

#include <memory>
#include <span>
#include <vector>

namespace touchstone {

class WindowTarget;

/// Contents of the gallery: our own scenes, then the recent ones, as many as the window has picture slots.
/// Entry i has picture i. Main thread.
class Gallery {
  public:
    /// Every frame. Checks the files when it is opened, and again when the recent files change; while it is
    /// closed nothing is drawn.
    void update(bool open, std::span<const std::filesystem::path> samples,
                std::span<const std::filesystem::path> recent, WindowTarget& target);
    [[nodiscard]] std::span<const GalleryEntry> entries() const { return entries_; }

  private:
    void fill(std::span<const std::filesystem::path> samples, std::span<const std::filesystem::path> recent);

    std::vector<GalleryEntry> entries_;
    std::vector<std::filesystem::path> recent_; // the list that entries_ was built from
    bool open_ = false;
    std::unique_ptr<ThumbnailMaker> maker_; // created when it is first opened
};

} // namespace touchstone
