#pragma once

#include <cstdint>
#include <ctime>

namespace touchstone {

/// CLOCK_MONOTONIC, ns. Any thread; neither blocks nor allocates.
[[nodiscard]] inline int64_t steadyNs() noexcept {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

} // namespace touchstone
