#pragma once
// One job at a time on a worker thread.

#include <sys/resource.h>

#include <atomic>
#include <exception>
#include <functional>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

namespace touchstone {

/// Thrown by JobProgress::at; BackgroundJob treats it as a cancellation.
struct JobCancelled {};

/// Progress and cancellation of a worker. Any thread.
class JobProgress {
  public:
    /// Throws JobCancelled after abandon(). `fraction`: 0..1.
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

/// Main thread only, except the function given to `start`.
template <class Result>
class BackgroundJob {
  public:
    using Work = std::function<Result(JobProgress&)>;

    BackgroundJob() = default;
    /// Waits until the worker has noticed the cancellation.
    ~BackgroundJob() {
        abandon();
        if (worker_.joinable())
            worker_.join();
    }
    BackgroundJob(const BackgroundJob&) = delete;
    BackgroundJob& operator=(const BackgroundJob&) = delete;

    /// Only while not `busy`. Throws std::system_error if no thread can be created.
    void start(Work work) {
        auto shared = std::make_shared<Shared>();
        worker_ = std::thread([shared, work = std::move(work)] {
            constexpr int kNiceness = 10; // on few cores the window has priority
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
    /// Cancels the job; `busy` stays true until the worker has ended.
    void abandon() {
        if (shared_ != nullptr)
            shared_->progress.cancelled_.store(true, std::memory_order_relaxed);
    }
    [[nodiscard]] bool busy() const { return shared_ != nullptr; }
    /// True where `take` and the destructor return at once.
    [[nodiscard]] bool finished() const {
        return !busy() || shared_->progress.finished_.load(std::memory_order_acquire);
    }
    [[nodiscard]] bool wanted() const {
        return busy() && !shared_->progress.cancelled_.load(std::memory_order_relaxed);
    }
    [[nodiscard]] double fraction() const { // 0..1
        return busy() ? shared_->progress.fraction_.load(std::memory_order_relaxed) : 0.0;
    }

    /// The result once it is ready; throws the worker's exception once. Nothing for a cancelled job.
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
