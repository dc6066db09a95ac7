#pragma once
// Runs a program as a user would and looks at what it answers.

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

namespace touchstone::test {

struct ProgramResult {
    int status = -1; ///< exit status; 128 + signal when it was killed
    std::string out, err;
};

/// NAME=VALUE to set or NAME= to remove, on top of this process's environment; what the program keeps unasked
/// (XDG_STATE_HOME) goes to a scratch folder, beside the log where there is one.
using Environment = std::vector<std::string>;

/// Runs `arguments[0]` and waits for it; kills it after `limit`, which is a failure of its own (status 137).
[[nodiscard]] ProgramResult runProgram(const std::vector<std::string>& arguments,
                                       const Environment& environment = {},
                                       std::chrono::seconds limit = std::chrono::seconds(120));

/// A program that runs beside the test; terminated and awaited at the end of its life, terminated also where
/// the test crashes or the thread that started it ends.
class BackgroundProgram {
  public:
    BackgroundProgram(const std::vector<std::string>& arguments, const Environment& environment,
                      const std::filesystem::path& log);
    ~BackgroundProgram();
    BackgroundProgram(const BackgroundProgram&) = delete;
    BackgroundProgram& operator=(const BackgroundProgram&) = delete;

    [[nodiscard]] bool running();
    void send(int signal);
    /// Waits for its end without asking for it.
    int wait(std::chrono::seconds limit = std::chrono::seconds(60));
    /// Asks it to end (SIGTERM) and returns its status.
    int stop();

  private:
    pid_t pid_ = -1;
    int status_ = -1;
};

/// An empty folder of this test's own under the system's temporary one; removed with all in it.
class ScratchFolder {
  public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

[[nodiscard]] std::string readFile(const std::filesystem::path& file);
void writeTextFile(const std::filesystem::path& file, const std::string& text);

} // namespace touchstone::test
