#include "engine/process/process_answer.h"

#include "engine/process/child.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <utility>

namespace touchstone {

namespace {

constexpr size_t kBlock = size_t{1} << 18; // bytes read at once

enum class Reading : uint8_t { Waiting, Ended, TooLong };

/// Appends what is in the pipe now.
Reading readAll(int pipe, uint64_t most, std::vector<uint8_t>& block, std::vector<uint8_t>& output) {
    for (;;) {
        const ssize_t got = read(pipe, block.data(), block.size());
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0)
            return errno == EAGAIN ? Reading::Waiting : Reading::Ended;
        if (got == 0)
            return Reading::Ended;
        if (static_cast<uint64_t>(got) > most - output.size())
            return Reading::TooLong;
        output.insert(output.end(), block.begin(), block.begin() + got);
    }
}

/// Of a child that has ended, from what waitpid gives.
void setEnd(ProcessAnswer& answer, int status) {
    using enum ProcessAnswer::End;
    const bool missing = WIFEXITED(status) && WEXITSTATUS(status) == kCannotStart;
    answer.end = missing ? NotStarted : WIFEXITED(status) ? Exited : Killed;
    answer.status = WIFEXITED(status) ? WEXITSTATUS(status) : WTERMSIG(status);
}

/// For the output of a child.
struct OutputPipe {
    FileDescriptor reading, writing;

    bool open() {
        int ends[2] = {-1, -1};
        if (pipe2(ends, O_CLOEXEC) != 0)
            return false;
        reading = FileDescriptor(ends[0]);
        writing = FileDescriptor(ends[1]);
        fcntl(reading.get(), F_SETFL, O_NONBLOCK);
        fcntl(reading.get(), F_SETPIPE_SZ, kBlock);
        return true;
    }
};

ProcessAnswer answerOf(Child& child, const FileDescriptor& reading, const ProcessLimits& limits,
                       uint64_t maxOutput, const std::function<bool()>& stop) {
    using enum ProcessAnswer::End;
    ProcessAnswer answer;
    std::vector<uint8_t> block(kBlock);
    const auto due = std::chrono::steady_clock::now() + std::chrono::seconds(limits.seconds);
    for (bool open = true;;) {
        const bool ended = child.wait(WNOHANG); // before the last reading: what it wrote is in the pipe
        const Reading state = open ? readAll(reading.get(), maxOutput, block, answer.output) : Reading::Ended;
        open = state == Reading::Waiting;
        answer.end = state == Reading::TooLong                 ? TooLong
                     : stop()                                  ? Stopped
                     : std::chrono::steady_clock::now() >= due ? TooSlow
                                                               : NotStarted;
        if (answer.end != NotStarted && !ended)
            return answer; // and kills it
        if (ended)
            break;
        pollfd ready{.fd = open ? reading.get() : -1, .events = POLLIN, .revents = 0};
        poll(&ready, 1, open ? kStopInterval : 1); // a child that has closed its output is about to end
    }
    if (answer.end == TooLong)
        return answer;
    setEnd(answer, child.status());
    return answer;
}

} // namespace

FileDescriptor::~FileDescriptor() {
    close();
}

FileDescriptor& FileDescriptor::operator=(FileDescriptor&& other) noexcept {
    close();
    descriptor_ = other.release();
    return *this;
}

void FileDescriptor::close() {
    if (descriptor_ >= 0)
        ::close(release());
}

int FileDescriptor::release() {
    return std::exchange(descriptor_, -1);
}

FileDescriptor memoryFile(std::span<const uint8_t> bytes) {
    FileDescriptor file(memfd_create("touchstone", MFD_CLOEXEC | MFD_ALLOW_SEALING));
    while (file.get() >= 0 && !bytes.empty()) {
        const ssize_t written = write(file.get(), bytes.data(), std::min(bytes.size(), size_t{1} << 30));
        if (written < 0 && errno == EINTR)
            continue;
        if (written <= 0)
            return FileDescriptor();
        bytes = bytes.subspan(static_cast<size_t>(written));
    }
    if (file.get() >= 0) {
        lseek(file.get(), 0, SEEK_SET);
        fcntl(file.get(), F_ADD_SEALS, F_SEAL_SEAL | F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE);
    }
    return file;
}

ProcessAnswer answerOf(const std::function<pid_t(int)>& begin, const ProcessLimits& limits,
                       uint64_t maxOutput, const std::function<bool()>& stop) {
    OutputPipe pipe;
    if (!pipe.open())
        return {};
    const pid_t pid = begin(pipe.writing.get());
    if (pid < 0)
        return {};
    Child child(pid);
    pipe.writing.close(); // so that the pipe ends with the child
    return answerOf(child, pipe.reading, limits, maxOutput, stop);
}

ProcessAnswer askProcess(const std::string& program, const std::vector<std::string>& arguments,
                         const ProcessLimits& limits, const FileDescriptor& input, uint64_t maxOutput,
                         const std::function<bool()>& stop) {
    return answerOf(
        [&](int output) {
            return startLimited(program, arguments, limits, {.input = input.get(), .output = output});
        },
        limits, maxOutput, stop);
}

ProcessAnswer askProcessInto(const FileDescriptor& output, const std::string& program,
                             const std::vector<std::string>& arguments, const ProcessLimits& limits,
                             const FileDescriptor& input, const std::function<bool()>& stop) {
    using enum ProcessAnswer::End;
    ProcessAnswer answer;
    const pid_t pid =
        startLimited(program, arguments, limits, {.input = input.get(), .output = output.get()});
    if (pid < 0)
        return answer;
    Child child(pid);
    const auto due = std::chrono::steady_clock::now() + std::chrono::seconds(limits.seconds);
    for (int wait = 1; !child.wait(WNOHANG); wait = std::min(2 * wait, kStopInterval)) {
        answer.end = stop() ? Stopped : std::chrono::steady_clock::now() >= due ? TooSlow : NotStarted;
        if (answer.end != NotStarted)
            return answer; // and kills it
        poll(nullptr, 0, wait);
    }
    setEnd(answer, child.status());
    if (answer.end == Killed && answer.status == SIGXFSZ)
        answer.end = TooLong;
    return answer;
}

} // namespace touchstone
