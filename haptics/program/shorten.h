#pragma once
// Leaves out of a register program what no output that is felt depends on.

#include "haptics/program/register_program.h"

namespace touchstone::program {

/// The output of the eye alone (shaders/material/interface.glsl).
inline constexpr size_t kLookOutput = 4;

/// Drops the eye's outputs, then each instruction and each input whose value nothing reads. Jumps, and what
/// may end a run, stay. Before costs are added up; jumps lead to instructions of the program.
void shorten(RegisterProgram& program);

} // namespace touchstone::program
