#pragma once

#include <sys/resource.h>

#include <algorithm>

namespace touchstone {

/// Lowers a limit of this process to `most`; a lower existing one is kept. `beyond`: from there to where the
/// system kills without a signal that says why. System calls only, so that a child may call it before exec.
inline void lowerLimit(decltype(RLIMIT_CORE) what, rlim_t most, rlim_t beyond = 0) {
    rlimit before{RLIM_INFINITY, RLIM_INFINITY};
    getrlimit(what, &before);
    const rlim_t lowest = std::min({most, before.rlim_cur, before.rlim_max});
    const rlim_t room = before.rlim_max - lowest;
    const rlimit both{lowest, lowest + std::min(beyond, room)};
    setrlimit(what, &both);
}

} // namespace touchstone
