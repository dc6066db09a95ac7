#pragma once
// Programs of ours that do once what is the same for each question.

#include "engine/process/process_answer.h"

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>

namespace touchstone {

/// A helper program that starts with "--copies", gets ready, and gives each question a copy of itself
/// (engine/import/reader_child/own_copies.h): a process of its own with the limits, as startLimited's, which
/// has what the program made ready. It starts with the first question, lives on without work, and ends with
/// this object or this process. Where it has ended, by its limits or otherwise, the next question starts it
/// again. Any thread but the servo's.
class PreparedProgram {
  public:
    /// limits.seconds are for one question, limits.processorSeconds for one copy and for all that the program
    /// itself does.
    PreparedProgram(std::filesystem::path program, const ProcessLimits& limits)
        : program_(std::move(program)), limits_(limits) {}
    ~PreparedProgram();
    PreparedProgram(const PreparedProgram&) = delete;
    PreparedProgram& operator=(const PreparedProgram&) = delete;

    [[nodiscard]] const std::filesystem::path& program() const { return program_; }
    [[nodiscard]] const ProcessLimits& limits() const { return limits_; }

    /// Starts it where it does not run; does not wait until it is ready.
    void start();
    /// As askProcess does, by a copy; where there is none to be had, by the program started anew. A copy ends
    /// with this call; if this process is killed meanwhile, when its processor time is over.
    [[nodiscard]] ProcessAnswer ask(const FileDescriptor& input, uint64_t maxOutput,
                                    const std::function<bool()>& stop);

  private:
    pid_t copyFor(int input, int output, const std::function<bool()>& stop);
    bool runs();
    void end();

    std::filesystem::path program_;
    ProcessLimits limits_;
    std::mutex mutex_;
    // By mutex_.
    FileDescriptor socket_; ///< to the program; none: it does not run
    pid_t pid_ = -1;        ///< of the program
    pid_t owner_ = -1;      ///< who started it: a copy of this process, by fork, starts its own
};

} // namespace touchstone
