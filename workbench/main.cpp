#include "engine/core/error.h"
#include "engine/process/helper_program.h"
#include "haptics/scene/shape_object.h"
#include "workbench/command_line.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <string_view>

namespace {

template <class... Functions>
struct Overloaded : Functions... {
    using Functions::operator()...;
};

/// `touchstone serve` is a program of its own; it takes this one's place.
[[noreturn]] void becomeServer(char** argv) {
    const std::string program = touchstone::helperProgram("touchstone_server").string();
    (void)execv(program.c_str(), argv);
    throw touchstone::Error(program, "", "the server cannot be started",
                            "build it (ninja touchstone_server; it needs libwebsockets-dev)");
}

} // namespace

int main(int argc, char** argv) {
    using namespace touchstone;
    std::signal(SIGXFSZ, SIG_IGN); // a file size limit is a write error and must not end the process
    std::signal(SIGCHLD, SIG_DFL); // a parent that ignored it would leave us without our children's status
    try {
        if (argc > 1 && std::string_view(argv[1]) == "serve")
            becomeServer(argv + 1);
        keepFieldsIn(FieldCache::usual());
        int status = 0;
        const std::optional<Command> command = parseCommandLine(argc, argv, status);
        if (!command)
            return status;
        return std::visit(
            Overloaded{[](const WindowOptions& options) { return windowCommand(options); },
                       [](const RunOptions& options) { return runCommand(options); },
                       [](const TouchOptions& options) { return touchCommand(options); },
                       [](const ReplayOptions& options) { return replayCommand(options); },
                       [](const EditOptions& options) { return editCommand(options); },
                       [](const RenderOptions& options) { return renderCommand(options); },
                       [](const InspectOptions& options) { return inspectCommand(options); },
                       [](const SimplifyOptions& options) { return simplifyCommand(options); },
                       [](const BenchOptions& options) { return benchCommand(options); },
                       [](const StudyCommandOptions& options) { return studyCommand(options); },
                       [](const StudyCompareOptions& options) { return studyCompare(options); },
                       [](const StudyMergeOptions& options) { return studyMerge(options); },
                       [](const DevicesOptions& options) { return devicesCommand(options); },
                       [](const ExperimentOptions& options) { return experimentCommand(options); }},
            *command);
    } catch (const Error& error) {
        std::fprintf(stderr, "touchstone: %s\n", error.what());
    } catch (const std::bad_alloc&) {
        std::fprintf(stderr,
                     "touchstone: out of memory\n  remedy: close other programs, or use a smaller model\n");
    } catch (const std::exception& error) {
        std::fprintf(stderr, "touchstone: unexpected: %s\n", error.what());
    }
    return 1;
}
