// A servo that touches and is recorded while its process runs out of memory: models are loaded and made
// touchable under an ever tighter limit. Says on stdout what came of it; status 0 where the servo never
// noticed.

#include "engine/load/scene_loader.h"
#include "tests/support/recorded_servo.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/resource.h>

#include <cstdio>
#include <fstream>
#include <new>
#include <string>

using namespace touchstone;
using namespace touchstone::test;

namespace {

/// Bytes of address space in use.
size_t addressSpace() {
    std::ifstream statm("/proc/self/statm");
    size_t pages = 0;
    statm >> pages;
    return pages * 4096;
}

/// `bytes` more than now, as a soft limit; 0: none.
void allow(size_t bytes) {
    rlimit limit{};
    getrlimit(RLIMIT_AS, &limit);
    limit.rlim_cur = bytes == 0 ? limit.rlim_max : addressSpace() + bytes;
    setrlimit(RLIMIT_AS, &limit);
}

/// A model made touchable, as a drop on the window does it. What it said when it could not.
std::string load(const std::string& file) {
    try {
        const ScenePtr scene = loadScene(file);
        const auto haptic = compileHapticScene(*scene, workspaceFromScene(*scene, Fit::Workspace), {});
        haptic->buildNeighbourhoods();
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

} // namespace

int main(int count, char** arguments) {
    // Threads' arenas reserve 64 MB each, in which an allocation takes no more address space.
    mallopt(M_ARENA_MAX, 1);
    mallopt(M_MMAP_THRESHOLD, 64 << 10);
    if (count != 3) {
        std::fputs("usage: memory_probe SCENE RECORDING\n", stderr);
        return 2;
    }
    RecordedServo rig([](double time) { return at(overTheDoughnut(time)); }, {.rateHz = 1000.0});
    rig.recorder.start(arguments[2], "test");
    rig.offer(touchedScene("doughnut.glb"));
    rig.records.reserve(1 << 20);
    rig.ticks(500);
    if (const std::string problem = load(arguments[1]); !problem.empty()) {
        std::printf("without a limit: %s\n", problem.c_str());
        return 1;
    }
    int refused = 0, loaded = 0;
    for (size_t megabytes = 64; megabytes > 0; megabytes = megabytes * 3 / 4) {
        malloc_trim(0); // what earlier loads have freed is no reserve of this one
        allow(megabytes << 20);
        const std::string problem = load(arguments[1]);
        allow(0);
        (problem.empty() ? loaded : refused) += 1;
        std::printf("%zu MB: %s\n", megabytes, problem.empty() ? "loaded" : problem.c_str());
        std::fflush(stdout);
        rig.ticks(50);
    }
    rig.finish();
    const bool faultless = rig.countOf(TickFlag::ForceFault) == 0 && rig.inContact() > 100;
    std::printf("%d loaded, %d refused, %zu ticks, %zu in contact, %llu records dropped\n", loaded, refused,
                rig.records.size(), rig.inContact(),
                static_cast<unsigned long long>(rig.servo.counters().droppedRecords));
    expectEqualReplay(replayOf(arguments[2], rig.scenes));
    rig.expectWithinLimits();
    return faultless && refused > 0 && !testing::Test::HasFailure() ? 0 : 1;
}
