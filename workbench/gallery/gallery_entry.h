#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace touchstone {

enum class GalleryState : uint8_t { Waiting, Shown, NoPicture, Broken, Missing };

/// A file that the gallery offers.
struct GalleryEntry {
    std::filesystem::path file;
    std::string note; ///< what there is to feel, a line; may be empty
    bool sample = false;
    GalleryState state = GalleryState::Waiting;
};

} // namespace touchstone
