#include "tests/support/program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

namespace touchstone::test {

namespace {

/// Starts a program with its output in two files; the files may be the same.
pid_t start(const std::vector<std::string>& arguments, const Environment& environment, const std::string& out,
            const std::string& err) {
    std::vector<char*> argv;
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);
    const pid_t test = getpid(), pid = fork();
    if (pid < 0)
        throw std::runtime_error("fork failed");
    if (pid > 0)
        return pid;
    // A test that crashes runs no destructor: its Xvfb and its windows end with it (with the thread that
    // started them, which here is the test's own).
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != test)
        _exit(127); // it died before
    for (const std::string& variable : environment) {
        const size_t equals = variable.find('=');
        if (equals + 1 == variable.size())
            unsetenv(variable.substr(0, equals).c_str());
        else
            setenv(variable.substr(0, equals).c_str(), variable.substr(equals + 1).c_str(), 1);
    }
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), STDERR_FILENO);
    execvp(argv[0], argv.data());
    _exit(127);
}

int statusOf(int raw) {
    return WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw);
}

/// Waits for at most `limit`, then kills.
int await(pid_t pid, std::chrono::milliseconds limit) {
    const auto end = std::chrono::steady_clock::now() + limit;
    int raw = 0;
    while (waitpid(pid, &raw, WNOHANG) == 0) {
        if (std::chrono::steady_clock::now() > end) {
            kill(pid, SIGKILL);
            waitpid(pid, &raw, 0);
            break;
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return statusOf(raw);
}

} // namespace

ProgramResult runProgram(const std::vector<std::string>& arguments, const Environment& environment,
                         std::chrono::seconds limit) {
    const ScratchFolder scratch;
    Environment own{"XDG_STATE_HOME=" + (scratch / "state").string()}; // not the user's
    own.insert(own.end(), environment.begin(), environment.end());
    const pid_t pid = start(arguments, own, (scratch / "out").string(), (scratch / "err").string());
    ProgramResult result;
    result.status = await(pid, limit);
    result.out = readFile(scratch / "out");
    result.err = readFile(scratch / "err");
    return result;
}

BackgroundProgram::BackgroundProgram(const std::vector<std::string>& arguments,
                                     const Environment& environment, const std::filesystem::path& log)
    : pid_([&] {
          Environment own{"XDG_STATE_HOME=" + (log.parent_path() / "state").string()};
          own.insert(own.end(), environment.begin(), environment.end());
          return start(arguments, own, log.string(), log.string());
      }()) {}

BackgroundProgram::~BackgroundProgram() {
    stop();
}

bool BackgroundProgram::running() {
    if (pid_ < 0)
        return false;
    int raw = 0;
    if (waitpid(pid_, &raw, WNOHANG) == 0)
        return true;
    status_ = statusOf(raw);
    pid_ = -1;
    return false;
}

void BackgroundProgram::send(int signal) {
    if (running())
        kill(pid_, signal);
}

int BackgroundProgram::wait(std::chrono::seconds limit) {
    if (running()) {
        status_ = await(pid_, limit);
        pid_ = -1;
    }
    return status_;
}

int BackgroundProgram::stop() {
    if (running()) {
        kill(pid_, SIGTERM);
        status_ = await(pid_, std::chrono::seconds(60));
        pid_ = -1;
    }
    return status_;
}

ScratchFolder::ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "touchstone-XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr)
        throw std::runtime_error("no temporary folder");
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::string readFile(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void writeTextFile(const std::filesystem::path& file, const std::string& text) {
    std::ofstream(file, std::ios::binary) << text;
}

} // namespace touchstone::test
