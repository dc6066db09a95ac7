#pragma once
// When the network's thread reads the servo.

#include <cstdint>

namespace touchstone::server {

/// A tick as the server has read it. s; `started`: CLOCK_MONOTONIC at which the time of the ticks is 0.
struct ReadTick {
    double started = 0.0;
    double deadline = 0.0; ///< of the tick, since `started`
    double took = 0.0;     ///< from its deadline to its end
};

/// Chooses moments soon after ticks end, so that a state waits for no look of the server's. The servo wakes
/// nobody: a system call has no place in its tick.
class PumpPlan {
  public:
    explicit PumpPlan(double tickPeriod) : tick_(tickPeriod) {}

    /// s on CLOCK_MONOTONIC: when to read after a reading at `now` that found `tick`; `period`: s between two
    /// states that are wanted, at least one tick.
    [[nodiscard]] double after(double now, const ReadTick& tick, double period) noexcept;
    /// The same where nothing is touched.
    [[nodiscard]] double idle(double now, double period) const noexcept { return now + period; }

  private:
    double tick_;        // s
    double took_ = 1e-4; // s: nine ticks of ten end sooner after their deadlines
    double last_ = -1.0; // s: deadline of the tick that was read last
    int early_ = 0;      // readings since then that found no newer one
};

/// A timer of the kernel in the form of a file, for a loop that polls its connections.
class KernelTimer {
  public:
    /// Throws std::runtime_error.
    KernelTimer();
    ~KernelTimer();
    KernelTimer(const KernelTimer&) = delete;
    KernelTimer& operator=(const KernelTimer&) = delete;

    /// `at`: s on CLOCK_MONOTONIC, now or later.
    void set(double at) const noexcept;
    /// It has rung.
    void clear() const noexcept;
    [[nodiscard]] int descriptor() const { return descriptor_; }

  private:
    int descriptor_;
};

/// s on CLOCK_MONOTONIC.
[[nodiscard]] double monotonicNow() noexcept;

} // namespace touchstone::server
