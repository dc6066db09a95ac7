#pragma once

#include <sys/types.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace touchstone {

// A sanitizer's shadow memory counts, too.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr uint64_t kMaxMemory = std::numeric_limits<uint64_t>::max();
#else
constexpr uint64_t kMaxMemory = uint64_t{2} << 30;
#endif

/// Resource limits of a child process.
struct ProcessLimits {
    unsigned processorSeconds = 60;
    unsigned seconds = 180;       ///< wall-clock time, for the waiting parent
    uint64_t memory = kMaxMemory; ///< bytes of its own writable memory
    /// Bytes of a file that it writes, and files that it has open at once.
    uint64_t fileSize = std::numeric_limits<uint64_t>::max(), openFiles = 1024;
    bool endsWithThread = true; ///< with the thread that started it
};

/// File descriptors that become standard streams of a child; -1: /dev/null. They stay the caller's.
struct ProcessStreams {
    int input = -1, output = -1;
};

/// Exit status where exec failed.
constexpr int kCannotStart = 127;

/// Starts a program with these standard streams (nothing is read from standard error), within these limits
/// from its first instruction, and (from Linux 5.9 on) no other open file. The system's out-of-memory killer
/// prefers it. `arguments` start with its name. Returns -1 where no process can be created. Does not copy our
/// page tables: no page of the servo's may become copy-on-write.
[[nodiscard]] pid_t startLimited(const std::string& program, const std::vector<std::string>& arguments,
                                 const ProcessLimits& limits, const ProcessStreams& streams = {});

} // namespace touchstone
