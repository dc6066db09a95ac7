#pragma once

#include "renderer/window_target.h"
#include "workbench/files/saved_file.h"

#include <filesystem>
#include <functional>
#include <future>
#include <optional>
#include <string>

namespace touchstone {

/// Saves pictures as PNG, under a free name, on a worker; one at a time. Main thread.
class PictureController {
  public:
    /// Pictures go into `folder`, created at the first save.
    explicit PictureController(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Saves what `draw` returns, which is called at once unless another picture is being saved; `stem`
    /// starts the name: stem-1.png, stem-2.png, … A DeviceLost of `draw` passes, any other failure becomes
    /// the note.
    void save(const std::string& stem, const std::function<PixelData()>& draw);
    /// Requests `part` of the next frame, and saves it.
    void request(WindowTarget& target, const PixelRect& part, const std::string& stem);
    /// Every frame, after endFrame. True when `note` has changed.
    bool update();
    /// The same for requested parts.
    bool update(WindowTarget& target);

    [[nodiscard]] const SavedNote& note() const { return note_; } ///< of the last picture

  private:
    std::filesystem::path folder_;
    std::optional<PixelRect> part_; ///< of a requested picture that is not ready
    std::string stem_;
    SavedNote note_;
    std::future<SavedNote> saving_;
    bool failed_ = false; ///< with a new note
};

/// The part of a picture that lies within it; empty where there is none.
[[nodiscard]] PixelData cropped(const PixelData& pixels, const PixelRect& part);

/// folder/stem-N.png with the smallest unused N above zero.
[[nodiscard]] std::filesystem::path freePictureName(const std::filesystem::path& folder,
                                                    const std::string& stem);

} // namespace touchstone
