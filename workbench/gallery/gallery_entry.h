#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace touchstone {

enum class GalleryState : uint8_t { Waiting, Shown, NoPicture, Broken, Missing };

/// A file in the gallery.
struct GalleryEntry {
    std::filesystem::path file;
    std::string note; ///< one line; may be empty
    bool sample = false;
    GalleryState state = GalleryState::Waiting;
};

} // namespace touchstone
