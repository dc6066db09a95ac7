#pragma once

#include <signal.h>
#include <sys/types.h>
#include <sys/wait.h>

#include <cerrno>

namespace touchstone {

/// A child process that is killed and awaited at the end of this object's life, unless it was awaited before.
/// One thread.
class Child {
  public:
    explicit Child(pid_t pid) : pid_(pid) {}
    ~Child() {
        if (running_) {
            kill(pid_, SIGKILL);
            wait(0);
        }
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// Whether it has ended; waits without WNOHANG.
    bool wait(int options) {
        if (!running_)
            return true;
        pid_t ended = 0;
        do
            ended = waitpid(pid_, &status_, options);
        while (ended < 0 && errno == EINTR);
        if (ended < 0) // SIGCHLD is ignored, or another thread has waited for it: how it ended is lost
            status_ = SIGKILL;
        running_ = ended == 0;
        return !running_;
    }
    [[nodiscard]] int status() const { return status_; }

  private:
    pid_t pid_;
    bool running_ = true;
    int status_ = 0;
};

} // namespace touchstone
