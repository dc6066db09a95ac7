#pragma once

#include <chrono>

namespace touchstone {

/// s, of the steady clock. Any thread.
[[nodiscard]] inline double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace touchstone
