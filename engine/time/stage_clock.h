#pragma once
// Where the time of loading goes, by what is reported while it passes.

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

struct StageTime {
    std::string what;
    double wall = 0.0; ///< s
    double cpu = 0.0;  ///< s of all threads of the process
};

/// Fed with every report of a Progress: the time from one to the next is that of what the first one names.
/// For one thread at a time, as the reports are.
class StageClock {
  public:
    /// The time before the first report is the program's own start: loading its libraries, reading its
    /// options.
    StageClock();

    void at(const char* what);
    /// The stages in the order in which they began, those that came again added up. The present one ends.
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

/// The most memory that the process has held at once, bytes.
[[nodiscard]] uint64_t peakMemory();

} // namespace touchstone
