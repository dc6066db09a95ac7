#pragma once
// The source of a haptic program (docs/programs.md), and the parameters that it declares.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

constexpr size_t kMaxProgramBytes = size_t{1} << 20;
constexpr size_t kMaxProgramParameters = 64;

/// Declared as: parameter TYPE NAME = VALUE; // LEAST..GREATEST UNIT: TEXT
struct ProgramParameter {
    enum class Kind : uint8_t { Float, Int, Uint };
    std::string name;
    Kind kind = Kind::Float;
    size_t components = 1;              ///< 1 to 4
    std::array<double, 4> value{};      ///< as many as there are components
    double least = 0.0, greatest = 0.0; ///< of each component; finite, and the default is inside
    std::string unit, text;             ///< may be empty
    unsigned line = 0;                  ///< of the source, from 1
};

/// A program that may be wrong everywhere but in its parameters.
struct ProgramSource {
    std::string name; ///< as messages show it
    std::string text; ///< UTF-8; lines that declare parameters are empty
    std::vector<ProgramParameter> parameters;
};

/// Reads and checks the declarations. Throws Error, whose place is the line.
[[nodiscard]] ProgramSource readProgramSource(const std::string& name, std::string_view text);

/// The text with spaces in place of its comments: lines and places are the same.
[[nodiscard]] std::string withoutComments(std::string_view text);

/// The line of the place in the text, from 1.
[[nodiscard]] uint32_t lineAt(std::string_view text, size_t place);

/// GLSL that declares the parameters, the i-th of them in line i + 2.
[[nodiscard]] std::string declarationOf(const std::vector<ProgramParameter>& parameters);

} // namespace touchstone
