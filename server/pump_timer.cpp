#include "server/pump_timer.h"

#include <sys/timerfd.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <stdexcept>

namespace touchstone::server {

double PumpPlan::after(double now, const ReadTick& tick, double period) noexcept {
    constexpr double kMargin = 3e-5, kAgain = 1e-4; // s
    constexpr int kMostAgain = 5;
    if (tick.deadline == last_) { // its end was late, or it makes none
        const bool soon = early_++ < kMostAgain;
        return now + (soon ? kAgain : period);
    }
    // The quantile of which nine tenths of the ticks are below, in small steps.
    constexpr double kStep = 1e-6;
    took_ = std::clamp(took_ + (tick.took > took_ ? 9.0 * kStep : -kStep), 0.0, 0.5 * tick_);
    last_ = tick.deadline;
    early_ = 0;
    const double ticks = std::max(1.0, std::round(period / tick_));
    const double wanted = tick.started + tick.deadline + ticks * tick_ + took_ + kMargin;
    return wanted > now ? wanted : wanted + std::ceil((now - wanted) / tick_) * tick_;
}

KernelTimer::KernelTimer() : descriptor_(timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC)) {
    if (descriptor_ < 0)
        throw std::runtime_error("the system gives no timer");
}

KernelTimer::~KernelTimer() {
    (void)close(descriptor_);
}

void KernelTimer::set(double at) const noexcept {
    const double whole = std::floor(at);
    itimerspec when{};
    when.it_value = {static_cast<time_t>(whole), static_cast<long>(1e9 * (at - whole))};
    (void)timerfd_settime(descriptor_, TFD_TIMER_ABSTIME, &when, nullptr);
}

void KernelTimer::clear() const noexcept {
    uint64_t rung = 0;
    while (read(descriptor_, &rung, sizeof rung) == static_cast<ssize_t>(sizeof rung))
        continue;
}

double monotonicNow() noexcept {
    timespec now{};
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace touchstone::server
