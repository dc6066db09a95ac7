#pragma once

#include "engine/scene/image.h"
#include "workbench/gallery/thumbnail_cache.h"

#include <condition_variable>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace touchstone {

/// What became of a file.
struct Thumbnail {
    std::filesystem::path file;
    std::string note;  ///< what the file says about itself; may be empty
    PixelData picture; ///< kWidth x kHeight, RGBA; empty where there is none
    bool missing = false;
};

/// Makes pictures of models, one after the other, on a worker that comes after everybody else. What is not in
/// the cache a process of our own draws (`touchstone render`): a file that ends it, or takes all memory, ends
/// nothing else, and its device is not the window's. It may use kMostSeconds of a processor. Owner thread.
class ThumbnailMaker {
  public:
    static constexpr int kWidth = 208, kHeight = 130;
    static constexpr unsigned kMostSeconds = 60;
    /// Among our own threads and the system's: behind the window, as the loader.
    static constexpr int kNiceness = 10;

    /// `program`: what draws, a touchstone.
    ThumbnailMaker(std::filesystem::path program, ThumbnailCache cache);
    /// Stops what is being drawn.
    ~ThumbnailMaker();
    ThumbnailMaker(const ThumbnailMaker&) = delete;
    ThumbnailMaker& operator=(const ThumbnailMaker&) = delete;

    void request(const std::filesystem::path& file);
    /// Forgets what was requested and is not begun.
    void cancel();
    [[nodiscard]] std::optional<Thumbnail> take();

  private:
    void work(const std::stop_token& stop);
    [[nodiscard]] Thumbnail make(const std::filesystem::path& file, const std::stop_token& stop) const;
    [[nodiscard]] bool draw(const std::filesystem::path& file, const std::filesystem::path& picture,
                            const std::stop_token& stop) const;

    std::filesystem::path program_;
    ThumbnailCache cache_;
    std::mutex mutex_;
    std::condition_variable_any wanted_;
    std::deque<std::filesystem::path> requests_; // mutex_
    std::deque<Thumbnail> done_;                 // mutex_
    std::jthread worker_;                        // last: it uses all of the above
};

} // namespace touchstone
