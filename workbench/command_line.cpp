#include "workbench/command_line.h"

#include "workbench/editor/haptic_fields.h"
#include "workbench/options/command_options.h"
#include "workbench/options/shared_options.h"

#include <algorithm>
#include <functional>
#include <iostream>
#include <ranges>
#include <string>
#include <vector>

namespace touchstone {

namespace {

std::string asTyped(int argc, char** argv) {
    std::string text = "touchstone";
    for (int i = 1; i < argc; ++i)
        text += std::string(" ") + argv[i];
    return text;
}

// What stands at the end of a command's help. One without --set would inherit that of the program.
std::string exitFooter() {
    return kExitHelp;
}
std::string touchFooter() {
    return settingsHelp() + "\n" + strokesHelp() + "\n" + plantHelp();
}
std::string editFooter() {
    return hapticFieldHelp();
}

/// The program's commands, each with the options that parsing fills.
class CommandLine {
  public:
    explicit CommandLine(const std::string& typed);
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    void parse(int argc, char** argv) { app_.parse(argc, argv); }
    /// What was parsed.
    [[nodiscard]] Command command() const {
        const Subcommand* const named = this->named();
        return named != nullptr ? named->options() : Command(window_);
    }
    /// Of the command that was named, or else of the program with all its commands.
    [[nodiscard]] std::string help() const {
        const Subcommand* const named = this->named();
        if (named == nullptr)
            return app_.help("", CLI::AppFormatMode::All);
        named->app->footer(named->footer());
        std::string above; // of the usage line
        for (const CLI::App* app = named->app->get_parent(); app != nullptr; app = app->get_parent())
            above = app->get_name() + (above.empty() ? "" : " ") + above;
        return named->app->help(above);
    }

  private:
    using Footer = std::string (*)();
    struct Subcommand {
        CLI::App* app;
        Footer footer;
        std::function<Command()> options;
    };

    template <class Options>
    CLI::App& add(CLI::App& parent, const char* name, const char* text, void (*define)(CLI::App&, Options&),
                  Options& options, Footer footer = exitFooter) {
        CLI::App* const app = parent.add_subcommand(name, text);
        define(*app, options);
        subcommands_.push_back({app, footer, [&options] { return Command(options); }});
        return *app;
    }
    void addTouching();
    void addModels();
    void addStudies();
    /// The innermost that was named, which was added last; null: none.
    [[nodiscard]] const Subcommand* named() const {
        const auto found = std::ranges::find_if(subcommands_ | std::views::reverse,
                                                [](const Subcommand& each) { return each.app->parsed(); });
        return found != subcommands_.rend() ? &*found : nullptr;
    }

    CLI::App app_{"Touchstone: open a model (glTF, OBJ, STL, PLY) or a volume (NRRD, MetaImage, NIfTI, "
                  "OpenVDB), see it and touch it."};
    std::vector<Subcommand> subcommands_;
    WindowOptions window_;
    RunOptions run_;
    TouchOptions touch_;
    ReplayOptions replay_;
    EditOptions edit_;
    RenderOptions render_;
    InspectOptions inspect_;
    SimplifyOptions simplify_;
    BenchOptions bench_;
    StudyCommandOptions study_;
    StudyCompareOptions compare_;
    StudyMergeOptions merge_;
    DevicesOptions devices_;
    ExperimentOptions experiment_;
};

CommandLine::CommandLine(const std::string& typed) {
    study_.commandLine = experiment_.commandLine = typed;
    app_.name("touchstone");
    app_.set_version_flag("--version", TOUCHSTONE_VERSION, "Print the version");
    app_.footer(settingsHelp() + "\n" + strokesHelp() + "\n" + kExitHelp);
    app_.require_subcommand(0, 1);
    defineWindow(app_, window_);
    addTouching();
    addModels();
    addStudies();
}

void CommandLine::addTouching() {
    add(app_, "run", "The same loops without a window: simulated hand, real time", defineRun, run_,
        touchFooter);
    add(app_, "touch", "Touch along a path, offline and deterministic", defineTouch, touch_, touchFooter);
    add(app_, "replay", "Touch again what was recorded, and say whether the same comes out", defineReplay,
        replay_);
}

void CommandLine::addModels() {
    add(app_, "edit", "Change what a model's materials feel like, and nothing else in its file", defineEdit,
        edit_, editFooter);
    add(app_, "render", "Draw a picture of a model", defineRender, render_);
    add(app_, "inspect",
        "What a model or a haptic program (.glsl) is, what it would feel like, and its problems",
        defineInspect, inspect_);
    add(app_, "simplify",
        "Fewer triangles, as far as people would not feel the facets, and the error of that", defineSimplify,
        simplify_);
}

void CommandLine::addStudies() {
    add(app_, "bench", "What a tick costs against Embree's floor", defineBench, bench_);
    CLI::App& study =
        add(app_, "study", "What accuracy costs in time: errors and times of every way to touch", defineStudy,
            study_);
    add(study, "compare", "Whether configurations that one run distinguishes keep their order in another",
        defineCompare, compare_);
    add(study, "merge", "One study of the parts that --shard made", defineMerge, merge_);
    add(app_, "devices", "What is plugged in, and a trial of one device", defineDevices, devices_);
    // main starts it where it is the first word; here for --help.
    app_.add_subcommand("serve",
                        "Touch for other programs and a page in the browser, over a WebSocket (serve --help)")
        ->parse_complete_callback([] { throw CLI::ValidationError("serve", "has to be the first word"); });
    add(app_, "experiment",
        "What people can tell: forced-choice studies with a person in a window or simulated people, and "
        "reports",
        defineExperiment, experiment_);
}

} // namespace

std::optional<Command> parseCommandLine(int argc, char** argv, int& status) {
    CommandLine line(asTyped(argc, argv));
    status = 0;
    try {
        line.parse(argc, argv);
    } catch (const CLI::CallForHelp&) {
        std::cout << line.help();
        return std::nullopt;
    } catch (const CLI::CallForVersion&) {
        std::cout << "touchstone " TOUCHSTONE_VERSION "\n";
        return std::nullopt;
    } catch (const CLI::ParseError& error) {
        std::cerr << "touchstone: " << error.what() << "\n  remedy: touchstone --help\n";
        status = 2;
        return std::nullopt;
    }
    return line.command();
}

} // namespace touchstone
