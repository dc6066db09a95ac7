#pragma once
// Identity of the program and the processor: two machines or two builds may round differently.

#include <string>

namespace touchstone {

/// The linker's build identification of this executable, hexadecimal; "unknown" where it has none.
[[nodiscard]] std::string buildIdentity();

/// "g++ 12.2.0"
[[nodiscard]] std::string compilerName();

/// The processor's own model name.
[[nodiscard]] std::string processorName();

} // namespace touchstone
