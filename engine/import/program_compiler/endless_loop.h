#pragma once
// A loop that never ends, of which a compiler leaves nothing.

#include <cstdint>
#include <string_view>
#include <vector>

namespace touchstone {

/// The module `shortened`. A loop without an end and without an effect is dropped by SPIRV-Tools together
/// with all that follows it, the outputs among it: what is left is a function that returns at once. Its
/// OpReturn then gets the line of the loop in `whole`, so that a message can name it. `file`: of the program,
/// as OpString has it.
[[nodiscard]] std::vector<uint32_t>
withEndlessLoop(std::vector<uint32_t> shortened, const std::vector<uint32_t>& whole, std::string_view file);

} // namespace touchstone
