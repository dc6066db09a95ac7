// Programs that a test starts end with it, however it ends.

#include "tests/support/program.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <string>
#include <thread>

namespace touchstone::test {
namespace {

/// It runs, or could: a zombie, which nobody has awaited, has ended.
bool lives(const std::string& process) {
    const std::string stat = readFile("/proc/" + process + "/stat");
    const size_t name = stat.rfind(')'); // which may contain anything
    return name != std::string::npos && name + 2 < stat.size() && stat[name + 2] != 'Z';
}

TEST(BackgroundProgram, EndsWithATestThatCrashes) {
    const ScratchFolder scratch;
    const std::filesystem::path file = scratch / "process";
    const auto started = [&] {
        const std::string number = readFile(file);
        return number.substr(0, number.find('\n')); // empty until it has written
    };
    const pid_t test = fork();
    ASSERT_GE(test, 0);
    if (test == 0) {
        const BackgroundProgram sleeper({"sh", "-c", "echo $$ > " + file.string() + "; exec sleep 600"}, {},
                                        scratch / "log");
        for (;;)
            pause(); // until it is killed
    }
    for (int i = 0; i < 500 && started().empty(); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::string sleeper = started();
    ASSERT_FALSE(sleeper.empty());
    EXPECT_TRUE(lives(sleeper));
    ASSERT_EQ(kill(test, SIGKILL), 0);
    ASSERT_EQ(waitpid(test, nullptr, 0), test);
    for (int i = 0; i < 500 && lives(sleeper); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_FALSE(lives(sleeper)) << "process " << sleeper;
}

} // namespace
} // namespace touchstone::test
