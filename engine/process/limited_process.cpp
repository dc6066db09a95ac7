#include "engine/process/limited_process.h"

#include "engine/process/resource_limit.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <string_view>

namespace touchstone {

namespace {

struct Start {
    const char* program;
    char* const* arguments;
    ProcessLimits limits;
    ProcessStreams streams;
    pid_t parent;
    sigset_t signals; ///< the caller's
};

/// In the child, whose table of handlers is its own: a handler of ours would run on our memory between the
/// unblocking of the signals and exec. What is ignored stays ignored.
void dropHandlers() {
    for (int number = 1; number < NSIG; ++number) {
        struct sigaction action {};
        if (sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN)
            continue;
        action.sa_handler = SIG_DFL;
        action.sa_flags = 0;
        sigaction(number, &action, nullptr);
    }
}

/// A copy outside of the standard streams: where the caller has closed one of these, a descriptor of ours may
/// have its number, and would be overwritten before it is used.
int beyondStreams(int descriptor, int otherwise) {
    return fcntl(descriptor < 0 ? otherwise : descriptor, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);
}

/// The standard streams; before RLIMIT_NOFILE, since the caller's descriptors take the low numbers until
/// exec.
bool takeStreams(const ProcessStreams& streams) {
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    const int input = beyondStreams(streams.input, nothing), output = beyondStreams(streams.output, nothing),
              error = beyondStreams(-1, nothing);
    return dup2(input, STDIN_FILENO) >= 0 && dup2(output, STDOUT_FILENO) >= 0 &&
           dup2(error, STDERR_FILENO) >= 0;
}

/// In the child, which shares our memory until exec: system calls only.
[[noreturn]] void become(const Start& start) {
    if (start.limits.endsWithThread)
        prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != start.parent)
        _exit(kCannotStart);                                  // the parent ended before this call
    lowerLimit(RLIMIT_CPU, start.limits.processorSeconds, 1); // SIGXCPU, then SIGKILL
    lowerLimit(RLIMIT_DATA, start.limits.memory);
    lowerLimit(RLIMIT_FSIZE, start.limits.fileSize);
    lowerLimit(RLIMIT_CORE, 0);
    constexpr std::string_view kFirst = "1000";
    if (const int score = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC); score >= 0) {
        [[maybe_unused]] const ssize_t written = write(score, kFirst.data(), kFirst.size());
        close(score);
    }
    if (!takeStreams(start.streams))
        _exit(kCannotStart);
    // What others opened without O_CLOEXEC; the table of descriptors is the child's own.
    syscall(SYS_close_range, static_cast<unsigned>(STDERR_FILENO) + 1, ~0u, 0);
    lowerLimit(RLIMIT_NOFILE, start.limits.openFiles);
    dropHandlers();
    sigprocmask(SIG_SETMASK, &start.signals, nullptr);
    execv(start.program, start.arguments);
    _exit(kCannotStart);
}

/// A separate function, so that no variable is live across vfork.
[[gnu::noinline]] pid_t begin(const Start& start) {
    const pid_t child = vfork();
    if (child == 0)
        become(start);
    return child;
}

} // namespace

pid_t startLimited(const std::string& program, const std::vector<std::string>& arguments,
                   const ProcessLimits& limits, const ProcessStreams& streams) {
    std::vector<char*> raw;
    for (const std::string& argument : arguments)
        raw.push_back(const_cast<char*>(argument.c_str())); // exec does not write to them
    raw.push_back(nullptr);
    Start start{program.c_str(), raw.data(), limits, streams, getpid(), {}};
    // No handler of ours may run in the child before it drops them.
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &start.signals);
    const pid_t child = begin(start);
    pthread_sigmask(SIG_SETMASK, &start.signals, nullptr);
    return child;
}

} // namespace touchstone
