#pragma once
// Why a run of a program had no result, for the person who writes it. Not for the servo.

#include "haptics/program/ending.h"
#include "haptics/program/felt_program.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace touchstone::program {

struct ProgramFault {
    uint32_t line = 0;     ///< of the source, from 1; 0: none in particular
    std::string problem{}; ///< with its remedy, after "; "; empty: the run finished

    bool operator==(const ProgramFault&) const = default;
};

/// `end`: of a run of `code`; `source`: what it was compiled from, empty where that is not known. The line is
/// that of the instruction at which it ended; of an output that is not finite, the line that computes it:
/// where several may have, they stand in the text, and `line` is the first.
[[nodiscard]] ProgramFault faultOf(const RegisterProgram& code, std::string_view source,
                                   const ProgramEnd& end);
[[nodiscard]] ProgramFault faultOf(const FeltProgram& program, const ProgramEnd& end);

/// "line 4: an index is outside ...; clamp it ...".
[[nodiscard]] std::string textOf(const ProgramFault& fault);

} // namespace touchstone::program
