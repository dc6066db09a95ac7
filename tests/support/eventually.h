#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace touchstone::test {

/// Waits for what another thread will do; false after a minute.
[[nodiscard]] inline bool eventually(const std::function<bool()>& condition) {
    const auto limit = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (!condition()) {
        if (std::chrono::steady_clock::now() > limit)
            return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return true;
}

} // namespace touchstone::test
