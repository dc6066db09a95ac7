#pragma once
// A haptic program inside of a shader: the same SPIR-V that the hand runs, guarded so that it ends, made the
// body of the shader's touchstone_run (shaders/program_host.glsl). Pure; any thread.

#include "engine/program/program_source.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace touchstone::program {

/// Instructions of SPIR-V in loops after which a run ends. What the hand's budget allows takes less.
inline constexpr uint32_t kEyeBudget = 16384;

struct LinkedProgram {
    std::vector<uint32_t> words; ///< SPIR-V of the shader; empty with a problem
    std::string problem;         ///< why it cannot be linked
};

/// `host`: a shader that includes program_host.glsl, with its names. `program`: what compileProgram made and
/// the hand accepts; damaged words are a problem, but words that only validators would refuse may reach the
/// driver. Its parameters are at descriptor set `set`, binding 0.
[[nodiscard]] LinkedProgram linkProgram(std::span<const uint32_t> host, std::span<const uint32_t> program,
                                        uint32_t set);

/// The uniform block of the parameters, std140, with one value for each of them; empty where the program uses
/// none.
[[nodiscard]] std::vector<std::byte> parameterBlock(std::span<const uint32_t> program,
                                                    std::span<const ProgramParameter> parameters,
                                                    std::span<const std::array<double, 4>> values);

} // namespace touchstone::program
