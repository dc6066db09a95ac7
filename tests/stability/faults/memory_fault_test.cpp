#include "tests/support/program.h"

#include <gtest/gtest.h>

namespace touchstone::test {
namespace {

TEST(MemoryPressure, LoadingFailsWithAMessageAndTheServoNeverNotices) {
#if defined(__SANITIZE_ADDRESS__)
    GTEST_SKIP() << "AddressSanitizer ends a process that runs out of memory";
#endif
    const ScratchFolder scratch;
    for (const char* scene : {"/torus_64800.glb", "/doughnut.glb"}) {
        const ProgramResult result = runProgram(
            {MEMORY_PROBE, std::string(TOUCHSTONE_ASSETS) + scene, (scratch / "r.tsrec").string()});
        EXPECT_EQ(result.status, 0) << scene << "\n" << result.out << result.err;
    }
}

} // namespace
} // namespace touchstone::test
