// A helper program that answers by copies of itself: the compiler of haptic programs.

#include "engine/core/progress.h"
#include "engine/process/prepared_program.h"
#include "tests/unit/programs/program_bench.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace touchstone::program {
namespace {

constexpr uint64_t kMost = uint64_t{4} << 20;
const std::function<bool()> kNever = [] { return false; };

std::string wholeFile(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Children of this process that answer by copies, and the copies: they have the same command line.
std::set<pid_t> compilers() {
    const std::string child = "\nPPid:\t" + std::to_string(getpid()) + "\n";
    std::set<pid_t> found;
    for (const auto& entry : std::filesystem::directory_iterator("/proc"))
        if (wholeFile(entry.path() / "status").find(child) != std::string::npos &&
            wholeFile(entry.path() / "cmdline").find("--copies") != std::string::npos)
            found.insert(std::stoi(entry.path().filename().string()));
    return found;
}

std::string statusOf(pid_t process) {
    return wholeFile("/proc/" + std::to_string(process) + "/status");
}
/// Filters of its system calls.
int filters(pid_t process) {
    const std::string status = statusOf(process), name = "\nSeccomp_filters:\t";
    const size_t at = status.find(name);
    return at == std::string::npos ? 0 : std::atoi(status.c_str() + at + name.size());
}
/// Whether the system filters its calls, beyond what this process has anyway.
bool isInSandbox(pid_t process) {
    return filters(process) > filters(getpid());
}

FileDescriptor questionOf(const std::string& text) {
    const std::string whole = std::string("test.glsl") + '\0' + '\0' + text + '\0';
    return memoryFile({reinterpret_cast<const uint8_t*>(whole.data()), whole.size()});
}

/// One that takes seconds: each function calls the one before twice, and all are inlined.
std::string longProgram() {
    std::string text = "float f0(float x) { return sin(x) * x + 1.0; }\n";
    constexpr int kDeep = 14;
    for (int i = 1; i <= kDeep; ++i) {
        const std::string before = "f" + std::to_string(i - 1);
        text += "float f" + std::to_string(i) + "(float x) { return " + before + "(x) + " + before +
                "(x + 1.0); }\n";
    }
    return text + touchBody("after.stiffness = f" + std::to_string(kDeep) + "(before.position.x);");
}

PreparedProgram ownCompiler() {
    return {installedProgramCompiler().program(), installedProgramCompiler().limits()};
}

void expectCompiles(PreparedProgram& compiler, const std::string& text = touchBody("")) {
    EXPECT_FALSE(compileProgram(readProgramSource("test.glsl", text), compiler, kNever).empty());
}

TEST(PreparedProgram, ItsCopiesAnswerAsTheProgramStartedAnewDoes) {
    size_t compared = 0;
    for (const auto& entry : std::filesystem::directory_iterator(TOUCHSTONE_SOURCE "/assets/programs")) {
        const ProgramSource source =
            readProgramSource(entry.path().filename().string(), wholeFile(entry.path()));
        const std::string question =
            source.name + '\0' + declarationOf(source.parameters) + '\0' + source.text + '\0';
        const auto input = [&] {
            return memoryFile({reinterpret_cast<const uint8_t*>(question.data()), question.size()});
        };
        PreparedProgram& compiler = installedProgramCompiler();
        const ProcessAnswer copy = compiler.ask(input(), kMost, kNever),
                            anew = askProcess(compiler.program().string(), {"compiler"}, compiler.limits(),
                                              input(), kMost, kNever);
        EXPECT_EQ(anew.end, ProcessAnswer::End::Exited);
        EXPECT_EQ(anew.status, 0);
        EXPECT_EQ(copy.end, anew.end);
        EXPECT_EQ(copy.status, anew.status);
        EXPECT_EQ(copy.output, anew.output) << entry.path();
        ++compared;
    }
    EXPECT_GT(compared, 5u);
}

TEST(PreparedProgram, AnswersManyThreadsAtOnceEachItsOwn) {
    PreparedProgram compiler = ownCompiler();
    std::vector<std::thread> threads;
    std::vector<std::string> messages(8);
    for (size_t i = 0; i < messages.size(); ++i)
        threads.emplace_back([&, i] {
            for (int again = 0; again < 3; ++again) {
                // The message says which of them it is the answer to.
                const ProcessAnswer answer =
                    compiler.ask(questionOf(touchBody("after.stiffness = unknown" + std::to_string(i) + ";")),
                                 kMost, kNever);
                messages[i] += std::string(answer.output.begin(), answer.output.end());
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    for (size_t i = 0; i < messages.size(); ++i)
        for (size_t other = 0; other < messages.size(); ++other)
            EXPECT_EQ(messages[i].find("unknown" + std::to_string(other)) != std::string::npos, i == other);
}

TEST(PreparedProgram, LivesLongerThanTheThreadThatStartedIt) {
    PreparedProgram compiler = ownCompiler();
    const std::set<pid_t> before = compilers();
    std::thread([&] { expectCompiles(compiler); }).join();
    const std::set<pid_t> one = compilers();
    EXPECT_EQ(one.size(), before.size() + 1);
    expectCompiles(compiler);
    EXPECT_EQ(compilers(), one) << "the same has answered again";
}

TEST(PreparedProgram, EndsWithItsObject) {
    const std::set<pid_t> before = compilers();
    {
        PreparedProgram compiler = ownCompiler();
        expectCompiles(compiler);
        EXPECT_EQ(compilers().size(), before.size() + 1);
    }
    EXPECT_EQ(compilers(), before);
}

TEST(PreparedProgram, StartsAgainWhereItHasDied) {
    PreparedProgram compiler = ownCompiler();
    const std::set<pid_t> before = compilers();
    for (int again = 0; again < 2; ++again) {
        expectCompiles(compiler);
        for (const pid_t one : compilers())
            if (!before.contains(one))
                kill(one, SIGKILL);
    }
    expectCompiles(compiler);
    expectCompiles(compiler);
    EXPECT_EQ(compilers().size(), before.size() + 1);
}

TEST(PreparedProgram, WhatKnowsNoCopiesIsStartedForEachQuestion) {
    PreparedProgram shell("/bin/sh", {});
    const std::string script = "echo one answer; exit 3";
    for (int again = 0; again < 2; ++again) {
        const ProcessAnswer answer = shell.ask(
            memoryFile({reinterpret_cast<const uint8_t*>(script.data()), script.size()}), kMost, kNever);
        EXPECT_EQ(answer.end, ProcessAnswer::End::Exited);
        EXPECT_EQ(answer.status, 3);
        EXPECT_EQ(std::string(answer.output.begin(), answer.output.end()), "one answer\n");
    }
}

/// One that compiles for seconds, in a thread of its own.
class LongQuestion {
  public:
    /// `niceness`: of the thread that asks.
    explicit LongQuestion(PreparedProgram& compiler, int niceness = 0)
        : before_(compilers()), asker_([this, &compiler, niceness] {
              setpriority(PRIO_PROCESS, 0, niceness);
              answer_ = compiler.ask(questionOf(longProgram()), kMost, [this] { return stop_.load(); });
          }) {}
    ~LongQuestion() { (void)end(); }
    LongQuestion(const LongQuestion&) = delete;
    LongQuestion& operator=(const LongQuestion&) = delete;

    /// The copy that answers it, once it reads; -1: there is none.
    [[nodiscard]] pid_t copy() const {
        for (int i = 0; i < 5000; ++i) {
            for (const pid_t one : compilers())
                if (!before_.contains(one) && isInSandbox(one))
                    return one;
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        }
        return -1;
    }
    /// Waits for the answer, and stops it.
    ProcessAnswer end(bool stop = true) {
        stop_ = stop;
        if (asker_.joinable())
            asker_.join();
        return answer_;
    }

  private:
    std::set<pid_t> before_;
    std::atomic<bool> stop_{false};
    ProcessAnswer answer_;
    std::thread asker_;
};

TEST(PreparedProgram, OnlyItsCopiesReadAndTheyDoSoInTheSandbox) {
    PreparedProgram compiler = ownCompiler();
    const std::set<pid_t> others = compilers();
    expectCompiles(compiler);
    const std::set<pid_t> before = compilers();
    ASSERT_EQ(before.size(), others.size() + 1);
    LongQuestion question(compiler);
    EXPECT_GT(question.copy(), 0);
    for (const pid_t one : before)
        EXPECT_TRUE(others.contains(one) || !isInSandbox(one)) << "it would not get another copy";
    EXPECT_EQ(question.end().end, ProcessAnswer::End::Stopped);
    EXPECT_EQ(compilers(), before) << "the copy has gone with the question";
}

TEST(PreparedProgram, ACopyHasThePriorityOfWhoAsks) {
    PreparedProgram compiler = ownCompiler();
    expectCompiles(compiler);
    const int own = getpriority(PRIO_PROCESS, 0), lower = std::min(own + 5, 19);
    for (const int niceness : {own, lower, own}) {
        LongQuestion question(compiler, niceness);
        const pid_t copy = question.copy();
        ASSERT_GT(copy, 0);
        // Set by the asker, once it has the copy's number.
        for (int i = 0; i < 500 && getpriority(PRIO_PROCESS, static_cast<id_t>(copy)) != niceness; ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
        EXPECT_EQ(getpriority(PRIO_PROCESS, static_cast<id_t>(copy)), niceness);
    }
}

TEST(PreparedProgram, WhereACopyHasCrashedTheNextHasAnotherLayoutOfMemory) {
    PreparedProgram compiler = ownCompiler();
    expectCompiles(compiler);
    const std::set<pid_t> before = compilers();
    LongQuestion question(compiler);
    const pid_t copy = question.copy();
    ASSERT_GT(copy, 0);
    kill(copy, SIGABRT); // which no sanitizer handles
    const ProcessAnswer answer = question.end(false);
    EXPECT_EQ(answer.end, ProcessAnswer::End::Killed);
    EXPECT_EQ(answer.status, SIGABRT);
    expectCompiles(compiler);
    const std::set<pid_t> after = compilers();
    EXPECT_EQ(after.size(), before.size());
    EXPECT_NE(after, before) << "another process";
}

/// A program that never gets ready.
TEST(PreparedProgram, WhoWaitsForACopyIsStoppedOrWaitsAsLongAsTheLimitSays) {
    const std::filesystem::path folder =
        std::filesystem::temp_directory_path() / ("touchstone_prepared_" + std::to_string(getpid()));
    std::filesystem::create_directory(folder);
    std::ofstream(folder / "program") << "#!/bin/sh\nexec sleep 1000\n";
    std::filesystem::permissions(folder / "program", std::filesystem::perms::owner_all);
    {
        ProcessLimits limits;
        limits.seconds = 1;
        PreparedProgram slow(folder / "program", limits);
        std::atomic<int> asked{0};
        EXPECT_EQ(slow.ask(questionOf(""), kMost, [&] { return ++asked > 3; }).end,
                  ProcessAnswer::End::Stopped);
        // A second one waits for the first one's lock.
        ProcessAnswer first;
        std::thread asker([&] { first = slow.ask(questionOf(""), kMost, kNever); });
        EXPECT_EQ(slow.ask(questionOf(""), kMost, [&] { return ++asked > 6; }).end,
                  ProcessAnswer::End::Stopped);
        asker.join();
        EXPECT_EQ(first.end, ProcessAnswer::End::TooSlow);
    }
    std::filesystem::remove_all(folder);
}

TEST(PreparedProgram, ACopyHasTheLimitsAndItsEndIsNotTheOthers) {
    ProcessLimits limits = installedProgramCompiler().limits();
    limits.processorSeconds = 1;
    PreparedProgram compiler(installedProgramCompiler().program(), limits);
    expectCompiles(compiler);
    const std::set<pid_t> before = compilers();
    const ProcessAnswer answer = compiler.ask(questionOf(longProgram()), kMost, kNever);
    EXPECT_EQ(answer.end, ProcessAnswer::End::Killed);
    EXPECT_EQ(answer.status, SIGXCPU);
    expectCompiles(compiler);
    EXPECT_EQ(compilers(), before);
}

TEST(PreparedProgram, ACopyOfThisProcessStartsItsOwn) {
    PreparedProgram compiler = ownCompiler();
    expectCompiles(compiler);
    const std::set<pid_t> before = compilers();
    const pid_t copy = fork();
    if (copy == 0) {
        try {
            expectCompiles(compiler);
            _exit(compilers().size() == 1 && !testing::Test::HasFailure() ? 0 : 1);
        } catch (...) {
            _exit(2);
        }
    }
    int status = -1;
    waitpid(copy, &status, 0);
    EXPECT_EQ(status, 0);
    expectCompiles(compiler);
    EXPECT_EQ(compilers(), before);
}

TEST(PreparedProgram, EndsWithTheProcessHoweverThatEnds) {
    int ends[2] = {-1, -1};
    ASSERT_EQ(pipe2(ends, O_CLOEXEC), 0);
    const pid_t copy = fork();
    if (copy == 0) {
        try {
            PreparedProgram compiler = ownCompiler();
            expectCompiles(compiler);
            for (const pid_t one : compilers())
                (void)!write(ends[1], &one, sizeof one);
            kill(getpid(), SIGKILL);
        } catch (...) {
        }
        _exit(1);
    }
    close(ends[1]);
    pid_t one = -1;
    ASSERT_EQ(read(ends[0], &one, sizeof one), static_cast<ssize_t>(sizeof one));
    ASSERT_GT(one, 0);
    waitpid(copy, nullptr, 0);
    // Somebody else's child now, who may not have waited for it yet.
    const auto lives = [&] {
        const std::string status = statusOf(one);
        return !status.empty() && status.find("State:\tZ") == std::string::npos;
    };
    for (int i = 0; i < 500 && lives(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    EXPECT_FALSE(lives());
    close(ends[0]);
}

} // namespace
} // namespace touchstone::program
