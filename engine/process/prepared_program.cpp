#include "engine/process/prepared_program.h"

#include "engine/process/passed_streams.h"

#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <utility>

namespace touchstone {

namespace {

/// Kills it and waits for it.
void killAndWait(pid_t pid) {
    kill(pid, SIGKILL);
    while (waitpid(pid, nullptr, 0) < 0 && errno == EINTR) {
    }
}

/// The number of the copy, where it has come.
pid_t receivedCopy(int socket) {
    pid_t copy = -1;
    return recv(socket, &copy, sizeof copy, MSG_DONTWAIT) == sizeof copy ? copy : -1;
}

} // namespace

PreparedProgram::~PreparedProgram() {
    end();
}

bool PreparedProgram::runs() {
    if (pid_ >= 0 && owner_ != getpid()) {
        socket_.close();
        pid_ = -1;
    }
    return pid_ >= 0;
}

void PreparedProgram::end() {
    if (!runs())
        return;
    killAndWait(pid_);
    pid_ = -1;
    // A copy that it began and nobody waits for.
    if (const pid_t copy = receivedCopy(socket_.get()); copy > 0)
        killAndWait(copy);
    socket_.close();
}

void PreparedProgram::start() {
    const std::lock_guard lock(mutex_);
    if (runs())
        return;
    int ends[2] = {-1, -1};
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        return;
    socket_ = FileDescriptor(ends[0]);
    const FileDescriptor theirs(ends[1]);
    ProcessLimits limits = limits_;
    limits.endsWithThread = false; // the next question may come from another
    owner_ = getpid();
    pid_ = startLimited(program_.string(), {program_.filename().string(), "--copies"}, limits,
                        {.input = theirs.get()});
}

/// -1: there is none.
pid_t PreparedProgram::copyFor(int input, int output, const std::function<bool()>& stop) {
    const std::lock_guard lock(mutex_);
    if (!runs())
        return -1;
    const auto due = std::chrono::steady_clock::now() + std::chrono::seconds(limits_.seconds);
    bool waits = PassedStreams().send(socket_.get(), input, output);
    while (waits) {
        pollfd ready{.fd = socket_.get(), .events = POLLIN, .revents = 0};
        poll(&ready, 1, kStopInterval);
        if (ready.revents != 0) {
            const pid_t copy = receivedCopy(socket_.get());
            if (copy > 0)
                return copy;
            waits = false;
        } else if (stop() || std::chrono::steady_clock::now() >= due) {
            waits = false;
        }
    }
    end();
    return -1;
}

ProcessAnswer PreparedProgram::ask(const FileDescriptor& input, uint64_t maxOutput,
                                   const std::function<bool()>& stop) {
    start();
    return answerOf(
        [&](int output) {
            const pid_t copy = copyFor(input.get(), output, stop);
            return copy > 0 ? copy
                            : startLimited(program_.string(), {program_.filename().string()}, limits_,
                                           {.input = input.get(), .output = output});
        },
        limits_, maxOutput, stop);
}

} // namespace touchstone
