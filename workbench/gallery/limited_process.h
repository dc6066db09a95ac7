#pragma once

#include <sys/types.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace touchstone {

// A sanitizer's map of all memory counts, too.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr uint64_t kMaxMemory = std::numeric_limits<uint64_t>::max();
#else
constexpr uint64_t kMaxMemory = uint64_t{2} << 30;
#endif

/// What a process of ours may use.
struct ProcessLimits {
    unsigned processorSeconds = 60;
    unsigned seconds = 180;       ///< of the clock, for who waits for it
    uint64_t memory = kMaxMemory; ///< bytes of its own, writable
};

/// Its exit status where it could not become the program.
constexpr int kCannotStart = 127;

/// Starts a program without standard streams, within these limits from its first instruction. Where memory
/// gets short the system ends it first, and it ends with the thread that called. `arguments` begin with what
/// it is called. -1 where there can be no process. Takes no copy of our memory's map: no page of the servo's
/// is to be written anew.
[[nodiscard]] pid_t startLimited(const std::string& program, const std::vector<std::string>& arguments,
                                 const ProcessLimits& limits);

} // namespace touchstone
