#pragma once
// Compiles and measures haptic programs on a thread of its own: texts on request, and files when they change.

#include "engine/program/surface_program.h"

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace touchstone {

/// Measured beside the servo, by programFigures().
struct ProgramCost {
    size_t instructions = 0; ///< of the hand's executor; 0: not measured yet
    double ns = 0.0, nsWithGradients = 0.0;
};

/// What a source has become: a program, a problem, or, of a program that was reported before, its cost.
struct ProgramReport {
    size_t source = 0; ///< index, as given
    std::string text{};
    bool fromFile = false; ///< the file has changed
    double changed = 0.0;  ///< s of secondsNow(), when it was typed or written
    std::shared_ptr<const SurfaceProgram> program{};
    std::string problem{}; ///< with its remedy; empty: none
    unsigned line = 0;     ///< of the problem, from 1; 0: none in particular
    std::optional<ProgramCost> cost{};
};

/// Main thread. The thread begins with the first source; no call waits for it but the destructor.
class ProgramWorker {
  public:
    struct Source {
        std::string name{}; ///< as messages show it
        std::filesystem::path
            file{}; ///< looked at a hundred times a second; empty: it is in the model, and nobody looks
        std::string text{}; ///< as it was compiled last
    };

    ProgramWorker() = default;
    ~ProgramWorker();
    ProgramWorker(const ProgramWorker&) = delete;
    ProgramWorker& operator=(const ProgramWorker&) = delete;

    /// Other sources; what is on its way of the last ones is not reported.
    void begin(std::vector<Source> sources);
    /// The newest text of a source counts. `changed`: as in the report.
    void compile(size_t source, std::string text, double changed);
    /// What is compiled of the source is not wanted any more: its text is being typed.
    void forget(size_t source);
    void measure(size_t source, std::shared_ptr<const SurfaceProgram> program);
    /// Finished since the last call.
    [[nodiscard]] std::vector<ProgramReport> take();
    /// A text is being compiled, or `take` has something to return.
    [[nodiscard]] bool busy();

  private:
    struct Known : Source {
        uint64_t version = 0;                                         ///< of the text that is wanted
        std::pair<std::filesystem::file_time_type, uintmax_t> seen{}; ///< time and size
    };
    struct Wanted {
        std::string text{};
        double changed = 0.0;
    };
    struct Job { ///< with no text: to be measured
        ProgramReport report{};
        std::string name{};
        std::filesystem::path file{};
        uint64_t generation = 0, version = 0;
    };
    void run();
    [[nodiscard]] std::optional<Job> next();
    [[nodiscard]] std::optional<Job> changedFile();
    void compileNow(Job job, PreparedProgram& compiler);
    void finish(Job job);
    /// By another text, or since the worker ends.
    [[nodiscard]] bool superseded(const Job& job);

    std::thread thread_;
    std::atomic<bool> stop_{false};
    std::mutex mutex_;
    std::condition_variable wake_;
    // All below by mutex_.
    bool compiling_ = false;
    uint64_t generation_ = 0; ///< of `begin`
    std::vector<Known> sources_;
    std::map<size_t, Wanted> wanted_;
    std::map<size_t, std::shared_ptr<const SurfaceProgram>> unmeasured_;
    std::vector<ProgramReport> finished_;
};

} // namespace touchstone
