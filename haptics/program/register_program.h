#pragma once
// A haptic program as the servo runs it: flat instructions on 32-bit registers, no memory besides them, no
// call.

#include "haptics/program/operation.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace touchstone::program {

/// Bounds of every program. A register is four bytes; with gradients sixteen, all of them on the servo's
/// stack.
constexpr size_t kMaxRegisters = 4096;
constexpr size_t kMaxInstructions = 16384;
/// Cost (see operation.h) after which a run ends.
constexpr uint32_t kBudget = 16384;
/// Numbers of input and output locations.
constexpr size_t kMaxLocations = 24;

/// `to`, `a`, `b`, `c` are registers unless the operation says otherwise.
struct Instruction {
    Operation operation = Operation::Return;
    uint16_t count = 1;
    uint16_t to = 0, a = 0, b = 0, c = 0;
};

/// An input or output variable of a program.
struct Port {
    uint16_t location = 0, first = 0, count = 0; ///< registers first .. first + count - 1, at most 4
};

/// A member of the uniform block: 1 to 4 components from register `first` on.
struct ParameterSlot {
    enum class Kind : uint8_t { Float, Int, Uint };
    std::string name;
    Kind kind = Kind::Float;
    uint16_t first = 0, count = 1;
};

/// Immutable after translation, except for the parameters in `constants`.
struct RegisterProgram {
    std::vector<Instruction> instructions; ///< the last one is a Return
    /// cost[i]: of all instructions before i, from the first in the list; one more than instructions.
    std::vector<uint32_t> cost;
    /// Of each instruction: the line of the source from 1, 0 where it comes from none. What a function of the
    /// library does counts as the line that calls it. For messages.
    std::vector<uint32_t> lines;
    std::vector<uint32_t> constants; ///< of the first registers: constants, then parameters
    uint16_t registers = 0;          ///< all of them
    std::vector<Port> inputs, outputs;
    std::vector<ParameterSlot> parameters;

    /// True where a run reads the input.
    [[nodiscard]] bool reads(size_t location) const {
        for (const Port& port : inputs)
            if (port.location == location)
                return true;
        return false;
    }
};

} // namespace touchstone::program
