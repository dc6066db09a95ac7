#include "renderer/frame_pace.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

void FramePace::begin(double now) {
    if (first_) {
        first_ = false;
        begun_ = now;
        due_ = now + period_;
        return;
    }
    const double interval = std::max(now - begun_, 0.0);
    begun_ = now;
    // Time-weighted: the mean of 1 / interval is then frames over seconds.
    constexpr double kMemory = 1.0; // s
    if (interval > 0.0)
        rate_ +=
            rate_ > 0.0 ? (1.0 - std::exp(-interval / kMemory)) * (1.0 / interval - rate_) : 1.0 / interval;
    due_ += period_;
    if (due_ <= now)
        due_ += period_ * (std::floor((now - due_) / period_) + 1.0);
}

} // namespace touchstone
