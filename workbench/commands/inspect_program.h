#pragma once
// `touchstone inspect PROGRAM.glsl`.

#include <filesystem>

namespace touchstone {

/// True where the file's name ends as that of a haptic program does.
[[nodiscard]] bool isProgramFile(const std::filesystem::path& file);

/// Prints what the program is and what a run costs; writes it to `json` unless that is empty. Returns the
/// exit status. Throws Error.
int inspectProgram(const std::filesystem::path& file, const std::filesystem::path& json);

} // namespace touchstone
