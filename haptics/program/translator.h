#pragma once
// SPIR-V to register programs. Functions have to be inlined (SPIRV-Tools does so).

#include "engine/program/spirv_reader.h"
#include "haptics/program/register_program.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>

namespace touchstone::program {

struct TranslationProblem {
    SourceLine place;
    std::string what;   ///< "uses a texture"
    std::string remedy; ///< "use ..."
};

struct Translation {
    RegisterProgram program;
    std::optional<TranslationProblem> problem; ///< with one there is no program
};

/// Checks every word: the module may come from anybody. Any thread but the servo.
[[nodiscard]] Translation translateSpirv(std::span<const uint32_t> words);

} // namespace touchstone::program
