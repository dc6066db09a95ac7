#pragma once
// Runs register programs on the servo: no allocation, no lock, no throw, bounded time.

#include "haptics/program/ending.h"
#include "haptics/program/register_program.h"

#include <array>
#include <cstdint>
#include <span>

namespace touchstone::program {

/// Up to four components at a location.
using PortValue = std::array<float, 4>;
/// The same with their derivatives by three variables.
struct DualPortValue {
    PortValue v{};
    std::array<std::array<float, 3>, 4> d{};
};

/// What a run of the servo gave and took.
struct RunResult {
    Ending ending = Ending::Finished;
    uint32_t cost = 0; ///< an upper bound, in the units of operation.h
    uint16_t at = 0;   ///< as ProgramEnd::at
};

/// Runs the program on inputs and outputs by location (at least kMaxLocations of each; the program reads and
/// writes those that it declares). `budget`: at most kBudget. Same bits for the same program, inputs and
/// binary.
[[nodiscard]] RunResult run(const RegisterProgram& program, std::span<const PortValue, kMaxLocations> inputs,
                            std::span<PortValue, kMaxLocations> outputs, uint32_t budget = kBudget) noexcept;

/// The same with derivatives. The values are those of `run` to the bit.
[[nodiscard]] RunResult runDual(const RegisterProgram& program,
                                std::span<const DualPortValue, kMaxLocations> inputs,
                                std::span<DualPortValue, kMaxLocations> outputs,
                                uint32_t budget = kBudget) noexcept;

} // namespace touchstone::program
