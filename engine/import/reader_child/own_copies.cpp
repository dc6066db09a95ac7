#include "engine/import/reader_child/own_copies.h"

#include "engine/process/passed_streams.h"
#include "engine/process/resource_limit.h"

#include <sched.h>
#include <signal.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <optional>

namespace touchstone {

namespace {

/// In the copy. The parent gets its process number from itself, so that none is lost where the process that
/// was copied is killed. After that standard input is no longer the socket: a copy that reads must not have
/// it.
bool takeQuestion(const PassedStreams::Descriptors& streams, unsigned processorSeconds) {
    const pid_t self = getpid();
    if (send(STDIN_FILENO, &self, sizeof self, MSG_NOSIGNAL) != sizeof self)
        return false;
    lowerLimit(RLIMIT_CPU, processorSeconds, 1); // SIGXCPU, then SIGKILL
    return dup2(streams[0], STDIN_FILENO) >= 0 && dup2(streams[1], STDOUT_FILENO) >= 0;
}

} // namespace

void becomeCopies(unsigned processorSeconds) {
    while (const auto streams = PassedStreams().receive(STDIN_FILENO)) {
        // As fork does, but a child of our parent (CLONE_PARENT), which can wait for it.
        const auto copy = static_cast<pid_t>(
            syscall(SYS_clone, CLONE_PARENT | SIGCHLD, nullptr, nullptr, nullptr, nullptr));
        if (copy == 0 && !takeQuestion(*streams, processorSeconds))
            _exit(1);
        for (const int descriptor : *streams)
            close(descriptor);
        if (copy == 0)
            return;
        if (copy < 0)
            break;
    }
    _exit(0);
}

} // namespace touchstone
