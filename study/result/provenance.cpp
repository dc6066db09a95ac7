#include "study/result/provenance.h"

#include "study/result/commit.h"

#include <sys/utsname.h>

#include <ctime>
#include <fstream>
#include <thread>

namespace touchstone::study {

namespace {

/// ISO 8601, UTC.
std::string now() {
    const std::time_t time = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&time, &parts);
    char text[32];
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text;
}

} // namespace

std::string processorName() {
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; std::getline(info, line);)
        if (line.starts_with("model name"))
            return line.substr(line.find(':') + 2);
    return "unknown";
}

Provenance provenanceOf(const std::string& command) {
    Provenance provenance;
    utsname system{};
    if (uname(&system) == 0) {
        provenance.machine = std::string(system.nodename) + ", " + system.machine;
        provenance.kernel = std::string(system.sysname) + " " + system.release;
    }
    provenance.processor = processorName();
    provenance.processors = std::thread::hardware_concurrency();
#ifdef __clang__
    provenance.compiler = __VERSION__;
#else
    provenance.compiler = std::string("gcc ") + __VERSION__;
#endif
    provenance.buildType = TOUCHSTONE_BUILD_TYPE;
    provenance.commit = kCommit;
    provenance.date = now();
    provenance.command = command;
    return provenance;
}

} // namespace touchstone::study
