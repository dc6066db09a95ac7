#pragma once
// Standard input and output of the processes that read foreign files.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

namespace touchstone {

/// The file that is standard input, mapped. Throws std::runtime_error.
[[nodiscard]] std::span<const uint8_t> standardInput();

/// Writes all of it to standard output. Throws std::runtime_error.
void writeOutput(const void* bytes, size_t size);

/// Writes the line to the beginning of standard output and ends the process with `status`.
[[noreturn]] void endWith(int status, std::string_view line);

} // namespace touchstone
