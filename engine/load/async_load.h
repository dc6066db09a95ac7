#pragma once
// loadScene on a worker thread, for a main thread that must continue drawing.

#include "engine/load/scene_loader.h"

#include <atomic>
#include <exception>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

namespace touchstone {

/// One load in the background. All members are for the thread that created it. Only `take` and the destructor
/// wait, until the worker has finished or reacts to a cancellation.
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
        const char* what = ""; ///< current activity, never null
    };
    [[nodiscard]] Progress progress() const noexcept;

    /// True once `take` returns without waiting.
    [[nodiscard]] bool finished() const noexcept;

    /// Requests the worker to stop. `take` then throws Error with problem "cancelled", unless the load was
    /// already complete.
    void cancel() noexcept;

    /// The scene, or the Error of the load; waits until the worker has finished. Once only: null after the
    /// first call.
    [[nodiscard]] ScenePtr take();

    [[nodiscard]] const std::filesystem::path& path() const noexcept { return path_; }

  private:
    void work(LoadOptions options) noexcept;

    const std::filesystem::path path_;
    std::atomic<double> fraction_{0.0};
    std::atomic<const char*> what_{"starting"}; // string literals of the loader, with static lifetime
    std::atomic<bool> cancel_{false}, finished_{false};
    ScenePtr scene_;             // written by the worker until finished_
    std::exception_ptr problem_; // the same
    std::thread worker_;         // last: it uses all the others
};

} // namespace touchstone
