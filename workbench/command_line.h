#pragma once

#include "workbench/options/commands.h"
#include "workbench/options/experiment_options.h"

#include <optional>
#include <variant>

namespace touchstone {

using Command =
    std::variant<WindowOptions, RunOptions, TouchOptions, ReplayOptions, EditOptions, RenderOptions,
                 InspectOptions, SimplifyOptions, BenchOptions, StudyCommandOptions, StudyCompareOptions,
                 StudyMergeOptions, DevicesOptions, ExperimentOptions>;

/// Parses the command line. Nullopt when the program is done: help or version was printed (then `status` is
/// 0), or the usage was wrong and reported on stderr (`status` is 2).
[[nodiscard]] std::optional<Command> parseCommandLine(int argc, char** argv, int& status);

} // namespace touchstone
