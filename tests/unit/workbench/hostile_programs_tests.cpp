// Haptic programs that are written to do harm, saved while the window shows and touches them: the picture
// goes on, the force stays within its limits, and the next right program is taken.

#include "engine/device_io/device_io.h"
#include "tests/unit/workbench/program_window.h"

#include <chrono>
#include <cstdio>

namespace touchstone::test::hostile_programs_tests {
namespace {

struct Hostile {
    const char* name;
    const char* body; ///< statements of touch()
    bool refused;     ///< by the compiler or the executor: the program before it stays
};

constexpr std::array kHostile{
    Hostile{"endless", "while (true) after.dynamicFriction += 1.0;", false},
    Hostile{"endless in a branch",
            "if (before.position.x < 1e9) for (int i = 0; i >= 0; i = i) after.dynamicFriction += 1.0;",
            false},
    Hostile{"nested",
            "for (int i = 0; i < 100000; ++i) for (int j = 0; j < 100000; ++j) after.dynamicFriction += "
            "sin(float(i * j));",
            false},
    Hostile{"index beyond",
            "float a[4] = float[4](0.1, 0.2, 0.3, 0.4); int i = int(1e6 * before.position.x) + 77; "
            "after.dynamicFriction = a[i] + a[-i]; after.colour = vec3(a[i]);",
            false},
    Hostile{"not a number",
            "float z = before.position.x - before.position.x; after.colour = vec3(z / z); after.stiffness = "
            "z / z; "
            "after.position = before.position + vec3(sqrt(z - 1.0));",
            false},
    Hostile{"huge", "after.stiffness = 1e38 * 1e38; after.position = vec3(1e38); after.colour = vec3(1e38);",
            false},
    Hostile{"division by zero",
            "int z = int(0.0 * before.position.x); after.dynamicFriction = float(7 / z + 7 % z); "
            "after.colour = vec3(1.0 / float(z));",
            false},
    Hostile{"recursion", "after.dynamicFriction = again(2.0);", true},
};

std::string hostileSource(const Hostile& hostile) {
    std::string text;
    if (std::string(hostile.name) == "recursion")
        text = "float again(float x) { return again(x - 1.0); }\n";
    return text + "void touch(const in Touch before, inout Surface after) {\n    " + hostile.body + "\n}\n";
}

class HostileProgram : public ProgramWindow {
  protected:
    /// Programs are compiled ahead only where no validation layer watches.
    HostileProgram() { environment_.emplace_back("TOUCHSTONE_VALIDATION="); }
    static std::string plain() { return source("vec3(0.0, 0.8, 0.0)", "1.0"); }
    /// Frames that were drawn between the moment when the program was felt and that when it was seen.
    int64_t framesUntilSeen(int loads) {
        const Json felt = untilProgram("the program to be felt", [&](const Json& p) {
            return p["loads"] >= loads && p["felt_after_s"] >= 0.0;
        });
        return untilFeltAndSeen(loads)["frames"].get<int64_t>() - felt["frames"].get<int64_t>();
    }
};

/// A driver that draws on the CPU compiles what computes an index for seconds. The number in the text keeps
/// caches on disk from knowing it.
TEST_F(HostileProgram, TheWindowDrawsWhileADriverCompilesForLong) {
    writeTextFile(file_, plain());
    openSquare({{"source", "p.glsl"}});
    untilColour(1);
    const int loads = programOf(status())["loads"].get<int>();
    // Six digits, which a float tells apart.
    const auto now = std::chrono::duration_cast<std::chrono::microseconds>(
                         std::chrono::system_clock::now().time_since_epoch())
                             .count() %
                         900'000 +
                     100'000;
    writeTextFile(file_, "void touch(const in Touch before, inout Surface after) {\n"
                         "    float a[4] = float[4](0.1, 0.2, 0.3, 0." +
                             std::to_string(now) +
                             ");\n    int i = abs(int(1e6 * before.position.x)) % 4;\n"
                             "    after.dynamicFriction = a[i] + a[3 - i];\n"
                             "    after.colour = vec3(0.8 + 1e-3 * a[i], 0.0, 0.0);\n}\n");
    const int64_t drawn = framesUntilSeen(loads + 1);
    const Json seen = status();
    std::printf("seen after %.2f s and %lld frames, of which the longest took %.3f s\n",
                programOf(seen)["seen_after_s"].get<double>(), static_cast<long long>(drawn),
                seen["longest_frame_s"].get<double>());
    EXPECT_GE(drawn, 10) << "the program of before is drawn meanwhile";
    untilColour(0);
    expectCleanEnd();
}

TEST_F(HostileProgram, LeavesTheWindowAliveAndTheForceWithinItsLimits) {
    writeTextFile(file_, plain());
    openSquare({{"source", "p.glsl"}});
    untilColour(1);
    int loads = programOf(status())["loads"].get<int>();
    for (const Hostile& hostile : kHostile) {
        SCOPED_TRACE(hostile.name);
        const double before = status()["longest_frame_s"].get<double>();
        writeTextFile(file_, hostileSource(hostile));
        if (hostile.refused) {
            const Json refused = untilProgram("the program to be refused", [](const Json& p) {
                return !p["problem"].get<std::string>().empty() && !p["compiling"];
            });
            EXPECT_EQ(programOf(refused)["loads"], loads);
        } else {
            ++loads;
            untilFeltAndSeen(loads);
        }
        // A picture that is kept is refined after the program was seen for the first time.
        const Json kept =
            until("the picture to be kept", [](const Json& s) { return s["picture"]["state"] == "kept"; });
        std::printf("%-20s longest frame until then %.3f s, now %.3f s\n", hostile.name, before,
                    kept["longest_frame_s"].get<double>());
        const Json felt = measured();
        EXPECT_LE(felt["tick"]["command_n"].get<double>(), DeviceLimits{}.maxForce * (1.0 + 1e-9));
    }
    writeTextFile(file_, source("vec3(0.0, 0.0, 0.8)", "1.0"));
    untilFeltAndSeen(loads + 1);
    untilColour(2);
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test::hostile_programs_tests
