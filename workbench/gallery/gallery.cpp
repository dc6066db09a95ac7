#include "workbench/gallery/gallery.h"

#include "renderer/window_target.h"

#include <unistd.h>

#include <algorithm>
#include <string>
#include <utility>

namespace touchstone {

static_assert(ThumbnailMaker::kWidth == WindowTarget::kPictureWidth &&
              ThumbnailMaker::kHeight == WindowTarget::kPictureHeight);

namespace {

GalleryState stateOf(ThumbnailFate fate) {
    switch (fate) {
    case ThumbnailFate::None:
        break;
    case ThumbnailFate::Drawn:
        return GalleryState::Shown;
    case ThumbnailFate::Broken:
        return GalleryState::Broken;
    case ThumbnailFate::Missing:
        return GalleryState::Missing;
    }
    return GalleryState::NoPicture;
}

} // namespace

void Gallery::fill(std::span<const std::filesystem::path> samples,
                   std::span<const std::filesystem::path> recent) {
    // The previous entry stays until it is updated.
    const std::vector<GalleryEntry> before = std::exchange(entries_, {});
    const auto add = [&](const std::filesystem::path& file, bool sample) {
        const size_t place = entries_.size();
        if (place >= WindowTarget::kPictures ||
            std::ranges::find(entries_, file, &GalleryEntry::file) != entries_.end())
            return;
        if (place < before.size() && before[place].file == file)
            entries_.push_back(before[place]);
        else
            entries_.push_back({.file = file, .note = {}, .sample = sample});
    };
    for (const std::filesystem::path& file : samples)
        add(file, true);
    for (const std::filesystem::path& file : recent)
        add(file, false);
    recent_.assign(recent.begin(), recent.end());
    if (maker_ == nullptr) // the running program, even if another build has replaced its file
        maker_ = std::make_unique<ThumbnailMaker>("/proc/" + std::to_string(getpid()) + "/exe",
                                                  ThumbnailCache(ThumbnailCache::usualFolder()));
    maker_->cancel();
    for (const GalleryEntry& entry : entries_)
        maker_->request(entry.file);
}

void Gallery::update(bool open, std::span<const std::filesystem::path> samples,
                     std::span<const std::filesystem::path> recent, WindowTarget& target) {
    const bool opened = open && !open_;
    open_ = open;
    if (!open) {
        if (maker_ != nullptr)
            maker_->cancel();
        return;
    }
    if (opened || !std::ranges::equal(recent_, recent))
        fill(samples, recent);
    // One per frame: the upload takes time.
    const std::optional<Thumbnail> made = maker_->take();
    if (!made)
        return;
    const auto entry = std::ranges::find(entries_, made->file, &GalleryEntry::file);
    if (entry == entries_.end())
        return;
    entry->note = made->note;
    entry->state = stateOf(made->fate);
    if (entry->state == GalleryState::Shown)
        target.setPicture(static_cast<size_t>(entry - entries_.begin()), made->picture);
}

} // namespace touchstone
