#pragma once

#include <filesystem>
#include <string>

namespace touchstone {

/// The path of a program of ours that this one starts: beside the file that this code is in (the program, or
/// libtouchstone), or where an installation has it, libexec/touchstone under its prefix. Where there is none,
/// the path beside it, so that a message can name a place. Any thread.
[[nodiscard]] std::filesystem::path helperProgram(const std::string& name);

/// The folder of data `name` in share/touchstone of an installation, or `otherwise`, where the sources have
/// it. Any thread.
[[nodiscard]] std::filesystem::path dataFolder(const std::string& name,
                                               const std::filesystem::path& otherwise);

} // namespace touchstone
