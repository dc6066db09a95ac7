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

  private:
    int release();
    int descriptor_;
};

/// A file in memory with these bytes, read from its beginning, which nobody can change; none where the system
/// has no memory for it.
[[nodiscard]] FileDescriptor memoryFile(std::span<const uint8_t> bytes);

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

/// Runs a program (as startLimited does) to its end and returns its output, at most `maxOutput` bytes.
/// `input` becomes its standard input. `stop` is asked every 20 ms and ends it when true. Any thread but the
/// servo's; a program that has ended is not waited for longer because a process of its own holds its output.
[[nodiscard]] ProcessAnswer askProcess(const std::string& program, const std::vector<std::string>& arguments,
                                       const ProcessLimits& limits, const FileDescriptor& input,
                                       uint64_t maxOutput, const std::function<bool()>& stop);

/// A program that has been started and waits for its input. One thread, with which it ends; killed at the end
/// of its life. limits.seconds count from `ask`.
class WaitingProcess {
  public:
    WaitingProcess(const std::string& program, const std::vector<std::string>& arguments,
                   const ProcessLimits& limits);
    ~WaitingProcess();
    WaitingProcess(const WaitingProcess&) = delete;
    WaitingProcess& operator=(const WaitingProcess&) = delete;

    /// Writes `input` to its standard input, ends that, and returns the output, as askProcess does. Once.
    [[nodiscard]] ProcessAnswer ask(std::span<const uint8_t> input, uint64_t maxOutput,
                                    const std::function<bool()>& stop);

  private:
    FileDescriptor input_, output_;
    pid_t pid_ = -1; ///< -1: there is no process
    ProcessLimits limits_;
};

/// The same for a program that writes to the file `output` instead, whose size limits.fileSize bounds; the
/// answer has no bytes.
[[nodiscard]] ProcessAnswer askProcessInto(const FileDescriptor& output, const std::string& program,
                                           const std::vector<std::string>& arguments,
                                           const ProcessLimits& limits, const FileDescriptor& input,
                                           const std::function<bool()>& stop);

} // namespace touchstone
