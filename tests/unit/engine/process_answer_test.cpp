// What a child process answers, however it ends.

#include "engine/process/process_answer.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <initializer_list>
#include <string>

namespace touchstone::process_answer_test {
namespace {

using End = ProcessAnswer::End;

ProcessAnswer shell(
    const std::string& script, const std::string& input = "", uint64_t maxOutput = 1000,
    const ProcessLimits& limits = {}, const std::function<bool()>& stop = [] { return false; }) {
    const FileDescriptor file = memoryFile({reinterpret_cast<const uint8_t*>(input.data()), input.size()});
    return askProcess("/bin/sh", {"sh", "-c", script}, limits, file, maxOutput, stop);
}

std::string textOf(const ProcessAnswer& answer) {
    return {answer.output.begin(), answer.output.end()};
}

TEST(ProcessAnswer, IsTheOutputAndTheStatus) {
    const ProcessAnswer answer = shell("cat; echo end; echo to nobody >&2; exit 7", "what was sent\n");
    EXPECT_EQ(answer.end, End::Exited);
    EXPECT_EQ(answer.status, 7);
    EXPECT_EQ(textOf(answer), "what was sent\nend\n");
    const ProcessAnswer killed = shell("echo half; kill -TERM $$");
    EXPECT_EQ(killed.end, End::Killed);
    EXPECT_EQ(killed.status, SIGTERM);
    EXPECT_EQ(textOf(killed), "half\n");
    EXPECT_EQ(askProcess("/no/such program", {"no"}, {}, FileDescriptor(), 10, [] { return false; }).end,
              End::NotStarted);
}

TEST(ProcessAnswer, OfManyMegabytesIsWhole) {
    const std::string much(5'000'000, 'x');
    const ProcessAnswer answer = shell("cat", much, 5'000'000);
    EXPECT_EQ(answer.end, End::Exited);
    EXPECT_EQ(answer.output.size(), much.size());
    EXPECT_EQ(shell("cat", much, 4'999'999).end, End::TooLong);
}

TEST(ProcessAnswer, EndsWhereTheProgramDoesNot) {
    EXPECT_EQ(shell("exec sleep 1000", "", 10, {.seconds = 1}).end, End::TooSlow);
    EXPECT_EQ(shell("exec sleep 1000", "", 10, {}, [] { return true; }).end, End::Stopped);
    const ProcessAnswer spinning = shell("while :; do :; done", "", 10, {.processorSeconds = 1});
    EXPECT_EQ(spinning.end, End::Killed);
    EXPECT_EQ(spinning.status, SIGXCPU);
    EXPECT_EQ(shell("exec >&-; exec sleep 1000", "", 10, {.seconds = 1}).end, End::TooSlow)
        << "though its output has ended";
    EXPECT_EQ(shell("sleep 1000 & exit 0").end, End::Exited) << "though another holds its output";
}

/// A caller whose standard streams are closed: the ends of the pipe then have their numbers.
TEST(ProcessAnswer, ComesThroughWhereTheStandardStreamsAreClosed) {
    const auto closed = [](std::initializer_list<int> streams) {
        const pid_t caller = fork();
        if (caller == 0) {
            for (const int stream : streams)
                close(stream);
            const ProcessAnswer answer = shell("cat; echo end", "sent ");
            _exit(answer.end == End::Exited && textOf(answer) == "sent end\n" ? 0 : 1);
        }
        int status = -1;
        waitpid(caller, &status, 0);
        return status;
    };
    EXPECT_EQ(closed({0}), 0);
    EXPECT_EQ(closed({1}), 0);
    EXPECT_EQ(closed({0, 1}), 0);
    EXPECT_EQ(closed({0, 1, 2}), 0);
}

/// The system then waits for children by itself, and their status is lost: that is no success.
TEST(ProcessAnswer, IsKilledWhereItsStatusIsLost) {
    const pid_t caller = fork();
    if (caller == 0) {
        signal(SIGCHLD, SIG_IGN);
        _exit(shell("exit 3").end == End::Killed ? 0 : 1);
    }
    int status = -1;
    waitpid(caller, &status, 0);
    EXPECT_EQ(status, 0);
}

/// What the caller ignores the child ignores; what the caller handles ends the child.
TEST(ProcessAnswer, HasNoHandlerOfTheCallers) {
    const auto before = signal(SIGUSR1, [](int) {});
    const ProcessAnswer answer = shell("kill -USR1 $$; echo alive");
    signal(SIGUSR1, before);
    EXPECT_EQ(answer.end, End::Killed);
    EXPECT_EQ(answer.status, SIGUSR1);
}

TEST(ProcessAnswer, ItsFilesAreLimited) {
    const ProcessAnswer answer = shell(
        "echo x > /proc/self/fd/1; f=$(mktemp); echo x > $f; s=$?; rm $f; exit $s", "", 100, {.fileSize = 0});
    EXPECT_FALSE(answer.end == End::Exited && answer.status == 0) << "a file of one byte is larger than 0";
    EXPECT_EQ(textOf(answer), "x\n") << "a pipe is no file";
    EXPECT_NE(shell("echo more >&0", "constant").status, 0) << "nobody writes into the input";
}

/// A window has more of them open than a reader may have.
TEST(ProcessAnswer, TheLimitOfFilesDoesNotCountTheCallersOwn) {
    std::vector<FileDescriptor> open;
    for (int i = 0; i < 40; ++i)
        open.emplace_back(fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, 0));
    const ProcessAnswer answer = shell("cat", "words\n", 100, {.openFiles = 16});
    EXPECT_EQ(answer.end, End::Exited);
    EXPECT_EQ(answer.status, 0);
    EXPECT_EQ(textOf(answer), "words\n");
}

} // namespace
} // namespace touchstone::process_answer_test
