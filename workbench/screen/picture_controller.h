#pragma once

#include "renderer/window_target.h"

#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace touchstone {

/// Saves what the window shows as PNG, under a name that is free, on a worker. Main thread.
class PictureController {
  public:
    /// Pictures go into `folder`, which is made when the first one is saved.
    explicit PictureController(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// The next frame, within `part` of it; `stem` begins the name: stem-1.png, stem-2.png, …
    void request(WindowTarget& target, const PixelRect& part, const std::string& stem);
    /// Once a frame, after endFrame. True when there is news in `message`.
    bool update(WindowTarget& target);

    /// "saved /…/doughnut-1.png", or what went wrong; empty before the first picture.
    [[nodiscard]] const std::string& message() const { return message_; }

  private:
    std::filesystem::path folder_;
    std::optional<PixelRect> part_; ///< of a picture that was asked for and is not yet there
    std::string stem_, message_;
    std::future<std::string> saving_;
};

/// The part of a picture that lies within it; empty where there is none.
[[nodiscard]] PixelData cropped(const PixelData& pixels, const PixelRect& part);

/// folder/stem-N.png with the least N above zero that no file has.
[[nodiscard]] std::filesystem::path freePictureName(const std::filesystem::path& folder,
                                                    const std::string& stem);

} // namespace touchstone
