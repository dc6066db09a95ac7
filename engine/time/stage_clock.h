#pragma once
// Measures the stages of loading from its progress reports.

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

struct StageTime {
    std::string what;
    double wall = 0.0; ///< s
    double cpu = 0.0;  ///< s of all threads of the process
};

/// Takes every report of a Progress: the time between two reports belongs to the stage that the first one
/// names. One thread at a time, like the reports.
class StageClock {
  public:
    /// The time before the first report is the program's own start: loading libraries and reading options.
    StageClock();

    void at(const char* what);
    /// The stages in the order of their first report, with repeated ones summed. Ends the present stage.
    [[nodiscard]] std::vector<StageTime> take();

  private:
    struct Reading {
        double wall, cpu; // s
    };
    static Reading read();
    void addTo(const std::string& what, const Reading& now);

    std::vector<StageTime> stages_;
    std::string present_;
    Reading since_;
};

/// The process's peak memory, bytes.
[[nodiscard]] uint64_t peakMemory();

} // namespace touchstone
