#pragma once
// Options of each command: one function per command, which adds its options to its part of the command line
// and binds them to `options`, which outlives the parsing.

#include "workbench/options/commands.h"

#include <CLI/CLI.hpp>

namespace touchstone {

void defineDevices(CLI::App& app, DevicesOptions& options);
void defineWindow(CLI::App& app, WindowOptions& options);
void defineRun(CLI::App& app, RunOptions& options);
void defineTouch(CLI::App& app, TouchOptions& options);
void defineReplay(CLI::App& app, ReplayOptions& options);
void defineEdit(CLI::App& app, EditOptions& options);
void defineRender(CLI::App& app, RenderOptions& options);
void defineInspect(CLI::App& app, InspectOptions& options);
void defineSimplify(CLI::App& app, SimplifyOptions& options);
void defineBench(CLI::App& app, BenchOptions& options);
void defineStudy(CLI::App& app, StudyCommandOptions& options);
void defineCompare(CLI::App& app, StudyCompareOptions& options);
void defineMerge(CLI::App& app, StudyMergeOptions& options);

} // namespace touchstone
