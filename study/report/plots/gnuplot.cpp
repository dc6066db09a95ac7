#include "study/report/plots/gnuplot.h"

#include "engine/core/output_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <vector>

namespace touchstone::study {

namespace {

/// Result of a process: its exit status (-1 where it could not be started) and its output.
struct Ended {
    int status = -1;
    std::string said;
};

/// Runs a program of the search path in `folder`, without a shell, with empty input.
Ended run(const std::vector<std::string>& words, const std::filesystem::path& folder) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        return {-1, std::strerror(errno)};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    std::vector<std::string> copies = words;
    std::vector<char*> arguments;
    for (std::string& word : copies)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    pid_t child = 0;
    const int failed = posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    Ended ended;
    if (failed != 0) {
        close(ends[0]);
        return {-1, std::strerror(failed)};
    }
    std::array<char, 4096> buffer{};
    for (;;) {
        const ssize_t got = read(ends[0], buffer.data(), buffer.size());
        if (got > 0)
            ended.said.append(buffer.data(), static_cast<size_t>(got));
        else if (got == 0 || errno != EINTR)
            break;
    }
    close(ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    ended.status = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
    return ended;
}

/// Fallback fonts where Inter is not installed; gnuplot takes one name only.
std::string withFallback(std::string svg) {
    const std::string from = "font-family=\"Inter\"",
                      to = "font-family=\"Inter, Helvetica, Arial, sans-serif\"";
    for (size_t at = 0; (at = svg.find(from, at)) != std::string::npos; at += to.size())
        svg.replace(at, from.size(), to);
    return svg;
}

} // namespace

std::string draw(const Figure& figure, const std::filesystem::path& folder, const std::string& program) {
    writeFile(folder / (figure.name + ".gp"), figure.script);
    writeFile(folder / (figure.name + ".dat"), figure.data);
    const std::string part = figure.name + ".part" + std::to_string(getpid());
    const Ended ended =
        run({program, "--default-settings", "-e", "out = '" + part + "'", figure.name + ".gp"}, folder);
    std::ostringstream svg;
    svg << std::ifstream(folder / part, std::ios::binary).rdbuf();
    std::error_code ignored;
    std::filesystem::remove(folder / part, ignored);
    const std::string file = (folder / (figure.name + ".svg")).string();
    if (ended.status == -1)
        return file + ": not drawn, gnuplot does not start: " + ended.said +
               "\n  remedy: apt-get install gnuplot-nox, then gnuplot " + figure.name + ".gp in that folder";
    if (ended.status != 0 || svg.str().find("</svg>") == std::string::npos)
        return file + ": not drawn, gnuplot said: " + ended.said + "\n  remedy: look at " + figure.name +
               ".gp beside it";
    writeFile(file, withFallback(svg.str()));
    return "";
}

} // namespace touchstone::study
