#pragma once

#include "engine/scene/image.h"
#include "workbench/gallery/limited_process.h"
#include "workbench/gallery/thumbnail_cache.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace touchstone {

enum class ThumbnailFate : uint8_t {
    None, ///< there is no picture, for reasons that may not be the file's: no time, memory or disk
    Drawn,
    Broken, ///< it cannot be drawn
    Missing ///< there is no such file
};

/// What became of a file.
struct Thumbnail {
    std::filesystem::path file;
    std::string note;  ///< what the file says about itself; may be empty
    PixelData picture; ///< kWidth x kHeight, RGBA; empty where there is none
    ThumbnailFate fate = ThumbnailFate::None;
};

/// Makes pictures of models, one after the other, on a worker that comes after everybody else. What is not in
/// the cache a process of our own draws (`touchstone render`): a file that ends it, or takes all that it may
/// have, ends nothing else, and its device is not the window's. Owner thread.
class ThumbnailMaker {
  public:
    static constexpr int kWidth = 208, kHeight = 130;
    /// Among our own threads and the system's: behind the window, as the loader.
    static constexpr int kNiceness = 10;

    /// `program`: what draws, a touchstone.
    ThumbnailMaker(std::filesystem::path program, ThumbnailCache cache, const ProcessLimits& limits = {});
    /// Stops what is being drawn.
    ~ThumbnailMaker();
    ThumbnailMaker(const ThumbnailMaker&) = delete;
    ThumbnailMaker& operator=(const ThumbnailMaker&) = delete;

    void request(const std::filesystem::path& file);
    /// Forgets what was requested and what has come of it, and ends what is being drawn.
    void cancel();
    [[nodiscard]] std::optional<Thumbnail> take();

  private:
    struct Task {
        std::filesystem::path file;
        std::stop_token stop;
        uint64_t cancels = 0; ///< when it began: another number now, and nobody wants it
    };

    void work(const std::stop_token& stop);
    [[nodiscard]] Thumbnail make(const Task& task) const;
    [[nodiscard]] ThumbnailFate draw(const Task& task, const std::filesystem::path& picture) const;

    std::filesystem::path program_;
    ThumbnailCache cache_;
    ProcessLimits limits_;
    std::atomic<uint64_t> cancels_ = 0; // changed with mutex_
    std::mutex mutex_;
    std::condition_variable_any wanted_;
    std::deque<std::filesystem::path> requests_; // mutex_
    std::deque<Thumbnail> done_;                 // mutex_
    std::jthread worker_;                        // last: it uses all of the above
};

} // namespace touchstone
