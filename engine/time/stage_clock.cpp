#include "engine/time/stage_clock.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <ctime>
#include <fstream>
#include <limits>
#include <sstream>

namespace touchstone {

namespace {

double seconds(clockid_t clock) {
    timespec time{};
    ::clock_gettime(clock, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// Start time of the process, s of CLOCK_BOOTTIME; to a hundredth (proc(5): field 22, after the name in
/// brackets).
double processStart() {
    std::ifstream file("/proc/self/stat");
    file.ignore(std::numeric_limits<std::streamsize>::max(), ')');
    std::string field;
    for (int i = 0; i < 20; ++i)
        file >> field;
    std::istringstream number(field);
    double ticks = 0.0;
    return number >> ticks ? ticks / static_cast<double>(::sysconf(_SC_CLK_TCK)) : seconds(CLOCK_BOOTTIME);
}

} // namespace

StageClock::StageClock() : present_("starting the program"), since_{processStart(), 0.0} {}

StageClock::Reading StageClock::read() {
    return {seconds(CLOCK_BOOTTIME), seconds(CLOCK_PROCESS_CPUTIME_ID)};
}

void StageClock::at(const char* what) {
    if (present_ == what)
        return;
    const Reading now = read();
    addTo(present_, now);
    present_ = what;
    since_ = now;
}

void StageClock::addTo(const std::string& what, const Reading& now) {
    auto stage =
        std::find_if(stages_.begin(), stages_.end(), [&](const StageTime& s) { return s.what == what; });
    if (stage == stages_.end())
        stage = stages_.insert(stage, StageTime{what});
    stage->wall += std::max(now.wall - since_.wall, 0.0);
    stage->cpu += now.cpu - since_.cpu;
}

std::vector<StageTime> StageClock::take() {
    const Reading now = read();
    addTo(present_, now);
    since_ = now;
    return stages_;
}

uint64_t peakMemory() {
    rusage usage{};
    ::getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

} // namespace touchstone
