#pragma once
// How a run of a haptic program ended, and where.

#include <cstdint>

namespace touchstone::program {

/// How a run ended. Only a finished run has outputs.
enum class Ending : uint8_t {
    Finished,
    BudgetReached,  ///< more than the budget, counted at every jump backwards
    BadIndex,       ///< an array index outside of its array
    DivisionByZero, ///< of integers
    Unreachable,
    NotFinite, ///< an output, or a derivative of one, is a NaN or an infinity
};

/// The first run of a tick without a result, for messages (program_fault.h).
struct ProgramEnd {
    static constexpr uint16_t kForce =
        UINT16_MAX; ///< `at` where the outputs are finite and their force is not

    Ending ending = Ending::Finished;
    /// Index of the instruction in RegisterProgram::instructions; with NotFinite the register of the output.
    uint16_t at = 0;
    int object = -1; ///< HapticScene::objects, whose material has the program

    bool operator==(const ProgramEnd&) const = default;
};

} // namespace touchstone::program
