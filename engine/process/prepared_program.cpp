#include "engine/process/prepared_program.h"

#include "engine/process/passed_streams.h"

#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <limits>
#include <string>

namespace touchstone {

namespace {

// glibc 2.36 declares pidfd_open and pidfd_send_signal without extern "C".

/// Then it is started anew for each question: it does not know copies, or the system forbids them.
constexpr unsigned kMostFailures = 2;

/// The number of the copy, where it has come.
pid_t receivedCopy(int socket) {
    pid_t copy = -1;
    return recv(socket, &copy, sizeof copy, MSG_DONTWAIT) == sizeof copy ? copy : -1;
}

/// Calls a function at the end, unless told not to.
template <class Function>
struct AtEnd {
    Function function;
    bool wanted = true;
    ~AtEnd() {
        if (wanted)
            function();
    }
};

} // namespace

PreparedProgram::~PreparedProgram() {
    const std::lock_guard lock(mutex_);
    end();
}

bool PreparedProgram::runs() {
    if (socket_.get() < 0)
        return false;
    if (owner_ != getpid()) { // and may have closed all descriptors since, so that the numbers are others'
        (void)socket_.release();
        (void)process_.release();
        return false;
    }
    pollfd ended{.fd = process_.get(), .events = POLLIN, .revents = 0};
    if (poll(&ended, 1, 0) > 0)
        end();
    return socket_.get() >= 0;
}

void PreparedProgram::end() {
    if (socket_.get() < 0 || owner_ != getpid())
        return;
    // By descriptors: where somebody else has waited for it, its number may be another's. Without them it
    // ends with the socket.
    if (process_.get() >= 0) {
        syscall(SYS_pidfd_send_signal, process_.get(), SIGKILL, nullptr, 0);
        siginfo_t how;
        while (waitid(P_PIDFD, static_cast<id_t>(process_.get()), &how, WEXITED) < 0 && errno == EINTR) {
        }
    }
    if (const pid_t copy = receivedCopy(socket_.get()); copy > 0) { // nobody waits for it
        kill(copy, SIGKILL);
        while (waitpid(copy, nullptr, 0) < 0 && errno == EINTR) {
        }
    }
    socket_.close();
    process_.close();
}

void PreparedProgram::start() {
    const std::lock_guard lock(mutex_);
    startUnlessItRuns();
}

void PreparedProgram::startUnlessItRuns() {
    int ends[2] = {-1, -1};
    if (runs() || failures_ >= kMostFailures ||
        socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
        return;
    socket_ = FileDescriptor(ends[0]);
    const FileDescriptor theirs(ends[1]);
    ProcessLimits limits = limits_;
    limits.endsWithThread = false; // the next question may come from another
    // It works for a moment in each question, and must not be killed between a copy and its number.
    limits.processorSeconds = std::numeric_limits<unsigned>::max();
    owner_ = getpid();
    const pid_t pid =
        startLimited(program_.string(),
                     {program_.filename().string(), "--copies", std::to_string(limits_.processorSeconds)},
                     limits, {.input = theirs.get()});
    process_ = FileDescriptor(pid > 0 ? static_cast<int>(syscall(SYS_pidfd_open, pid, 0)) : -1);
}

/// -1: there is none.
pid_t PreparedProgram::copyFor(int input, int output, const std::function<bool()>& stop) {
    const auto due = std::chrono::steady_clock::now() + std::chrono::seconds(limits_.seconds);
    const auto givesUp = [&] { return stop() || std::chrono::steady_clock::now() >= due; };
    // Another thread may wait for the program to be ready.
    while (!mutex_.try_lock()) {
        if (givesUp())
            return -1;
        poll(nullptr, 0, 1);
    }
    const std::lock_guard lock(mutex_, std::adopt_lock);
    startUnlessItRuns();
    if (socket_.get() < 0)
        return -1;
    // A number that comes later must not be taken for the next question's.
    AtEnd ending{[this] { end(); }};
    bool waits = PassedStreams().send(socket_.get(), input, output);
    while (waits) {
        pollfd ready{.fd = socket_.get(), .events = POLLIN, .revents = 0};
        poll(&ready, 1, kStopInterval);
        if (ready.revents == 0) {
            if (givesUp())
                return -1;
            continue;
        }
        const pid_t copy = receivedCopy(socket_.get());
        waits = false;
        if (copy > 0) {
            // It has the program's, who may have been started by somebody more urgent.
            setpriority(PRIO_PROCESS, static_cast<id_t>(copy), getpriority(PRIO_PROCESS, 0));
            ending.wanted = false;
            failures_ = 0;
            return copy;
        }
    }
    ++failures_;
    return -1;
}

ProcessAnswer PreparedProgram::ask(const FileDescriptor& input, uint64_t maxOutput,
                                   const std::function<bool()>& stop) {
    using enum ProcessAnswer::End;
    ProcessAnswer answer =
        answerOf([&](int output) { return copyFor(input.get(), output, stop); }, limits_, maxOutput, stop);
    if (answer.end == NotStarted) {
        if (stop())
            answer.end = Stopped;
        else
            answer = askProcess(program_.string(), {program_.filename().string()}, limits_, input, maxOutput,
                                stop);
    } else if (answer.end == Killed && answer.status != SIGXCPU) {
        // All copies have the same layout of memory. What made one crash does not get another try at it.
        const std::lock_guard lock(mutex_);
        end();
    }
    return answer;
}

} // namespace touchstone
