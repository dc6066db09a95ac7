#pragma once

#include "renderer/window_target.h"
#include "workbench/files/saved_file.h"

#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace touchstone {

/// Saves the window's picture as PNG, under a free name, on a worker. Main thread.
class PictureController {
  public:
    /// Pictures go into `folder`, created at the first save.
    explicit PictureController(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Requests `part` of the next frame; `stem` starts the name: stem-1.png, stem-2.png, …
    void request(WindowTarget& target, const PixelRect& part, const std::string& stem);
    /// Every frame, after endFrame. True when `note` has changed.
    bool update(WindowTarget& target);

    [[nodiscard]] const SavedNote& note() const { return note_; } ///< of the last picture

  private:
    std::filesystem::path folder_;
    std::optional<PixelRect> part_; ///< of a requested picture that is not ready
    std::string stem_;
    SavedNote note_;
    std::future<SavedNote> saving_;
};

/// The part of a picture that lies within it; empty where there is none.
[[nodiscard]] PixelData cropped(const PixelData& pixels, const PixelRect& part);

/// folder/stem-N.png with the smallest unused N above zero.
[[nodiscard]] std::filesystem::path freePictureName(const std::filesystem::path& folder,
                                                    const std::string& stem);

} // namespace touchstone
