// Why a program has no result, and in which line.

#include "haptics/program/program_fault.h"
#include "haptics/program/program_touch.h"
#include "program_bench.h"

namespace touchstone::program {
namespace {

/// The body begins in line 2.
ProgramFault faultAt(const std::string& body, ProgramGradient gradient, float x = 9.0f) {
    const std::string text = touchBody(body);
    const RegisterProgram program = programOf(text);
    EXPECT_EQ(program.lines.size(), program.instructions.size());
    const ProgramContact contact{.position = {static_cast<double>(x), 0.0, 0.0},
                                 .depth = 0.002,
                                 .stiffness = 600.0,
                                 .staticFriction = 0.4,
                                 .dynamicFriction = 0.3,
                                 .maxStiffness = 3000.0};
    const ProgramFelt felt = feelProgram(program, gradient, contact);
    return faultOf(program, text, {felt.ending, felt.at});
}

TEST(ProgramFaults, NameTheLineThatHasNoResult) {
    const struct {
        const char* body;
        uint32_t line;
        const char* part;
    } cases[] = {
        {"after.stiffness = 300.0;\nwhile (true) {}\n", 3, "never ends"},
        {"\n\nwhile (true) {\n  after.force.x += 1.0;\n}", 4, "never ends"},
        {"for (;;)\n  after.force.x += 1.0;", 2, "never ends"},
        {"float s = 0.0;\nfor (int i = 0; i < 2000000000; i++)\n  s += before.force.z;\nafter.force.x = s;",
         3, "longer than a tick"},
        {"float s = 0.0;\nint n = 0;\ndo {\n  s += sin(s + 1.0);\n} while (s < 1e9);\nafter.force.x = s;", 6,
         "longer than a tick"},
        {"float a[4] = float[](1.,2.,3.,4.);\n\nafter.force.x = a[int(before.position.x)];", 4,
         "outside of its array"},
        {"\nafter.force.x = float(7 / int(before.position.y));", 3, "divided by 0"},
        {"\nafter.force.x = float(7u % uint(before.position.y));", 3, "divided by 0"},
        {"\n\nafter.force.y = 1.0 / before.position.y;", 4, "after.force"},
        {"float root = sqrt(-before.position.x);\nafter.damping = 2.0 * before.damping;\n"
         "after.staticFriction = root;",
         2, "after.staticFriction"},
        {"vec3 f = before.force * 1e38;\nafter.force = f * 1e38;", 3, "after.force"},
        {"\nafter.force = vec3(1e38) * 1e38;", 3, "after.force"}, // a constant
        // What only looks like an assignment is none.
        {"after.force = vec3(1e38) * 1e38; // as\n// after.force = 1.0\n/* after.force =\n after.force = 2.0 "
         "*/",
         2, "after.force"},
        {"after.force /= vec3(0.0) * 1.0;\nif (after.force.x <= 1.0 || after.force.y == 2.0) after.damping = "
         "1.0;",
         2, "after.force"},
        {"float n = noise(before.position) + 2.0;\nafter.stiffness = log(-n);", 3, "after.stiffness"},
    };
    for (const auto& one : cases)
        for (const auto gradient : {ProgramGradient::None, ProgramGradient::Dual, ProgramGradient::Central}) {
            const ProgramFault fault = faultAt(one.body, gradient);
            EXPECT_EQ(fault.line, one.line) << one.body << textOf(fault);
            EXPECT_NE(fault.problem.find(one.part), std::string::npos) << one.body << textOf(fault);
            EXPECT_NE(fault.problem.find("; "), std::string::npos) << "a remedy: " << fault.problem;
            EXPECT_TRUE(textOf(fault).starts_with("line " + std::to_string(one.line) + ": "));
        }
}

/// Which of two branches gave the value is not known: both lines are named.
TEST(ProgramFaults, NameEveryLineThatMayHaveMadeTheValue) {
    const ProgramFault fault =
        faultAt("if (before.position.x > 1.0)\n  after.force.x = 1.0 / before.position.y;\n"
                "else\n  after.force.x = before.position.x * 3.0;",
                ProgramGradient::None);
    EXPECT_EQ(fault.line, 3u);
    EXPECT_NE(fault.problem.find("one of the lines 3, 5"), std::string::npos) << fault.problem;
}

TEST(ProgramFaults, AreNoneWhereTheProgramFinishes) {
    EXPECT_EQ(faultAt("after.force *= 0.5;", ProgramGradient::Dual), ProgramFault{});
    EXPECT_EQ(textOf({}), "");
}

} // namespace
} // namespace touchstone::program
