#include "engine/core/progress.h"

#include <algorithm>
#include <cmath>
#include <system_error>

namespace touchstone {

EstimatedProgress::EstimatedProgress(const Progress& progress, const char* what, double expected)
    : progress_(progress), what_(what), expected_(std::max(expected, 1e-3)) {
    progress_.report(0.0, what_);
    if (!progress_.watched())
        return;
    try {
        thread_ = std::thread([this] { estimate(); });
    } catch (const std::system_error&) { // no thread available: only the library's own reports
    }
}

EstimatedProgress::~EstimatedProgress() {
    {
        const std::lock_guard lock(mutex_);
        over_ = true;
    }
    ended_.notify_one();
    if (thread_.joinable())
        thread_.join();
}

bool EstimatedProgress::at(double fraction) noexcept {
    constexpr double kWorthwhile = 0.002; // not every callback for a thousand triangles needs a report
    if (progress_.cancelled())
        return false;
    if (progress_.watched()) {
        const std::lock_guard lock(mutex_);
        if (fraction > known_) {
            known_ = std::min(fraction, 1.0);
            knownAt_ = Clock::now();
        }
        if (known_ > reported_ + kWorthwhile)
            raiseTo(known_);
    }
    return true;
}

void EstimatedProgress::estimate() noexcept {
    constexpr double kLargestStep = 0.02; // on a busy machine it takes longer than expected
    std::unique_lock lock(mutex_);
    while (!ended_.wait_for(lock, kInterval, [&] { return over_; })) {
        const double waited = std::chrono::duration<double>(Clock::now() - knownAt_).count();
        const double estimated = known_ + (1.0 - known_) * (1.0 - std::exp(-waited / expected_));
        raiseTo(std::min(estimated, std::max(known_, reported_) + kLargestStep));
    }
}

void EstimatedProgress::raiseTo(double fraction) noexcept {
    if (fraction <= reported_)
        return;
    reported_ = fraction;
    progress_.report(fraction, what_);
}

} // namespace touchstone
