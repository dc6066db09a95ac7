#pragma once

#include <string>

namespace touchstone {

/// The function `symbol` of the shared object `name`, a helper of ours (helperProgram), which stays loaded:
/// its own libraries keep state for each thread. Null: it cannot be had, and `why` is the loader's reason.
/// Any thread but the servo's.
[[nodiscard]] void* functionOfModule(const std::string& name, const char* symbol, std::string& why);

} // namespace touchstone
