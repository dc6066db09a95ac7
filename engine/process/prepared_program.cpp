#include "engine/process/prepared_program.h"

#include "engine/process/child.h"
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

/// Then it is started anew for each question: it does not know copies, or the system forbids them.
constexpr unsigned kMostFailures = 2;

/// The process number that a copy has sent, at most `wait` ms from now; -1: there is none.
pid_t receivedCopy(int socket, int wait) {
    pollfd ready{.fd = socket, .events = POLLIN, .revents = 0};
    pid_t copy = -1;
    return poll(&ready, 1, wait) > 0 && recv(socket, &copy, sizeof copy, MSG_DONTWAIT) == sizeof copy ? copy
                                                                                                      : -1;
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
    pollfd ended{.fd = process_.get(), .events = POLLIN, .revents = 0};
    if (owner_ != getpid() || crashed_.exchange(false) || poll(&ended, 1, 0) > 0)
        end();
    return socket_.get() >= 0;
}

void PreparedProgram::end() {
    if (socket_.get() < 0)
        return;
    if (owner_ != getpid()) { // a child, which may have closed all descriptors: their numbers may be others'
        (void)socket_.release();
        (void)process_.release();
        return;
    }
    // By descriptor: where somebody else has waited for it, its number may be another's. (By syscall: glibc
    // 2.36 declares the functions without extern "C".)
    if (process_.get() < 0) {
        const Child killed(pid_);
    } else {
        syscall(SYS_pidfd_send_signal, process_.get(), SIGKILL, nullptr, 0);
        siginfo_t how;
        while (waitid(P_PIDFD, static_cast<id_t>(process_.get()), &how, WEXITED) < 0 && errno == EINTR) {
        }
    }
    // A copy for which nobody waits: it sends its number before it lets go of the socket.
    constexpr int kPatience = 1000; // ms
    if (const pid_t copy = receivedCopy(socket_.get(), kPatience); copy > 0)
        const Child killed(copy);
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
    limits.endsWithThread = false;                                  // the next question may come from another
    limits.processorSeconds = std::numeric_limits<unsigned>::max(); // it works for a moment in each question
    owner_ = getpid();
    pid_ = startLimited(program_.string(),
                        {program_.filename().string(), "--copies", std::to_string(limits_.processorSeconds)},
                        limits, {.input = theirs.get()});
    if (pid_ > 0)
        process_ = FileDescriptor(static_cast<int>(syscall(SYS_pidfd_open, pid_, 0)));
    else
        socket_.close();
}

/// -1: there is none.
pid_t PreparedProgram::copyFor(int input, int output, const std::function<bool()>& stop) {
    const auto due = std::chrono::steady_clock::now() + std::chrono::seconds(limits_.seconds);
    const auto isDue = [&] { return std::chrono::steady_clock::now() >= due; };
    // Another thread may wait for the program to be ready.
    while (!mutex_.try_lock()) {
        if (stop() || isDue())
            return -1;
        poll(nullptr, 0, 1);
    }
    const std::lock_guard lock(mutex_, std::adopt_lock);
    startUnlessItRuns();
    if (socket_.get() < 0)
        return -1;
    // A process number that comes later must not be taken for the next question's.
    AtEnd ending{[this] { end(); }};
    pid_t copy = -1;
    if (PassedStreams().send(socket_.get(), input, output)) {
        pollfd ready{.fd = socket_.get(), .events = POLLIN, .revents = 0};
        while (poll(&ready, 1, kStopInterval) <= 0 && !isDue())
            if (stop())
                return -1;
        copy = receivedCopy(socket_.get(), 0);
    }
    if (copy <= 0) {
        failures_ += gives_ ? 0 : 1;
        return -1;
    }
    // It has the priority of the program, which a thread with a higher one may have started.
    setpriority(PRIO_PROCESS, static_cast<id_t>(copy), getpriority(PRIO_PROCESS, 0));
    ending.wanted = false;
    gives_ = true;
    return copy;
}

ProcessAnswer PreparedProgram::ask(const FileDescriptor& input, uint64_t maxOutput,
                                   const std::function<bool()>& stop) {
    using enum ProcessAnswer::End;
    ProcessAnswer answer =
        answerOf([&](int output) { return copyFor(input.get(), output, stop); }, limits_, maxOutput, stop);
    if (answer.end == NotStarted && stop()) {
        answer.end = Stopped;
    } else if (answer.end == NotStarted) {
        answer =
            askProcess(program_.string(), {program_.filename().string()}, limits_, input, maxOutput, stop);
    } else if (answer.end == Killed && answer.status != SIGXCPU) {
        // All copies have the same layout of memory. What made one crash does not get another try at it.
        crashed_ = true;
    }
    return answer;
}

} // namespace touchstone
