#pragma once
// Programs of ours that do once what is the same for each question.

#include "engine/process/process_answer.h"

#include <sys/types.h>

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <utility>

namespace touchstone {

/// A helper program that starts with "--copies SECONDS", gets ready, and then answers each question by a copy
/// of itself (engine/import/reader_child/own_copies.h): a child of this process, within the same limits, with
/// all that the program has prepared. The program starts with the first question, with the priority of the
/// thread that asks; it reads no question itself. It ends with this object, or with the last process that
/// has its socket: this one, and children that were forked from it and run nothing else. Where it has ended
/// before, the next question starts it again. Any thread but the servo's.
class PreparedProgram {
  public:
    /// limits.seconds are for the wait for a copy, and again for its answer, or that of the program started
    /// anew; limits.processorSeconds are the copy's.
    PreparedProgram(std::filesystem::path program, const ProcessLimits& limits)
        : program_(std::move(program)), limits_(limits) {}
    ~PreparedProgram();
    PreparedProgram(const PreparedProgram&) = delete;
    PreparedProgram& operator=(const PreparedProgram&) = delete;

    [[nodiscard]] const std::filesystem::path& program() const { return program_; }
    [[nodiscard]] const ProcessLimits& limits() const { return limits_; }

    /// Starts it where it does not run; does not wait until it is ready.
    void start();
    /// As askProcess does, by a copy, or where there is none to be had by the program started anew. The copy
    /// has at most the priority of the thread that asks. The copy ends before this returns; where this
    /// process is killed meanwhile, at the end of its work or of its processor time.
    [[nodiscard]] ProcessAnswer ask(const FileDescriptor& input, uint64_t maxOutput,
                                    const std::function<bool()>& stop);

  private:
    pid_t copyFor(int input, int output, const std::function<bool()>& stop);
    // With mutex_ held:
    void startUnlessItRuns();
    bool runs();
    void end();

    std::filesystem::path program_;
    ProcessLimits limits_;
    std::mutex mutex_;
    // By mutex_.
    FileDescriptor socket_;  ///< to the program; none: it has not started
    FileDescriptor process_; ///< the program; none: the system has no such descriptors
    pid_t pid_ = -1;         ///< of the program
    pid_t owner_ = -1;       ///< who started it: a child of this process, by fork, starts its own
    bool gives_ = false;     ///< it has given a copy, ever
    unsigned failures_ = 0;  ///< to give a copy, before it ever gave one

    std::atomic<bool> crashed_{false}; ///< a copy has
};

} // namespace touchstone
