// Haptic programs that never end, call themselves, read beside their arrays or compute no number, in the real
// window: in the model that is opened, and typed into the editor. Pictures go on, the surface is plain for
// eye and hand, a message names the line, and the device gets no more than it can bear.

#include "tests/unit/workbench/program_window.h"
#include "tests/unit/workbench/touch_files.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace touchstone::test {
namespace {

struct Hostile {
    std::string name, text;
    int line = 0;         ///< that the message names; 0: it has a result, within bounds
    std::string part{};   ///< of the message
    bool compiles = true; ///< false: the last good program stays where it is typed
};

/// In tabs, since a space that is typed takes the force away.
std::string programOf(const std::string& body, const std::string& before = "") {
    return before +
           "void\ttouch(const\tin\tTouch\tbefore,inout\tSurface\tafter){\nafter.colour=vec3(0.0,0.8,0.0);\n" +
           body + "\n}";
}

const std::vector<Hostile>& hostilePrograms() {
    static const std::vector<Hostile> all{
        {"endless", programOf("while(true){}"), 3, "never ends"},
        {"loop", programOf("while(before.time>-1.0)\nafter.force.x+=sin(after.force.x);"), 3,
         "longer than a tick"},
        {"recursion",
         programOf("after.force.x=f(before.position.x);", "float\tf(float\tx){return\tx>0.0?f(x-1.0):x;}\n"),
         1, "recursion", false},
        {"index", programOf("float\tt[2]=float[](1.0,2.0);\nafter.force.x=t[int(before.position.x)+7];"), 4,
         "outside of its array"},
        {"nan", programOf("after.force.x=sqrt(-1.0-before.time);"), 3, "no number"},
        {"infinite", programOf("after.force=before.force*1e38*1e38;"), 3, "infinite"},
        {"division", programOf("after.force.x=float(1/int(before.position.x*0.001));"), 3, "divided by 0"},
        {"huge", programOf("after.force=vec3(1e38);after.stiffness=1e38;")}};
    return all;
}

class HostilePrograms : public ProgramWindow {
  protected:
    static constexpr double kMaxForce = 8.5, kMaxForceRate = 8500.0; // DeviceLimits
#ifdef __SANITIZE_ADDRESS__
    static constexpr double kAlive = 20.0; // s
#else
    static constexpr double kAlive = 1.0; // s
#endif
    const Json red_ = {0.8, 0.0, 0.0, 1.0};

