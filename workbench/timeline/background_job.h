#pragma once
// One piece of work at a time beside the window's thread.

#include <sys/resource.h>

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

namespace touchstone {

/// Thrown by JobProgress::at; BackgroundJob takes it as the end that was asked for.
struct JobCancelled {};

/// What a worker tells while it works. Any thread.
class JobProgress {
  public:
    /// Throws JobCancelled where nobody wants the result any more. `fraction`: 0..1.
    void at(double fraction) {
        fraction_.store(fraction, std::memory_order_relaxed);
        if (cancelled_.load(std::memory_order_relaxed))
            throw JobCancelled();
    }
    [[nodiscard]] const std::atomic<bool>& cancelled() const { return cancelled_; }

  private:
    template <class Result>
    friend class BackgroundJob;
    std::atomic<bool> cancelled_{false}, finished_{false};
    std::atomic<double> fraction_{0.0};
};

/// Main thread only, but for what `start` is given.
template <class Result>
class BackgroundJob {
  public:
    using Work = std::function<Result(JobProgress&)>;

    BackgroundJob() = default;
    /// Waits until the worker has noticed that nobody wants it.
    ~BackgroundJob() {
        abandon();
        if (worker_.joinable())
            worker_.join();
    }
    BackgroundJob(const BackgroundJob&) = delete;
    BackgroundJob& operator=(const BackgroundJob&) = delete;

    /// Only while not `busy`. Throws std::system_error where there is no thread to be had.
    void start(Work work) {
        auto shared = std::make_shared<Shared>();
        worker_ = std::thread([shared, work = std::move(work)] {
            constexpr int kNiceness = 10; // on few cores the window comes first
            (void)::setpriority(PRIO_PROCESS, 0, kNiceness);
            try {
                shared->result = work(shared->progress);
            } catch (const JobCancelled&) {
                shared->progress.cancelled_.store(true, std::memory_order_relaxed);
            } catch (...) {
                shared->failure = std::current_exception();
            }
            shared->progress.finished_.store(true, std::memory_order_release);
        });
        shared_ = std::move(shared);
    }
    /// Nothing comes of it; `busy` goes on until the worker has noticed.
    void abandon() {
        if (shared_ != nullptr)
            shared_->progress.cancelled_.store(true, std::memory_order_relaxed);
    }
    [[nodiscard]] bool busy() const { return shared_ != nullptr; }
    /// There is nothing to wait for: `take` and the destructor return at once.
    [[nodiscard]] bool finished() const {
        return !busy() || shared_->progress.finished_.load(std::memory_order_acquire);
    }
    [[nodiscard]] bool wanted() const {
        return busy() && !shared_->progress.cancelled_.load(std::memory_order_relaxed);
    }
    [[nodiscard]] double fraction() const { // 0..1
        return busy() ? shared_->progress.fraction_.load(std::memory_order_relaxed) : 0.0;
    }

    /// The result once it is there; throws what stopped it, once. Nothing of what was abandoned.
    [[nodiscard]] std::optional<Result> take() {
        if (!busy() || !shared_->progress.finished_.load(std::memory_order_acquire))
            return std::nullopt;
        worker_.join();
        const std::shared_ptr<Shared> shared = std::exchange(shared_, nullptr);
        if (shared->progress.cancelled_.load(std::memory_order_relaxed))
            return std::nullopt;
        if (shared->failure)
            std::rethrow_exception(shared->failure);
        return std::move(shared->result);
    }

  private:
    struct Shared {
        JobProgress progress;
        std::optional<Result> result; // worker until finished
        std::exception_ptr failure;   // worker until finished
    };
    std::thread worker_;
    std::shared_ptr<Shared> shared_;
};

} // namespace touchstone
