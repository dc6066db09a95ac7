#pragma once
// What a child process writes to its standard output.

#include "engine/process/limited_process.h"

#include <sys/types.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// An open file descriptor, closed at the end of its life.
class FileDescriptor {
  public:
    explicit FileDescriptor(int descriptor = -1) : descriptor_(descriptor) {}
    ~FileDescriptor();
    FileDescriptor(FileDescriptor&& other) noexcept : descriptor_(other.release()) {}
    FileDescriptor& operator=(FileDescriptor&& other) noexcept;
    [[nodiscard]] int get() const { return descriptor_; } ///< -1: none
    void close();
    int release(); ///< does not close it

  private:
    int descriptor_;
};

/// A file in memory with these bytes, read from its beginning, which nobody can change; none where the system
/// has no memory for it.
[[nodiscard]] FileDescriptor memoryFile(std::span<const uint8_t> bytes);

/// ms between two questions whether to stop.
inline constexpr int kStopInterval = 20;

struct ProcessAnswer {
    enum class End : uint8_t {
        Exited,     ///< with `status`
        Killed,     ///< by the signal `status`
        TooSlow,    ///< killed here, after its time had passed
        TooLong,    ///< killed here, with more output than allowed
        Stopped,    ///< killed here, on request
        NotStarted, ///< the system has no process for it, or there is no such program
    };
    End end = End::NotStarted;
    int status = 0;
    std::vector<uint8_t> output;
};

/// The output, at most `maxOutput` bytes, of the child that `begin` starts, to its end. `begin` gets the file
/// that becomes its standard output and returns its number; -1: there is none. limits.seconds count from
/// then; `stop` is asked every 20 ms and ends it when true. Any thread but the servo's; a program that has
/// ended is not waited for longer because a process of its own holds its output.
[[nodiscard]] ProcessAnswer answerOf(const std::function<pid_t(int output)>& begin,
                                     const ProcessLimits& limits, uint64_t maxOutput,
                                     const std::function<bool()>& stop);

/// answerOf a program that startLimited starts. `input` becomes its standard input.
[[nodiscard]] ProcessAnswer askProcess(const std::string& program, const std::vector<std::string>& arguments,
                                       const ProcessLimits& limits, const FileDescriptor& input,
                                       uint64_t maxOutput, const std::function<bool()>& stop);

/// The same for a program that writes to the file `output` instead, whose size limits.fileSize bounds; the
/// answer has no bytes.
[[nodiscard]] ProcessAnswer askProcessInto(const FileDescriptor& output, const std::string& program,
                                           const std::vector<std::string>& arguments,
                                           const ProcessLimits& limits, const FileDescriptor& input,
                                           const std::function<bool()>& stop);

} // namespace touchstone
