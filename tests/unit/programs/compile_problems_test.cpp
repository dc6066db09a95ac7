// Sources that are wrong: each has a message with the line and a remedy.

#include "program_bench.h"

#include <functional>

namespace touchstone::program {
namespace {

/// The message, or "" where the source compiles and translates.
std::string problemOf(const std::string& text) {
    try {
        const Translation translation = translateSpirv(spirvOf(text));
        if (!translation.problem)
            return "";
        EXPECT_FALSE(translation.problem->remedy.empty());
        return "translator, " + translation.problem->place.file + ":" +
               std::to_string(translation.problem->place.line) + ": " + translation.problem->what;
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), "test.glsl");
        EXPECT_FALSE(error.remedy().empty()) << error.what();
        return error.place() + ": " + error.problem();
    }
}

void expectProblem(const std::string& text, const std::string& start, const std::string& part) {
    const std::string problem = problemOf(text);
    EXPECT_TRUE(problem.starts_with(start)) << problem;
    EXPECT_NE(problem.find(part), std::string::npos) << problem;
}

TEST(ProgramProblems, ErrorsOfTheCompilerNameTheLineOfTheSource) {
    expectProblem(
        "// one\n\nvoid touch(const in Touch before, inout Surface after) {\n after.force = colour;\n}\n",
        "line 4: ", "undeclared identifier");
    expectProblem("parameter float a = 1; // 0..2\n" + touchBody("after.force = before.colour;"),
                  "line 3: ", "colour");
    expectProblem(touchBody("float x = vec3(1.0);"), "line 2: ", "cannot convert");
    expectProblem("#include \"/etc/passwd\"\n" + touchBody(""), "line 1: ", "#include");
    expectProblem("void feel() {}\n", ": ", "no function 'touch'");
    expectProblem("", ": ", "no function 'touch'");
    expectProblem(touchBody("texture(0);"), "line 2: ", "");
}

TEST(ProgramProblems, WhatProgramsDoNotHaveIsRefusedAtItsLine) {
    expectProblem("layout(set = 0, binding = 1) uniform sampler2D image;\n" +
                      touchBody("after.force = textureLod(image, before.uv, 0.0).xyz;"),
                  "translator", "a texture");
    expectProblem("layout(set = 0, binding = 1) buffer Memory { float all[]; };\n" +
                      touchBody("after.force.x = all[3];"),
                  "translator", "");
    expectProblem(touchBody("after.force.x = float(gl_VertexIndex);"), "translator", "graphics pipeline");
    expectProblem(touchBody("after.force.x = float(double(before.position.x));"), "translator", "double");
    expectProblem(touchBody("float big[5000]; for (int i = 0; i < 5000; i++) big[i] = before.position.x;"
                            "after.force.x = big[int(before.position.y)];"),
                  "translator", "20000 bytes");
    expectProblem("\n" + touchBody("after.force.x = unpackHalf2x16(uint(before.position.x)).x;"),
                  "translator, source:3", "GLSL.std.450");
    expectProblem(touchBody("discard;"), "line 2: ", "");
    expectProblem("// floor f\n\nfloat f(float x) { return x > 1.0 ? f(x - 1.0) : x; }\n" +
                      touchBody("after.force.x = f(before.position.x);"),
                  "line 3: ", "'f' calls 'f', which comes back to it: recursion");
    expectProblem(
        "// f(x)\n/* float\nf(float x) */ float\nf (float x) { return x > 1.0 ? f(x - 1.0) : x; }\n" +
            touchBody("after.force.x = f(before.position.x);"),
        "line 4: ", "'f' calls 'f'");
    expectProblem(
        "float g(float x);\nfloat h(float x) { return g(x); }\nfloat g(float x) { return h(x); }\n" +
            touchBody("after.force.x = g(before.position.x);"),
        "line ", "recursion");
}

TEST(ProgramProblems, SourcesThatAreNoTextAreRefused) {
    expectProblem("// \xff\n", "line 1: ", "UTF-8");
    expectProblem("\n\n// \xc0\xaf\n", "line 3: ", "UTF-8");
    expectProblem(std::string("// a\0b", 6), "line 1: ", "UTF-8");
    expectProblem("// \xed\xa0\x80\n", "line 1: ", "UTF-8");
    expectProblem(std::string(10'000'000, ' '), ": ", "10000000 bytes");
    EXPECT_EQ(problemOf("\xef\xbb\xbf// \xc3\xa4\n" + touchBody("")), "");
}

