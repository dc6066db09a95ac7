#pragma once
// A display that nobody sees, for tests of the window.

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <stdexcept>
#include <string>

namespace touchstone::test {

/// Runs Xvfb for its own life and points DISPLAY to it. Throws when Xvfb is not installed or does not start.
class VirtualDisplay {
  public:
    explicit VirtualDisplay(const std::string& screen = "1600x1000x24") {
        int ready[2];
        if (::pipe(ready) != 0)
            throw std::runtime_error("no pipe");
        process_ = ::fork();
        if (process_ == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGTERM); // it ends with a test that crashes, too
            ::close(ready[0]);
            const int quiet = ::open("/dev/null", O_WRONLY);
            ::dup2(quiet, 2);
            const std::string descriptor = std::to_string(ready[1]);
            ::execlp("Xvfb", "Xvfb", "-displayfd", descriptor.c_str(), "-screen", "0", screen.c_str(),
                     "-nolisten", "tcp", static_cast<char*>(nullptr));
            ::_exit(127);
        }
        ::close(ready[1]);
        // Xvfb writes the number of the display that it took, once it listens; at its end the pipe closes.
        std::string number;
        for (char c = 0; ::read(ready[0], &c, 1) == 1 && c != '\n';)
            number += c;
        ::close(ready[0]);
        if (number.empty()) {
            stop();
            throw std::runtime_error("Xvfb does not start: apt install xvfb");
        }
        name_ = ":" + number;
        ::setenv("DISPLAY", name_.c_str(), 1);
    }
    ~VirtualDisplay() { stop(); }
    VirtualDisplay(const VirtualDisplay&) = delete;
    VirtualDisplay& operator=(const VirtualDisplay&) = delete;

    [[nodiscard]] const std::string& name() const { return name_; }

  private:
    void stop() {
        if (process_ <= 0)
            return;
        ::kill(process_, SIGTERM);
        ::waitpid(process_, nullptr, 0);
        process_ = -1;
    }
    pid_t process_ = -1;
    std::string name_;
};

} // namespace touchstone::test
