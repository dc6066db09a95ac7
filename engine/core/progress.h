#pragma once
// Progress reports and cancellation of long computations.

#include "engine/core/error.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>

namespace touchstone {

/// Thrown by a computation that was cancelled.
class Cancelled : public Error {
  public:
    Cancelled() : Error("loading", "", "cancelled", "") {}
};

/// Vertices, triangles or indices of one loop between two reports: a few milliseconds of work.
inline constexpr size_t kProgressWork = 1 << 16;

/// done / all, 1 where there is nothing to do.
[[nodiscard]] inline double share(size_t done, size_t all) {
    return all == 0 ? 1.0 : static_cast<double>(done) / static_cast<double>(all);
}

/// Passed by value or reference; each part of a computation gets a part of the range. A default-constructed
/// one reports nothing and is never cancelled.
class Progress {
  public:
    /// The fraction of the whole, 0..1, and the current activity: a literal with static lifetime. Never
    /// called by two threads at once, but not always by the same one.
    using Report = std::function<void(double fraction, const char* what)>;

    Progress() = default;
    /// `report` may be empty, `cancel` null; both outlive this and its parts.
    Progress(const Report* report, const std::atomic<bool>* cancel) : report_(report), cancel_(cancel) {}

    /// The part from `from` to `to` of this one's range.
    [[nodiscard]] Progress part(double from, double to) const {
        Progress inner = *this;
        inner.begin_ = begin_ + from * (end_ - begin_);
        inner.end_ = begin_ + to * (end_ - begin_);
        return inner;
    }
    /// The same without reports: for parts too small to be worth one.
    [[nodiscard]] Progress silent() const {
        Progress inner = *this;
        inner.report_ = nullptr;
        return inner;
    }

    /// Reports `fraction` of this one's range; throws Cancelled.
    void step(double fraction, const char* what) const {
        stopIfCancelled();
        report(fraction, what);
    }
    /// Reports only.
    void report(double fraction, const char* what) const {
        if (report_ != nullptr && *report_)
            (*report_)(begin_ + fraction * (end_ - begin_), what);
    }
    [[nodiscard]] bool cancelled() const noexcept {
        return cancel_ != nullptr && cancel_->load(std::memory_order_relaxed);
    }
    void stopIfCancelled() const {
        if (cancelled())
            throw Cancelled();
    }
    [[nodiscard]] bool watched() const { return report_ != nullptr && *report_; }

  private:
    const Report* report_ = nullptr;
    const std::atomic<bool>* cancel_ = nullptr;
    double begin_ = 0.0, end_ = 1.0;
};

/// Progress of a call into a library that reports rarely or never: during its lifetime a thread of its own
/// estimates the fraction from the time. Without a report from the library, 63 % of the remainder at its last
/// report count as done after `expected` seconds, and so on: the estimate never stops, and never reaches the
/// end.
class EstimatedProgress {
  public:
    EstimatedProgress(const Progress& progress, const char* what, double expected);
    /// Waits for the thread, for some microseconds.
    ~EstimatedProgress();
    EstimatedProgress(const EstimatedProgress&) = delete;
    EstimatedProgress& operator=(const EstimatedProgress&) = delete;

    /// The library's own report, 0..1. Any thread; false when it should stop.
    bool at(double fraction) noexcept;

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kInterval{50};
    void estimate() noexcept;
    void raiseTo(double fraction) noexcept;

    const Progress progress_;
    const char* const what_;
    const double expected_; // s
    std::mutex mutex_;      // guards all members below
    std::condition_variable ended_;
    bool over_ = false;
    double known_ = 0.0, reported_ = 0.0;
    Clock::time_point knownAt_ = Clock::now();
    std::thread thread_; // last: it uses all the others
};

} // namespace touchstone
