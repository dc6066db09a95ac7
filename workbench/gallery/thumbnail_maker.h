#pragma once

#include "engine/process/limited_process.h"
#include "engine/scene/image.h"
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
    None, ///< no picture, possibly not the file's fault: time, memory or disk
    Drawn,
    Broken, ///< it cannot be drawn
    Missing ///< the file does not exist
};

/// Result for a file.
struct Thumbnail {
    std::filesystem::path file;
    std::string note;  ///< the file's description; may be empty
    PixelData picture; ///< kWidth x kHeight, RGBA; empty where there is none
    ThumbnailFate fate = ThumbnailFate::None;
};

/// Renders thumbnails, one after the other, on a low-priority worker. Those not in the cache are rendered in
/// a child process (`touchstone render`): a file that crashes it, or exhausts its limits, affects nothing
/// else, and its device is not the window's. Owner thread.
class ThumbnailMaker {
  public:
    static constexpr int kWidth = 208, kHeight = 130;
    /// Below the window's threads and other processes, as the loader.
    static constexpr int kNiceness = 10;

    /// `program`: the touchstone that renders.
    ThumbnailMaker(std::filesystem::path program, ThumbnailCache cache, const ProcessLimits& limits = {});
    /// Stops the current rendering.
    ~ThumbnailMaker();
    ThumbnailMaker(const ThumbnailMaker&) = delete;
    ThumbnailMaker& operator=(const ThumbnailMaker&) = delete;

    void request(const std::filesystem::path& file);
    /// Discards requests and results, and stops the current rendering.
    void cancel();
    [[nodiscard]] std::optional<Thumbnail> take();

  private:
    struct Task {
        std::filesystem::path file;
        std::stop_token stop;
        uint64_t cancels = 0; ///< value of cancels_ at its start: if it differs now, the result is discarded
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
    std::deque<std::filesystem::path> requests_; // guarded by mutex_
    std::deque<Thumbnail> done_;                 // guarded by mutex_
    std::jthread worker_;                        // last: it uses all of the above
};

} // namespace touchstone