    /// Ten pictures; none of the window's frames since the last model was opened took longer than kAlive.
    void expectAlive(const std::string& name) {
        const Json before = status();
        const Json after =
            until("pictures", [&](const Json& s) { return s["frames"] >= before["frames"].get<int>() + 10; });
        EXPECT_LT(after["longest_frame_s"].get<double>(), kAlive) << name;
        std::printf("%-10s longest frame %.3f s, %.1f frames/s, picture %s\n", name.c_str(),
                    after["longest_frame_s"].get<double>(), after["fps"].get<double>(),
                    after["scene_size"].dump().c_str());
    }
    /// The hand touches, and the device gets what it can bear.
    void expectForce(const std::string& name) {
        const Json now = measured();
        EXPECT_TRUE(now["recent"]["in_contact"].get<bool>()) << name;
        EXPECT_LE(now["tick"]["command_n"].get<double>(), kMaxForce * (1.0 + 1e-12)) << name;
    }
    static bool says(const Json& program, const Hostile& hostile) {
        const char* const member = hostile.compiles ? "fault" : "problem";
        const char* const line = hostile.compiles ? "fault_line" : "line";
        return program[member].get<std::string>().find(hostile.part) != std::string::npos &&
               program[line] == hostile.line && !program["compiling"].get<bool>();
    }
    /// What is seen of it, as it is for the eye to look at.
    void keepPicture(const std::string& name) {
        const char* const folder = std::getenv("TOUCHSTONE_TEST_PICTURES");
        if (folder == nullptr)
            return;
        const ScreenPicture screen = display_.screen();
        std::ofstream file(std::filesystem::path(folder) / (name + ".ppm"), std::ios::binary);
        file << "P6\n" << screen.width << ' ' << screen.height << "\n255\n";
        for (const auto& pixel : screen.pixels)
            file.write(reinterpret_cast<const char*>(pixel.data()), 3);
    }
    std::filesystem::path beginRecording() {
        display_.key("F9");
        return until("a recording",
                     [](const Json& s) { return s["recording"]["on"].get<bool>(); })["recording"]["file"]
            .get<std::string>();
    }
    /// Every tick that was recorded is within the limits, and replays.
    void expectWithinLimits(const std::filesystem::path& file) {
        display_.key("F9");
        until("the recording's end", [](const Json& s) { return !s["recording"]["on"].get<bool>(); });
        const std::filesystem::path csv = scratch_ / "ticks.csv";
        const ProgramResult replay =
            runProgram({TOUCHSTONE_BINARY, "replay", file.string(), "--out", csv.string()}, {},
                       std::chrono::seconds(300));
        EXPECT_EQ(replay.status, 0) << replay.out << replay.err;
        const Table ticks = readTable(csv);
        ASSERT_GT(ticks.rows, 5000u);
        double greatest = 0.0, steepest = 0.0;
        for (size_t i = 0; i < ticks.rows; ++i) {
            double square = 0.0, change = 0.0;
            for (const char* axis : {"command_x", "command_y", "command_z"}) {
                const std::vector<double>& command = ticks[axis];
                square += command[i] * command[i];
                if (i > 0)
                    change += (command[i] - command[i - 1]) * (command[i] - command[i - 1]);
            }
            greatest = std::max(greatest, std::sqrt(square));
            if (i > 0)
                steepest = std::max(steepest, std::sqrt(change) / (ticks["t"][i] - ticks["t"][i - 1]));
        }
        std::printf("%zu ticks: at most %.3f N, %.0f N/s\n", ticks.rows, greatest, steepest);
        EXPECT_GT(greatest, 0.05);
        EXPECT_LE(greatest, kMaxForce * (1.0 + 1e-9));
        EXPECT_LE(steepest, kMaxForceRate * (1.0 + 1e-6));
    }
};

TEST_F(HostilePrograms, InTheModelLeaveTheWindowAliveAndTheSurfacePlain) {
    openSquare(nullptr, red_);
    untilColour(0);
    const double plain = force();
    expectAlive("plain");
    keepPicture("file_plain");
    const std::filesystem::path recording = beginRecording();
    for (const Hostile& hostile : hostilePrograms()) {
        const std::filesystem::path model = scratch_ / (hostile.name + ".glb");
        writeSquare(model, embedded(hostile.text, hostile.name + ".glsl"), red_);
        openByPath(model.string());
        until("the model", [&](const Json& s) {
            return s["model"] == model.filename().string() && !s["loading"].get<bool>();
        });
        until("it to be touched", [](const Json& s) { return s["recent"]["in_contact"].get<bool>(); });
        if (hostile.line > 0)
            untilProgram("why " + hostile.name + " has no result",
                         [&](const Json& p) { return says(p, hostile); });
        untilColour(hostile.line > 0 ? 0 : 1);
        expectAlive(hostile.name);
        expectForce(hostile.name);
        if (hostile.line > 0) {
            EXPECT_NEAR(force() / plain, 1.0, 0.15) << hostile.name << ": plain";
        }
        const Json shown = status();
        if (!hostile.compiles) {
            EXPECT_NE(shown["warnings"].dump().find("line " + std::to_string(hostile.line) + ": "),
                      std::string::npos)
                << shown["warnings"];
        } else if (hostile.line > 0) {
            EXPECT_NE(
                shown["widgets"]["programFault"].dump().find("line " + std::to_string(hostile.line) + ": "),
                std::string::npos)
                << hostile.name;
        }
        keepPicture("file_" + hostile.name);
    }
    expectWithinLimits(recording);
    expectCleanEnd();
}

TEST_F(HostilePrograms, TypedIntoTheEditorLeaveTheWindowAliveAndTheSurfacePlain) {
    openSquare(embedded(programOf(""), "mine.glsl"), red_);
    untilColour(1);
    display_.key("e");
    until("the editor", [](const Json& s) { return s["widgets"].contains("program.edit"); });
    display_.click(middleOf("program.edit"));
    until("the text", [](const Json& s) { return s["widgets"].contains("program.text"); });
    later();
    const std::filesystem::path recording = beginRecording();
    for (const Hostile& hostile : hostilePrograms()) {
        display_.click(middleOf("program.text"));
        later();
        display_.key("ctrl+a");
        later();
        display_.xdotool({"type", "--delay", "30", hostile.text});
        if (hostile.line > 0)
            untilProgram("why " + hostile.name + " has no result",
                         [&](const Json& p) { return says(p, hostile); });
        else
            untilProgram("it to be felt", [](const Json& p) {
                return p["problem"] == "" && p["fault"] == "" && !p["compiling"].get<bool>();
            });
        // What does not compile leaves the program before it, of which each that is typed has one.
        if (hostile.compiles)
            untilColour(hostile.line > 0 ? 0 : 1);
        expectAlive(hostile.name);
        expectForce(hostile.name);
        if (hostile.line > 0)
            until("the message at its line", [&](const Json& s) {
                return s["widgets"].contains(hostile.compiles ? "program.fault" : "program.problem");
            });
        keepPicture("typed_" + hostile.name);
    }
    expectWithinLimits(recording);
    expectCleanEnd();
}

} // namespace
} // namespace touchstone::test
