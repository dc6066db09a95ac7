// Haptic programs in the real window: their files are saved by another program, their text is typed, their
// parameters are dragged; all is felt and seen while touch goes on.

#include "tests/unit/workbench/program_window.h"

#include <cstdio>

namespace touchstone::test::program_window_tests {
namespace {

TEST_F(ProgramWindow, AFileThatIsSavedIsFeltAndSeenWhileTouchGoesOn) {
    writeTextFile(file_, source("vec3(0.8, 0.0, 0.0)", "1.0"));
    openSquare({{"source", "p.glsl"}});
    untilColour(0);
    const double before = force();
    EXPECT_GT(before, 0.05);
    writeTextFile(file_, source("vec3(0.0, 0.8, 0.0)", "0.4"));
    const Json taken = untilFeltAndSeen(1);
    std::printf("saved to felt %.3f s, to seen %.3f s (both on this machine, beside whatever else it does)\n",
                programOf(taken)["felt_after_s"].get<double>(),
                programOf(taken)["seen_after_s"].get<double>());
    untilColour(1);
    const double softer = force();
    EXPECT_NEAR(softer / before, 0.4, 0.08);
    EXPECT_FALSE(taken["materials"]["edited"].get<bool>()) << "it is no edit of the model";

    writeTextFile(file_,
                  "parameter float share = 1; // 0.1..1\n\nvoid touch(const in Touch before, inout Surface "
                  "after) {\n    after.colour = colour;\n}\n");
    const Json broken =
        untilProgram("the problem", [](const Json& p) { return !p["problem"].get<std::string>().empty(); });
    EXPECT_EQ(programOf(broken)["line"], 4) << programOf(broken).dump();
    EXPECT_EQ(programOf(broken)["loads"], 1);
    EXPECT_NEAR(force() / softer, 1.0, 0.1) << "what was felt is felt";
    untilColour(1);

    for (int i = 0; i < 5; ++i) {
        writeTextFile(file_, source(i % 2 == 0 ? "vec3(0.0, 0.0, 0.8)" : "vec3(0.8, 0.0, 0.0)", "0.4"));
        const Json next = untilFeltAndSeen(2 + i);
        std::printf("saved to felt %.3f s, to seen %.3f s\n", programOf(next)["felt_after_s"].get<double>(),
                    programOf(next)["seen_after_s"].get<double>());
        EXPECT_EQ(programOf(next)["problem"], "");
    }
    untilColour(2);
    expectCleanEnd();
}

TEST_F(ProgramWindow, TextIsTypedParametersAreDraggedAndBothAreKeptOnSave) {
    const std::string first = source("vec3(0.8, 0.0, 0.0)", "1.0");
    openSquare({{"source", "data:text/plain;base64," + base64({first.begin(), first.end()})},
                {"name", "mine.glsl"}});
    const double before = force();
    display_.key("e");
    until("the editor", [](const Json& s) { return s["widgets"].contains("program.edit"); });
    const Json measured = untilProgram("its cost", [](const Json& p) { return p["instructions"] > 0; });
    EXPECT_GT(programOf(measured)["ns_per_tick"], 0.0);
    slide("edit.shader.share", 0.05);
    until("an edit", [](const Json& s) { return s["materials"]["edited"].get<bool>(); });
    const double softer = force();
    EXPECT_LT(softer, 0.5 * before) << "the slider is felt";

    display_.click(middleOf("program.edit"));
    until("the text", [](const Json& s) { return s["widgets"].contains("program.text"); });
    later();
    display_.click(middleOf("program.text"));
    later();
    const std::string more = "after.colour = vec3(0.0, 0.0, 0.8); }";
    typeAtTheEnd(2, more); // of "}\n"
    const std::string text = first.substr(0, first.size() - 2) + more;
    const Json typed = untilFeltAndSeen(1);
    std::printf("last key to felt %.3f s, to seen %.3f s\n", programOf(typed)["felt_after_s"].get<double>(),
                programOf(typed)["seen_after_s"].get<double>());
    EXPECT_NE(typed["widgets"]["program.space"].dump().find("Space types a space"), std::string::npos)
        << "the window says what Space does";
    // Space takes the force away wherever it is typed; it is given back by a click.
    until("no force", [](const Json& s) { return s["settings"]["forceEnabled"] == "off"; });
    later();
    display_.click(middleOf("forceEnabled"));
    until("the force", [](const Json& s) { return s["settings"]["forceEnabled"] == "on"; });
    display_.click(middleOf("program.text"));
    later();
    EXPECT_NEAR(force() / softer, 1.0, 0.15) << "the dragged value holds for the new text";

    // Broken: nothing changes, and Save says where.
    typeAtTheEnd(1, "nonsense;}");
    // What is half typed may be compiled, too, and says something else.
    untilProgram("the problem", [](const Json& p) {
        return !p["problem"].get<std::string>().empty() && p["line"] == 5 && !p["compiling"].get<bool>();
    });
    until("the problem at its line", [](const Json& s) { return s["widgets"].contains("program.problem"); });
    display_.key("ctrl+s");
    const Json refused = until("to be told", [](const Json& s) { return s["materials"]["notice"] != ""; });
    EXPECT_NE(refused["materials"]["notice"].get<std::string>().find("line 5"), std::string::npos);
    typeAtTheEnd(10, "}");
    untilProgram("it to be right again",
                 [](const Json& p) { return p["problem"] == "" && !p["compiling"].get<bool>(); });
    const std::string saved = savedAndInspected();
    EXPECT_NE(saved.find("mine.glsl"), std::string::npos) << saved;
    EXPECT_EQ(saved.find("plain"), std::string::npos) << saved;
    expectCleanEnd();
    const std::string bytes = readFile(model_);
    EXPECT_NE(bytes.find(base64({text.begin(), text.end()})), std::string::npos)
        << "the text is in the model";
    EXPECT_NE(bytes.find("\"share\":"), std::string::npos) << "and the value";
}

TEST_F(ProgramWindow, CoverageIsSaidInPercentAndWhatIsWornOffIsSaved) {
    const std::string text =
        "void touch(const in Touch before, inout Surface after) {\n"
        "    after.persistentChange = -1e-2 * length(before.force);\n"
        "    after.brush = 0.05;\n    after.colour = vec3(before.persistent, 0.0, 0.0);\n}\n";
    openSquare({{"source", "data:text/plain;base64," + base64({text.begin(), text.end()})},
                {"name", "wear.glsl"},
                {"persistentTexture", {{"width", 64}, {"height", 64}}}});
    const Json worn = until("something to be worn off", [](const Json& s) {
        const auto said = s["widgets"].find("coverage");
        return said != s["widgets"].end() && said->dump().find("coverage") != std::string::npos &&
               said->dump().find("100.0 %") == std::string::npos;
    });
    EXPECT_NE(worn["widgets"]["coverage"].dump().find("% removed"), std::string::npos);
    until("it to count as not saved", [](const Json& s) { return s["materials"]["edited"].get<bool>(); });
    const std::string saved = savedAndInspected();
    EXPECT_NE(saved.find("% left, as it was saved"), std::string::npos) << saved;
}

} // namespace
} // namespace touchstone::test::program_window_tests
