#pragma once
// From a source to a program that can be run.

#include "engine/program/program_compiler.h"
#include "haptics/program/register_program.h"

#include <cstdint>
#include <functional>
#include <span>

namespace touchstone::program {

/// Translates the SPIR-V of a source. Throws Error with the line and a remedy where the executor does not
/// accept it. Any thread but the servo.
[[nodiscard]] RegisterProgram translated(const ProgramSource& source, std::span<const uint32_t> spirv);

/// Compiles and translates it, with the defaults of its parameters. Throws Error with the line and a remedy;
/// Cancelled. `stop` is asked every 20 ms. Any thread but the servo.
[[nodiscard]] RegisterProgram loadProgram(const ProgramSource& source, PreparedProgram& compiler,
                                          const std::function<bool()>& stop);

/// Gives the parameters their values: one entry for each of the source, in its order. A parameter that the
/// program does not use has no register.
void setParameters(RegisterProgram& program, const std::vector<ProgramParameter>& parameters);

} // namespace touchstone::program
