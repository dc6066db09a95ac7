#include "workbench/gallery/limited_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <string_view>

namespace touchstone {

namespace {

struct Start {
    const char* program;
    char* const* arguments;
    ProcessLimits limits;
    pid_t parent;
    sigset_t signals; ///< the caller's
};

void limit(decltype(RLIMIT_CORE) what, rlim_t most) {
    const rlimit both{most, most};
    setrlimit(what, &both); // a lower existing limit is kept
}

/// In the child, which shares our memory until exec: system calls only.
[[noreturn]] void become(const Start& start) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != start.parent)
        _exit(kCannotStart); // the parent ended before this call
    limit(RLIMIT_CPU, start.limits.processorSeconds);
    limit(RLIMIT_DATA, start.limits.memory);
    limit(RLIMIT_CORE, 0);
    constexpr std::string_view kFirst = "1000";
    if (const int score = open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC); score >= 0) {
        [[maybe_unused]] const ssize_t written = write(score, kFirst.data(), kFirst.size());
        close(score);
    }
    const int nothing = open("/dev/null", O_RDWR | O_CLOEXEC);
    for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        dup2(nothing, stream);
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
                   const ProcessLimits& limits) {
    std::vector<char*> raw;
    for (const std::string& argument : arguments)
        raw.push_back(const_cast<char*>(argument.c_str())); // exec does not write to them
    raw.push_back(nullptr);
    Start start{program.c_str(), raw.data(), limits, getpid(), {}};
    // No handler of ours may run in the child.
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &start.signals);
    const pid_t child = begin(start);
    pthread_sigmask(SIG_SETMASK, &start.signals, nullptr);
    return child;
}

} // namespace touchstone
