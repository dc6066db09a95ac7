#pragma once
// loadScene on a worker thread, for a main thread that must keep drawing.

#include "engine/load/scene_loader.h"

#include <atomic>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

namespace touchstone {

/// One load in the background. All members are for the thread that made it; none of them but `take` (and the
/// destructor) waits, and those only once the worker is at its end or was told to stop.
class AsyncLoad {
  public:
    /// Starts at once. `options.progress` and `options.cancel` are replaced by this object's own.
    explicit AsyncLoad(std::filesystem::path path, LoadOptions options = {});

    /// Cancels and waits: at most until the import's next step (one mesh, one image).
    ~AsyncLoad();

    AsyncLoad(const AsyncLoad&) = delete;
    AsyncLoad& operator=(const AsyncLoad&) = delete;

    struct Progress {
        double fraction = 0.0; ///< 0..1
        const char* what = ""; ///< what is being done, never null
    };
    [[nodiscard]] Progress progress() const noexcept;

    /// True once `take` has something to give without waiting.
    [[nodiscard]] bool finished() const noexcept;

    /// Asks the worker to stop. `take` then throws Error with problem "cancelled", unless the load was
    /// already done.
    void cancel() noexcept;

    /// The scene, or the Error of the load; waits for the worker's end. Once only: null after the first time.
    [[nodiscard]] ScenePtr take();

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  private:
    void work(LoadOptions options) noexcept;

    const std::filesystem::path path_;
    std::atomic<double> fraction_{0.0};
    std::atomic<const char*> what_{"starting"}; // string literals of the loader: they live for ever
    std::atomic<bool> cancel_{false}, finished_{false};
    ScenePtr scene_;             // the worker's until finished_
    std::exception_ptr problem_; // the same
    std::thread worker_;         // last: it uses all the others
};

} // namespace touchstone
