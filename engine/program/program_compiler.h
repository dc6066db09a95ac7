#pragma once
// GLSL to SPIR-V, by a process of its own.

#include "engine/process/prepared_program.h"
#include "engine/program/program_source.h"

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace touchstone {

/// touchstone_program_compiler beside the running program, the same for all who ask: at most 5 s of a
/// processor, 1 GiB, and no file. Once started it has done what is the same for each program, five sixths of
/// the work. Any thread but the servo.
[[nodiscard]] PreparedProgram& installedProgramCompiler();

/// SPIR-V with one function, whose uniform block has the source's parameters. Throws Error with the line and
/// a remedy, also where the compiler crashes on the source; Cancelled. `stop` is asked every 20 ms. Any
/// thread but the servo.
[[nodiscard]] std::vector<uint32_t> compileProgram(const ProgramSource& source, PreparedProgram& compiler,
                                                   const std::function<bool()>& stop);

/// "line 12" of the source for a place that the compiler names: a file of its own and a line; empty where the
/// source has no such line.
[[nodiscard]] std::string placeInSource(const ProgramSource& source, const std::string& file, uint32_t line);

} // namespace touchstone