TEST(ProgramProblems, SourcesThatGrowWithoutBoundEndTheCompilerAndNotTheProgram) {
    std::string macros = "#define A0 after.force.x += 1.0;\n";
    for (int i = 1; i < 30; ++i) {
        const std::string before = " A" + std::to_string(i - 1);
        macros += "#define A" + std::to_string(i) + before + before + before + before + "\n";
    }
    EXPECT_NE(problemOf(macros + touchBody("A29")), "");
    EXPECT_NE(problemOf(touchBody("float a[1000000000]; after.force.x = a[int(before.position.x)];")), "");
    EXPECT_NE(problemOf(touchBody(std::string(100000, '('))), "");
    EXPECT_NE(problemOf(touchBody(std::string(100000, '{'))), "");
}

TEST(ProgramProblems, ParametersHaveRangeDefaultAndUnit) {
    const ProgramSource source =
        readProgramSource("p.glsl", "  parameter float a = 0.5; // 0..1 1/m: rings per metre\n"
                                    "parameter vec3 way = vec3(1, 0, -1); // -1..1\r\n"
                                    "parameter int n = 3; // 1..8 : octaves\n"
                                    "float parameterless = 1.0;\n");
    ASSERT_EQ(source.parameters.size(), 3u);
    EXPECT_EQ(source.parameters[0].name, "a");
    EXPECT_EQ(source.parameters[0].value[0], 0.5);
    EXPECT_EQ(source.parameters[0].greatest, 1.0);
    EXPECT_EQ(source.parameters[0].unit, "1/m");
    EXPECT_EQ(source.parameters[0].text, "rings per metre");
    EXPECT_EQ(source.parameters[1].value[2], -1.0);
    EXPECT_EQ(source.parameters[1].least, -1.0);
    EXPECT_EQ(source.parameters[2].text, "octaves");
    EXPECT_EQ(source.text, "\n\n\nfloat parameterless = 1.0;\n");
}

TEST(ProgramProblems, WrongParametersAreRefusedAtTheirLine) {
    for (const char* wrong : {"parameter",
                              "parameter float",
                              "parameter bool b = 1; // 0..1",
                              "parameter float 9a = 1; // 0..1",
                              "parameter float a; // 0..1",
                              "parameter float a = ; // 0..1",
                              "parameter float a = 1;",
                              "parameter float a = 1; // 0",
                              "parameter float a = 1; // 0..",
                              "parameter float a = 1; // 2..3",
                              "parameter float a = 1; // 1..1",
                              "parameter float a = nan; // 0..1",
                              "parameter float a = 1e30; // 0..1e31",
                              "parameter vec2 a = vec2(1, 2, 3); // 0..9",
                              "parameter vec3 a = vec3(1, 2); // 0..9",
                              "parameter int a = 0.5; // 0..1",
                              "parameter uint a = -1; // -2..1",
                              "parameter uint a = 5; // -3..10",
                              "parameter int a = 1; // 0.5..2",
                              "#line 9",
                              " # line 9",
                              "parameter float gl_a = 1; // 0..1"})
        expectProblem(std::string("\n") + wrong + "\n" + touchBody(""), "line 2: ", "");
    expectProblem("parameter float a = 1; // 0..1\nparameter int a = 1; // 0..1\n" + touchBody(""),
                  "line 2: ", "twice");
    // A name that GLSL keeps for itself: found by the compiler, in the declaration made of the line.
    expectProblem("\n\nparameter float sampler2D = 1; // 0..1\n" + touchBody(""), "line 3: ", "");
    std::string many;
    for (int i = 0; i < 65; ++i)
        many += "parameter float p" + std::to_string(i) + " = 1; // 0..1\n";
    expectProblem(many + touchBody(""), "line 65: ", "more than 64");
}

TEST(ProgramProblems, ACompilerThatIsMissingIsNamed) {
    PreparedProgram compiler("/nonexistent/compiler", installedProgramCompiler().limits());
    try {
        (void)compileProgram(readProgramSource("test.glsl", touchBody("")), compiler, [] { return false; });
        FAIL();
    } catch (const Error& error) {
        EXPECT_NE(std::string(error.what()).find("/nonexistent/compiler"), std::string::npos);
    }
}

} // namespace
} // namespace touchstone::program
