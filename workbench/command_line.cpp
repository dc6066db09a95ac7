#include "workbench/command_line.h"

#include "workbench/editor/haptic_fields.h"
#include "workbench/options/command_options.h"
#include "workbench/options/shared_options.h"

#include <iostream>
#include <string>

namespace touchstone {

namespace {

std::string asTyped(int argc, char** argv) {
    std::string text = "touchstone";
    for (int i = 1; i < argc; ++i)
        text += std::string(" ") + argv[i];
    return text;
}

} // namespace

std::optional<Command> parseCommandLine(int argc, char** argv, int& status) {
    CLI::App app{"Touchstone: open a model (glTF, OBJ, STL, PLY) or a volume (NRRD, MetaImage, NIfTI, "
                 "OpenVDB), see it and touch it."};
    app.name("touchstone");
    app.set_version_flag("--version", TOUCHSTONE_VERSION, "Print the version");
    app.footer(settingsHelp() + "\n" + strokesHelp() + "\n" + kExitHelp);
    app.require_subcommand(0, 1);

    WindowOptions window;
    RunOptions run;
    TouchOptions touch;
    ReplayOptions replay;
    EditOptions edit;
    RenderOptions render;
    InspectOptions inspect;
    SimplifyOptions simplify;
    BenchOptions bench;
    StudyCommandOptions study;
    StudyCompareOptions compare;
    StudyMergeOptions merge;
    DevicesOptions devices;
    ExperimentOptions experiment;
    defineWindow(app, window);
    CLI::App* runApp =
        app.add_subcommand("run", "The same loops without a window: simulated hand, real time");
    defineRun(*runApp, run);
    CLI::App* touchApp = app.add_subcommand("touch", "Touch along a path, offline and deterministic");
    defineTouch(*touchApp, touch);
    CLI::App* replayApp =
        app.add_subcommand("replay", "Touch again what was recorded, and say whether the same comes out");
    defineReplay(*replayApp, replay);
    CLI::App* editApp =
        app.add_subcommand("edit", "Change what a model's materials feel like, and nothing else in its file");
    defineEdit(*editApp, edit);
    CLI::App* renderApp = app.add_subcommand("render", "Draw a picture of a model");
    defineRender(*renderApp, render);
    CLI::App* inspectApp = app.add_subcommand(
        "inspect", "What a model or a haptic program (.glsl) is, what it would feel like, and its problems");
    defineInspect(*inspectApp, inspect);
    CLI::App* simplifyApp = app.add_subcommand(
        "simplify", "Fewer triangles, as far as people would not feel the facets, and the error of that");
    defineSimplify(*simplifyApp, simplify);
    CLI::App* benchApp = app.add_subcommand("bench", "What a tick costs against Embree's floor");
    defineBench(*benchApp, bench);
    CLI::App* studyApp =
        app.add_subcommand("study", "What accuracy costs in time: errors and times of every way to touch");
    defineStudy(*studyApp, study);
    CLI::App* compareApp = studyApp->add_subcommand(
        "compare", "Whether configurations that one run distinguishes keep their order in another");
    defineCompare(*compareApp, compare);
    CLI::App* mergeApp = studyApp->add_subcommand("merge", "One study of the parts that --shard made");
    defineMerge(*mergeApp, merge);
    CLI::App* devicesApp = app.add_subcommand("devices", "What is plugged in, and a trial of one device");
    defineDevices(*devicesApp, devices);
    // main starts it where it is the first word; here for --help.
    app.add_subcommand("serve",
                       "Touch for other programs and a page in the browser, over a WebSocket (serve --help)")
        ->parse_complete_callback([] { throw CLI::ValidationError("serve", "has to be the first word"); });
    CLI::App* experimentApp = app.add_subcommand(
        "experiment", "What people can tell: forced-choice studies with simulated people, and reports");
    defineExperiment(*experimentApp, experiment);

    status = 0;
    try {
        app.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        for (CLI::App* command : {runApp, touchApp, replayApp, editApp, renderApp, inspectApp, simplifyApp,
                                  benchApp, compareApp, mergeApp, studyApp, devicesApp, experimentApp})
            if (command->parsed()) {
                // A command without --set inherits the footer of the program.
                command->footer(command == runApp || command == touchApp
                                    ? settingsHelp() + "\n" + strokesHelp() + "\n" + plantHelp()
                                : command == editApp ? hapticFieldHelp()
                                                     : kExitHelp);
                std::cout << command->help();
                return std::nullopt;
            }
        std::cout << app.help("", CLI::AppFormatMode::All);
        return std::nullopt;
    } catch (const CLI::CallForVersion&) {
        std::cout << "touchstone " TOUCHSTONE_VERSION "\n";
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        std::cerr << "touchstone: " << error.what() << "\n  remedy: touchstone --help\n";
        status = 2;
        return std::nullopt;
    }
    if (runApp->parsed())
        return run;
    if (touchApp->parsed())
        return touch;
    if (replayApp->parsed())
        return replay;
    if (editApp->parsed())
        return edit;
    if (renderApp->parsed())
        return render;
    if (inspectApp->parsed())
        return inspect;
    if (simplifyApp->parsed())
        return simplify;
    if (benchApp->parsed())
        return bench;
    if (compareApp->parsed())
        return compare;
    if (mergeApp->parsed())
        return merge;
    if (studyApp->parsed()) {
        study.commandLine = asTyped(argc, argv);
        return study;
    }
    if (devicesApp->parsed())
        return devices;
    if (experimentApp->parsed()) {
        experiment.commandLine = asTyped(argc, argv);
        return experiment;
    }
    return window;
}

} // namespace touchstone
