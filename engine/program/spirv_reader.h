#pragma once
// A SPIR-V module as a list of checked instructions. The words may come from anybody.

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchstone::program {

constexpr size_t kMaxSpirvWords = size_t{1} << 18;
constexpr uint32_t kMaxSpirvIds = uint32_t{1} << 16;

/// What the compiler calls the file of the user's source.
inline constexpr std::string_view kSourceFile = "source";

/// Where a module came from: file and line of the source, line 0 where the module does not say.
struct SourceLine {
    std::string file;
    uint32_t line = 0;
};

/// Why a module is not run, inside of the translator.
struct Refusal : std::runtime_error {
    Refusal(const std::string& what, std::string advice)
        : std::runtime_error(what), remedy(std::move(advice)) {}
    std::string remedy;
    SourceLine place;
};

/// One instruction. `words`: everything after the first word.
struct SpirvInstruction {
    uint32_t code = 0;
    std::span<const uint32_t> words;
    uint32_t type = 0, result = 0; ///< 0: none
    uint32_t fileId = 0, line = 0;

    /// Operand i after type and result. Throws Refusal where there is none.
    [[nodiscard]] uint32_t operand(size_t i) const;
    /// That operand and all behind it; none where there are i. Throws Refusal where there are fewer.
    [[nodiscard]] std::span<const uint32_t> operandsFrom(size_t i) const;
    [[nodiscard]] size_t operands() const { return operands_.size(); }
    std::span<const uint32_t> operands_;
};

/// Everything of a module besides its meaning. Keeps no copy of the words.
struct SpirvModule {
    uint32_t bound = 0;
    std::vector<SpirvInstruction> instructions;
    std::map<uint32_t, std::string> strings, names;
    std::map<std::pair<uint32_t, uint32_t>, std::string> memberNames;
    std::map<uint32_t, uint32_t> locations; ///< by variable
    uint32_t extended = 0;                  ///< id of GLSL.std.450; 0: not imported
    uint32_t entry = 0;                     ///< the function of the one entry point

    [[nodiscard]] SourceLine placeOf(const SpirvInstruction& at) const;
};

/// Throws Refusal.
[[nodiscard]] SpirvModule readSpirv(std::span<const uint32_t> words);

/// "SPIR-V instruction 1234".
[[nodiscard]] std::string opcodeName(uint32_t code);

} // namespace touchstone::program
